//! Tables and plots of a sweep. The plotting library is used nowhere else.

use crate::study::Setup;
use crate::study::sweep::{Row, Sweep};
use kuva::prelude::*;

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
pub fn sweep(setup: &Setup, sweep: &Sweep, rows: &[Row]) -> String {
    let axis = sweep.ranges[0].name.clone();
    let x = |row: &Row| row.coordinates[0];
    let growth = curve(rows, x, |row| row.c0.map(|c| c[0]), f64::INFINITY);
    // c2 has poles: what lies far outside the bulk of its values is cut off.
    let mut sizes: Vec<f64> = rows
        .iter()
        .filter_map(|r| r.c2.map(|c| c[0].abs()))
        .collect();
    sizes.sort_by(f64::total_cmp);
    let bound = 6.0 * sizes.get(sizes.len() / 2).copied().unwrap_or(f64::INFINITY);
    let landau = curve(rows, x, |row| row.c2.map(|c| c[0]), bound);
    let mut amplitudes: Vec<f64> = rows.iter().filter_map(|r| r.amplitude).collect();
    amplitudes.sort_by(f64::total_cmp);
    let bound = 6.0
        * amplitudes
            .get(amplitudes.len() / 2)
            .copied()
            .unwrap_or(f64::INFINITY);
    let amplitude = curve(
        rows,
        x,
        |row| row.amplitude.filter(|_| row.c0.is_some_and(|c| c[0] > 0.0)),
        bound,
    );
    let panels = [
        ("growth rate a0", "#1b6ca8", growth),
        ("first Landau coefficient a2", "#b5482a", landau),
        ("equilibrium amplitude A_e", "#3a7d44", amplitude),
    ];
    let (mut plots, mut layouts) = (Vec::new(), Vec::new());
    for (title, colour, segments) in panels {
        let mut panel: Vec<Plot> = Vec::new();
        for segment in segments {
            panel.push(
                LinePlot::new()
                    .with_data(segment)
                    .with_color(colour)
                    .with_stroke_width(2.0)
                    .into(),
            );
        }
        let low = rows.first().map_or(0.0, x);
        let high = rows.last().map_or(1.0, x);
        panel.push(
            LinePlot::new()
                .with_data(vec![(low, 0.0), (high, 0.0)])
                .with_color("#999999")
                .with_dashed()
                .into(),
        );
        let layout = Layout::auto_from_plots(&panel)
            .with_title(title)
            .with_x_label(&axis);
        plots.push(panel);
        layouts.push(layout);
    }
    let mut figure = Figure::new(1, 3).with_title(setup.model.structure().title.clone());
    figure = figure
        .with_plots(plots)
        .with_layouts(layouts)
        .with_cell_size(430.0, 340.0);
    kuva::backend::svg::SvgBackend::default().render_scene(&figure.render())
}

/// Runs of neighbouring points that have a value within ±bound.
fn curve(
    rows: &[Row],
    x: impl Fn(&Row) -> f64,
    y: impl Fn(&Row) -> Option<f64>,
    bound: f64,
) -> Vec<Vec<(f64, f64)>> {
    let mut segments: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for row in rows {
        let value = y(row).filter(|v| v.is_finite() && v.abs() <= bound);
        let jumps = |segment: &Vec<(f64, f64)>| {
            segment
                .last()
                .is_some_and(|(previous, _)| x(row) < *previous)
        };
        let last = segments.len() - 1;
        match value {
            Some(value) => {
                if jumps(&segments[last]) {
                    segments.push(Vec::new());
                }
                let last = segments.len() - 1;
                segments[last].push((x(row), value));
            }
            None if !segments[last].is_empty() => segments.push(Vec::new()),
            None => {}
        }
    }
    segments.retain(|s| !s.is_empty());
    segments
}
