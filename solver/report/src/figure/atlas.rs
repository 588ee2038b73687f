//! A sweep over two axes: the growth rate as shading, the lines on which something changes.

use super::{Drawing, ticks};
use kuva::prelude::*;
use landau_solver::study::row::Row;

/// Levels of the shading.
const LEVELS: usize = 16;

/// A line on which a quantity vanishes or jumps, as pieces across the cells of the grid.
type Pieces = Vec<[(f64, f64); 2]>;

/// Values over a grid, `[y][x]`; NaN where there is none.
struct Grid<'a> {
    x: &'a [f64],
    y: &'a [f64],
    values: Vec<Vec<f64>>,
}

/// The picture of a sweep over two axes; nothing where no point has a growth rate.
pub fn atlas(title: &str, names: [&str; 2], axes: [&[f64]; 2], rows: &[Row]) -> Option<Drawing> {
    let grid = |of: fn(&Row) -> Option<f64>| {
        let values = rows.chunks(axes[0].len());
        let values = values.map(|line| line.iter().map(|r| of(r).unwrap_or(f64::NAN)).collect());
        Grid {
            x: axes[0],
            y: axes[1],
            values: values.collect(),
        }
    };
    let growth = grid(|row| row.c0.map(|c| c[0]));
    let landau = grid(|row| row.c2.map(|c| c[0]));
    let finite = growth
        .values
        .iter()
        .flatten()
        .copied()
        .filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
        (a.min(v), b.max(v))
    });
    if low > high || axes.iter().any(|axis| axis.len() < 2) {
        return None;
    }
    let shown = |line: &Vec<f64>| {
        line.iter()
            .map(|v| if v.is_finite() { *v } else { low })
            .collect()
    };
    let shading = ContourPlot::new()
        .with_grid(
            growth.values.iter().map(shown).collect(),
            axes[0].to_vec(),
            axes[1].to_vec(),
        )
        .with_n_levels(LEVELS)
        .with_filled()
        .with_colormap(ColorMap::Viridis)
        .with_line_width(0.3)
        .with_legend("a0");
    let mut plots: Vec<Plot> = vec![shading.into()];
    let (vanishing, jumping) = landau.crossings(landau.typical());
    // A growth rate has no poles: where modes change places it jumps, and that is a crossing all the same.
    let (neutral, _) = growth.crossings(f64::INFINITY);
    let lines = [
        ("a0 = 0", "#000000", neutral),
        ("a2 = 0", "#d55e00", vanishing),
        ("a2 jumps: resonance", "#cc79a7", jumping),
    ];
    let mut says = Vec::new();
    for (name, colour, pieces) in lines {
        if !pieces.is_empty() {
            says.push(name);
        }
        for (index, piece) in joined(pieces).into_iter().enumerate() {
            let line = LinePlot::new().with_data(piece).with_color(colour);
            let line = line.with_stroke_width(2.5);
            plots.push(match index {
                0 => line.with_legend(name).into(),
                _ => line.into(),
            });
        }
    }
    let reach = |axis: &[f64]| axis.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let layout = Layout::auto_from_plots(&plots)
        .with_title(title)
        .with_x_label(names[0])
        .with_y_label(names[1])
        .with_x_tick_format(ticks::linear(reach(axes[0])))
        .with_y_tick_format(ticks::linear(reach(axes[1])))
        .with_show_grid(false)
        .with_clamp_axis()
        .with_title_wrap(60)
        .with_x_axis_min(axes[0][0])
        .with_x_axis_max(axes[0][axes[0].len() - 1])
        .with_y_axis_min(axes[1][0])
        .with_y_axis_max(axes[1][axes[1].len() - 1])
        .with_colorbar_tick_format(ticks::linear(low.abs().max(high.abs())));
    let figure = Figure::new(1, 1)
        .with_plots(vec![plots])
        .with_layouts(vec![layout])
        .with_cell_size(760.0, 520.0);
    let lines = match says.as_slice() {
        [] => String::new(),
        says => format!("; lines: {}", says.join(", ")),
    };
    let says = format!("growth rate over {} and {}{lines}.", names[0], names[1]);
    Some(Drawing::new(figure, says))
}

impl Grid<'_> {
    /// The median of the sizes.
    fn typical(&self) -> f64 {
        let mut sizes: Vec<f64> = self.values.iter().flatten().map(|v| v.abs()).collect();
        sizes.retain(|v| v.is_finite());
        sizes.sort_by(f64::total_cmp);
        sizes.get(sizes.len() / 2).copied().unwrap_or(0.0)
    }

    /// Where the values pass through zero, and where through infinity: between values that are both beyond `large`.
    fn crossings(&self, large: f64) -> (Pieces, Pieces) {
        let (mut zero, mut infinity) = (Pieces::new(), Pieces::new());
        for j in 0..self.y.len() - 1 {
            for i in 0..self.x.len() - 1 {
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                let mut ends = Vec::new();
                let mut jumps = false;
                for edge in 0..4 {
                    let (p, q) = (
                        corners[edge].min(corners[(edge + 1) % 4]),
                        corners[edge].max(corners[(edge + 1) % 4]),
                    );
                    let (a, b) = (self.values[p.1][p.0], self.values[q.1][q.0]);
                    if a * b < 0.0 {
                        let jump = a.abs().min(b.abs()) > large;
                        let part = if jump { b / (b - a) } else { a / (a - b) };
                        let between =
                            |axis: &[f64], p: usize, q: usize| axis[p] + part * (axis[q] - axis[p]);
                        ends.push((between(self.x, p.0, q.0), between(self.y, p.1, q.1)));
                        jumps |= jump;
                    }
                }
                for piece in ends.chunks_exact(2) {
                    let list = if jumps { &mut infinity } else { &mut zero };
                    list.push([piece[0], piece[1]]);
                }
            }
        }
        (zero, infinity)
    }
}

/// Pieces that meet, as one line.
fn joined(mut pieces: Pieces) -> Vec<Vec<(f64, f64)>> {
    let mut lines = Vec::new();
    while let Some([start, end]) = pieces.pop() {
        let mut line = std::collections::VecDeque::from([start, end]);
        loop {
            let (first, last) = (line[0], line[line.len() - 1]);
            let meets = |p: &[(f64, f64); 2]| p.contains(&first) || p.contains(&last);
            let Some(next) = pieces.iter().position(meets) else {
                break;
            };
            let [a, b] = pieces.swap_remove(next);
            match () {
                () if a == last => line.push_back(b),
                () if b == last => line.push_back(a),
                () if a == first => line.push_front(b),
                () => line.push_front(a),
            }
        }
        lines.push(line.into());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::{Grid, joined};

    /// x² + y² − 1 vanishes on one closed line of radius one; 1/(x − 0.3) jumps on a straight one.
    #[test]
    fn lines_of_a_grid() {
        let axis: Vec<f64> = (0..41).map(|i| -2.0 + 0.1 * f64::from(i)).collect();
        let over = |f: &dyn Fn(f64, f64) -> f64| Grid {
            x: &axis,
            y: &axis,
            values: axis
                .iter()
                .map(|y| axis.iter().map(|x| f(*x, *y)).collect())
                .collect(),
        };
        let circle = over(&|x, y| x * x + y * y - 1.003);
        let (zero, infinity) = circle.crossings(circle.typical());
        assert!(infinity.is_empty());
        let lines = joined(zero);
        assert_eq!(lines.len(), 1);
        assert!(
            lines[0]
                .iter()
                .all(|(x, y)| (x.hypot(*y) - 1.0).abs() < 5e-3)
        );
        let pole = over(&|x, _| 1.0 / (x - 0.33));
        let (zero, infinity) = pole.crossings(pole.typical());
        assert!(zero.is_empty());
        assert!(infinity.iter().flatten().all(|p| (p.0 - 0.33).abs() < 1e-9));
        // A step from −2 to 3 is a zero of what has no poles.
        let step = over(&|x, _| if x < 0.33 { -2.0 } else { 3.0 });
        assert!(step.crossings(f64::INFINITY).1.is_empty());
        assert_eq!(joined(step.crossings(f64::INFINITY).0).len(), 1);
    }
}
