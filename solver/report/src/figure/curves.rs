//! Panels of curves side by side.

use super::{COLOURS, svg};
use kuva::prelude::*;

/// Below this the plotting library's logarithmic axes stand still.
const LOWEST_LOGARITHMIC: f64 = 1e-10;

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    Line,
    Dashed,
    Dots,
}

/// Points of one quantity; a gap (a point that is not finite) ends a run.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Empty: not in the legend.
    pub label: String,
    pub points: Vec<(f64, f64)>,
    pub style: Style,
}

/// One pair of axes.
#[derive(Clone, Debug)]
pub struct Panel {
    pub title: String,
    pub x: String,
    pub y: String,
    pub logarithmic: [bool; 2],
    pub curves: Vec<Curve>,
}

impl Panel {
    pub fn new(title: &str, x: &str, y: &str) -> Self {
        let [title, x, y] = [title, x, y].map(str::to_owned);
        Panel {
            title,
            x,
            y,
            logarithmic: [false; 2],
            curves: Vec::new(),
        }
    }

    pub fn curve(&mut self, label: &str, style: Style, points: Vec<(f64, f64)>) {
        let label = label.to_owned();
        self.curves.push(Curve {
            label,
            points,
            style,
        });
    }

    /// A curve with poles: what stands far out of its bulk is a gap.
    pub fn curve_with_poles(&mut self, label: &str, style: Style, points: Vec<(f64, f64)>) {
        let most = bulk(points.iter().map(|p| p.1));
        let kept = |(x, y): (f64, f64)| (x, if y.abs() <= most { y } else { f64::NAN });
        self.curve(label, style, points.into_iter().map(kept).collect());
    }

    /// Runs of points that can be drawn.
    fn runs(&self, curve: &Curve) -> Vec<Vec<(f64, f64)>> {
        let [log_x, log_y] = self.logarithmic;
        let drawable = |value: f64, logarithmic: bool| {
            value.is_finite() && (!logarithmic || value >= LOWEST_LOGARITHMIC)
        };
        let shown = |(x, y): &(f64, f64)| drawable(*x, log_x) && drawable(*y, log_y);
        let runs = curve.points.split(|point| !shown(point));
        runs.filter(|run| !run.is_empty())
            .map(<[(f64, f64)]>::to_vec)
            .collect()
    }

    fn plots(&self) -> Vec<Plot> {
        let mut plots: Vec<Plot> = Vec::new();
        let finite = |p: &&(f64, f64)| p.0.is_finite() && p.1.is_finite();
        let all = || {
            self.curves
                .iter()
                .flat_map(|c| c.points.iter().filter(finite))
        };
        let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| {
            (a.min(p.0), b.max(p.0))
        });
        let signs = [all().any(|p| p.1 < 0.0), all().any(|p| p.1 > 0.0)];
        if signs == [true, true] && !self.logarithmic[1] {
            let zero = LinePlot::new().with_data(vec![(low, 0.0), (high, 0.0)]);
            plots.push(zero.with_color("#999999").with_stroke_width(1.0).into());
        }
        for (index, curve) in self.curves.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            for (position, run) in self.runs(curve).into_iter().enumerate() {
                // One entry of the legend a curve.
                let label = (position == 0 && !curve.label.is_empty()).then_some(&curve.label);
                if curve.style == Style::Dots || run.len() == 1 {
                    let mut plot = ScatterPlot::new().with_data(run).with_color(colour);
                    plot = plot.with_size(3.0);
                    if let Some(label) = label {
                        plot = plot.with_legend(label.clone());
                    }
                    plots.push(plot.into());
                    continue;
                }
                let mut plot = LinePlot::new().with_data(run).with_color(colour);
                plot = plot.with_stroke_width(2.0);
                if curve.style == Style::Dashed {
                    plot = plot.with_dashed();
                }
                if let Some(label) = label {
                    plot = plot.with_legend(label.clone());
                }
                plots.push(plot.into());
            }
        }
        plots
    }
}

/// The picture; nothing where no panel has a point.
pub fn panels(title: &str, panels: &[Panel]) -> Option<String> {
    let drawn: Vec<&Panel> = panels
        .iter()
        .filter(|panel| {
            panel
                .curves
                .iter()
                .any(|curve| !panel.runs(curve).is_empty())
        })
        .collect();
    if drawn.is_empty() {
        return None;
    }
    let (mut plots, mut layouts) = (Vec::new(), Vec::new());
    for panel in &drawn {
        let curves = panel.plots();
        let mut layout = Layout::auto_from_plots(&curves)
            .with_title(panel.title.clone())
            .with_x_label(panel.x.clone())
            .with_y_label(panel.y.clone());
        if panel.logarithmic[0] {
            layout = layout.with_log_x();
        }
        if panel.logarithmic[1] {
            layout = layout.with_log_y();
        }
        plots.push(curves);
        layouts.push(layout);
    }
    let columns = drawn.len().min(3);
    let mut figure = Figure::new(drawn.len().div_ceil(columns), columns);
    if !title.is_empty() {
        figure = figure.with_title(title);
    }
    let figure = figure
        .with_plots(plots)
        .with_layouts(layouts)
        .with_cell_size(460.0, 360.0);
    Some(svg(figure))
}

/// The values beyond which a curve with poles is cut: six times its median size.
fn bulk(values: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = values.map(f64::abs).filter(|v| v.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    6.0 * sizes.get(sizes.len() / 2).copied().unwrap_or(f64::INFINITY)
}
