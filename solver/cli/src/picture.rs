//! Tables and plots of a sweep.

use landau_report::figure::{Panel, Style, panels};
use landau_solver::study::Setup;
use landau_solver::study::row::{Column, Row, column};
use landau_solver::study::sweep::Sweep;

/// Rows shown of a long table.
const SHOWN: usize = 24;

/// The table, thinned to a screenful.
pub fn table(sweep: &Sweep, rows: &[Row]) {
    let names = sweep.ranges.iter().map(|r| format!("{:>12}", r.name));
    let columns = ["a0", "a2", "A_e"].iter().map(|n| format!("{n:>16}"));
    say!("{}", names.chain(columns).collect::<String>());
    let stride = rows.len().div_ceil(SHOWN).max(1);
    for row in rows.iter().step_by(stride) {
        let place = row.coordinates.iter().map(|x| format!("{x:>12.6}"));
        let number = |v: Option<f64>| v.map_or(format!("{:>16}", "-"), |v| format!("{v:>16.6e}"));
        let values = [row.c0.map(|c| c[0]), row.c2.map(|c| c[0]), row.amplitude].map(number);
        say!("{}", place.chain(values).collect::<String>());
    }
}

/// Growth rate, c2 and amplitude over the first axis, as SVG.
pub fn sweep(setup: &Setup, sweep: &Sweep, rows: &[Row]) -> Option<String> {
    let axis = sweep.ranges[0].name.as_str();
    let mut growth = Panel::new("growth rate", axis, "a0");
    let mut landau = Panel::new("first Landau coefficient", axis, "a2");
    let mut amplitude = Panel::new("equilibrium amplitude", axis, "A_e");
    for line in rows.chunk_by(|a, b| a.coordinates[1..] == b.coordinates[1..]) {
        let others = sweep.ranges[1..].iter().zip(&line[0].coordinates[1..]);
        let label: Vec<String> = others
            .map(|(r, x)| format!("{} = {x:.4}", r.name))
            .collect();
        let label = label.join(", ");
        growth.curve(&label, Style::Line, column(line, Column::A0));
        landau.curve_with_poles(&label, Style::Line, column(line, Column::A2));
        amplitude.curve_with_poles(&label, Style::Line, column(line, Column::Amplitude));
    }
    panels(&setup.model.structure().title, &[growth, landau, amplitude])
}
