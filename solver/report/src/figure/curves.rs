//! Panels of curves side by side.

use super::{COLOURS, Drawing, ticks};
use kuva::prelude::*;

/// Below this the plotting library's logarithmic axes stand still.
const LOWEST_LOGARITHMIC: f64 = 1e-10;

/// Letters on a line of a panel's title, and intervals of its axes.
const TITLE: usize = 42;
const TICKS: usize = 6;

/// Values that differ by a smaller part of them are one.
const LEVEL: f64 = 1e-12;

/// Points on each side of a pole that may be its needle.
const NEEDLE: usize = 12;

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Joined.
    Line,
    /// Joined by dashes.
    Dashed,
    /// Not joined.
    Dots,
    /// Not joined, and large enough to be seen around dots.
    Discs,
}

/// Points of one quantity; a gap (a point that is not finite) ends a run.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Empty: not in the legend.
    pub label: String,
    /// Places and values.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub style: Style,
    /// Position of its colour.
    colour: usize,
}

/// One pair of axes.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What stands above it.
    pub title: String,
    /// Along x.
    pub x: String,
    /// Along y.
    pub y: String,
    /// Whether each axis is.
    pub logarithmic: [bool; 2],
    /// In the order in which they are drawn.
    pub curves: Vec<Curve>,
    /// Where curves jump through infinity.
    pub poles: Vec<f64>,
    /// Places along x that have a name.
    pub marks: Vec<(f64, String)>,
    /// What is shown along x; all points where nothing is said.
    pub range: Option<[f64; 2]>,
}

impl Panel {
    /// Without curves.
    pub fn new(title: &str, x: &str, y: &str) -> Self {
        let [title, x, y] = [title, x, y].map(str::to_owned);
        Panel {
            title,
            x,
            y,
            logarithmic: [false; 2],
            curves: Vec::new(),
            poles: Vec::new(),
            marks: Vec::new(),
            range: None,
        }
    }

    /// Adds a curve.
    pub fn curve(&mut self, label: &str, style: Style, points: Vec<(f64, f64)>) {
        let colour = self.curves.last().map_or(0, |last| last.colour + 1);
        self.add(label, style, points, colour);
    }

    /// Adds a curve in the colour of the last: the other part of the same quantity.
    pub fn curve_beside(&mut self, label: &str, style: Style, points: Vec<(f64, f64)>) {
        let colour = self.curves.last().map_or(0, |last| last.colour);
        self.add(label, style, points, colour);
    }

    fn add(&mut self, label: &str, style: Style, points: Vec<(f64, f64)>, colour: usize) {
        let label = label.to_owned();
        self.curves.push(Curve {
            label,
            points,
            style,
            colour,
        });
    }

    /// A curve with poles: each is marked by a dashed vertical, and the needles beside it are cut where the rest of the
    /// curve ends. Nothing else is.
    pub fn curve_with_poles(&mut self, label: &str, style: Style, points: Vec<(f64, f64)>) {
        let found = poles(&points);
        let beside = |i: usize| {
            found
                .iter()
                .any(|(at, _)| i + NEEDLE > *at && i <= *at + NEEDLE)
        };
        let far = points.iter().enumerate().filter(|(i, _)| !beside(*i));
        let sizes = far.map(|(_, p)| p.1.abs()).filter(|y| y.is_finite());
        let most = sizes.fold(0.0, f64::max);
        let kept = |(i, (x, y)): (usize, (f64, f64))| {
            let shown = !beside(i) || y.abs() <= 1.1 * most;
            (x, if shown { y } else { f64::NAN })
        };
        let mut drawn: Vec<(f64, f64)> = Vec::new();
        for (i, point) in points.iter().copied().enumerate() {
            drawn.push(kept((i, point)));
            // A gap at the pole itself.
            if let Some((_, place)) = found.iter().find(|(at, _)| *at == i) {
                drawn.push((*place, f64::NAN));
            }
        }
        for (_, place) in &found {
            if !self.poles.contains(place) {
                self.poles.push(*place);
            }
        }
        self.curve(label, style, drawn);
    }

    /// What is seen: the quantity over its axis, curve by curve.
    fn says(&self) -> String {
        let quantity = match (self.title.as_str(), self.y.as_str()) {
            (title, "") => title.to_owned(),
            ("", y) => y.to_owned(),
            (title, y) if title == y => title.to_owned(),
            (title, y) => format!("{title}, {y}"),
        };
        let labels = self.curves.iter().map(|c| c.label.as_str());
        let labels: Vec<&str> = labels.filter(|label| !label.is_empty()).collect();
        let curves = match labels.as_slice() {
            [] => String::new(),
            labels => format!(" for {}", labels.join(", ")),
        };
        format!("{quantity} over {}{curves}", self.x)
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

    /// Smallest and largest of what is drawn, along x and along y.
    fn extent(&self) -> [[f64; 2]; 2] {
        let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for (x, y) in self.curves.iter().flat_map(|c| self.runs(c)).flatten() {
            for (bounds, value) in extent.iter_mut().zip([x, y]) {
                *bounds = [bounds[0].min(value), bounds[1].max(value)];
            }
        }
        if let Some([low, high]) = self.range {
            // The name of a mark stands on its right.
            let room = 0.06 * (high - low);
            let named = self.marks.iter().any(|(place, _)| *place > high - room);
            extent[0] = [low, if named { high + room } else { high }];
        }
        extent
    }

    /// Axes with their labels, what is marked on them, and the numbers in one style.
    fn layout(&self, title: String, curves: &[Plot]) -> Layout {
        let mut layout = Layout::auto_from_plots(curves)
            .with_title(title)
            .with_title_wrap(TITLE)
            .with_ticks(TICKS)
            .with_x_label(self.x.clone())
            .with_y_label(self.y.clone());
        let extent = self.extent();
        let formats = [0, 1].map(|axis| {
            let [low, high] = extent[axis];
            match self.logarithmic[axis] {
                true => ticks::logarithmic(low, high),
                false => ticks::linear(low.abs().max(high.abs())),
            }
        });
        let [x, y] = formats;
        layout = layout.with_x_tick_format(x).with_y_tick_format(y);
        if self.logarithmic[0] {
            layout = layout.with_log_x();
        } else {
            // No axis runs on to the next round number.
            let [low, high] = extent[0];
            let margin = match self.range {
                Some(_) => 0.0,
                None => 0.02 * (high - low),
            };
            if high > low {
                layout = layout
                    .with_x_axis_min(low - margin)
                    .with_x_axis_max(high + margin);
            }
        }
        if self.logarithmic[1] {
            layout = layout.with_log_y();
        } else if let Some([low, high]) = level(extent[1]) {
            layout = layout.with_y_axis_min(low).with_y_axis_max(high);
        }
        for pole in &self.poles {
            let line = ReferenceLine::vertical(*pole).with_color("#999999");
            layout = layout.with_reference_line(line.with_dasharray("5 4"));
        }
        for (place, name) in &self.marks {
            let line = ReferenceLine::vertical(*place).with_color("#666666");
            let line = line.with_dasharray("2 3").with_label(name.clone());
            layout = layout.with_reference_line(line);
        }
        layout
    }

    fn plots(&self) -> Vec<Plot> {
        let mut plots: Vec<Plot> = Vec::new();
        let [[low, high], [bottom, top]] = self.extent();
        if bottom < 0.0 && top > 0.0 && !self.logarithmic[1] {
            let zero = LinePlot::new().with_data(vec![(low, 0.0), (high, 0.0)]);
            plots.push(zero.with_color("#999999").with_stroke_width(1.0).into());
        }
        for curve in &self.curves {
            let colour = COLOURS[curve.colour % COLOURS.len()];
            for (position, run) in self.runs(curve).into_iter().enumerate() {
                // One entry of the legend a curve.
                let label = (position == 0 && !curve.label.is_empty()).then_some(&curve.label);
                let dots = matches!(curve.style, Style::Dots | Style::Discs);
                if dots || run.len() == 1 {
                    let mut plot = ScatterPlot::new().with_data(run).with_color(colour);
                    let disc = curve.style == Style::Discs;
                    plot = plot.with_size(if disc { 6.0 } else { 3.0 });
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

/// The picture; nothing where no panel has a point. Several panels have letters.
pub fn panels(title: &str, panels: &[Panel]) -> Option<Drawing> {
    let drawable = |panel: &&Panel| {
        let drawn = |curve: &Curve| !panel.runs(curve).is_empty();
        panel.curves.iter().any(drawn)
    };
    let drawn: Vec<&Panel> = panels.iter().filter(drawable).collect();
    if drawn.is_empty() {
        return None;
    }
    let (mut plots, mut layouts, mut says) = (Vec::new(), Vec::new(), Vec::new());
    for (index, panel) in drawn.iter().enumerate() {
        let letter = match drawn.len() {
            1 => String::new(),
            _ => format!("({}) ", char::from(b'a' + index as u8)),
        };
        let curves = panel.plots();
        // One panel has room for one title, which goes on from line to line.
        let own = match (drawn.len(), title, panel.title.as_str()) {
            (1, "", own) | (2.., _, own) => format!("{letter}{own}"),
            (_, title, "") => title.to_owned(),
            (_, title, own) => format!("{title}: {own}"),
        };
        layouts.push(panel.layout(own, &curves));
        plots.push(curves);
        says.push(format!("{letter}{}", panel.says()));
    }
    let columns = drawn.len().min(2);
    let mut figure = Figure::new(drawn.len().div_ceil(columns), columns);
    if !title.is_empty() && drawn.len() > 1 {
        figure = figure.with_title(title);
    }
    let figure = figure
        .with_plots(plots)
        .with_layouts(layouts)
        .with_cell_size(500.0, 390.0);
    Some(Drawing::new(figure, says.join("; ") + "."))
}

/// The range around values that differ by rounding alone: they are level, and are drawn so.
fn level([low, high]: [f64; 2]) -> Option<[f64; 2]> {
    let size = low.abs().max(high.abs());
    let room = 0.1 * if size > 0.0 { size } else { 1.0 };
    (high >= low && high - low <= LEVEL * size).then_some([low - room, high + room])
}

/// Where a curve jumps through infinity: after which point, and the place at which 1/y vanishes. On both sides the
/// curve runs away from zero, and the jump is no step between small values.
fn poles(points: &[(f64, f64)]) -> Vec<(usize, f64)> {
    let mut sizes: Vec<f64> = points.iter().map(|p| p.1.abs()).collect();
    sizes.retain(|y| y.is_finite());
    sizes.sort_by(f64::total_cmp);
    let typical = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    let jump = |i: &usize| {
        let [a, b, c, d] = [i - 1, *i, i + 1, i + 2].map(|j| points[j].1);
        let outwards = b.abs() > a.abs() && c.abs() > d.abs() && a * b > 0.0 && c * d > 0.0;
        b * c < 0.0 && outwards && b.abs().min(c.abs()) > 2.0 * typical
    };
    let place = |i: usize| {
        let ((x, b), (z, c)) = (points[i], points[i + 1]);
        (i, x + (z - x) * c / (c - b))
    };
    let inner = 1..points.len().saturating_sub(2);
    inner.filter(jump).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::{Panel, Style, level, poles};

    fn curve(f: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        (0..101)
            .map(|i| f64::from(i) / 100.0)
            .map(|x| (x, f(x)))
            .collect()
    }

    #[test]
    fn poles_are_found_and_nothing_else() {
        let found = poles(&curve(|x| 1.0 + 0.1 / (x - 0.4437)));
        assert_eq!(found.len(), 1);
        assert!((found[0].1 - 0.4437).abs() < 1e-3, "{found:?}");
        assert!(poles(&curve(|x| (30.0 * x).sin())).is_empty());
        assert!(poles(&curve(|x| 1000.0 * x * x)).is_empty());
    }

    /// Rounding is not magnified to a landscape.
    #[test]
    fn level_values() {
        let [low, high] = level([0.348, 0.348 + 1e-16]).expect("a range");
        assert!(low < 0.32 && high > 0.38);
        assert_eq!(level([0.0, 0.0]), Some([-0.1, 0.1]));
        assert_eq!(level([0.348, 0.3481]), None);
        assert_eq!(level([f64::INFINITY, f64::NEG_INFINITY]), None);
    }

    /// A steep end is drawn whole.
    #[test]
    fn a_steep_end_is_no_needle() {
        let mut panel = Panel::new("", "", "");
        panel.curve_with_poles("", Style::Line, curve(|x| (12.0 * x).exp()));
        assert!(panel.curves[0].points.iter().all(|p| p.1.is_finite()));
    }
}
