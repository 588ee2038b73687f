//! Fields over the plane: shading for a scalar, arrows for a vector, equal aspect.

use super::Drawing;
use kuva::prelude::*;

/// Levels of the shading.
const LEVELS: usize = 16;
/// Points of the shading along either axis; data beside the picture may be finer.
const SHADED: usize = 90;
/// Arrows along the longer side of a picture.
const ARROWS: f64 = 24.0;
/// Pixels of a panel's longer side, and of what surrounds the axes.
const SIDE: f64 = 520.0;
const MARGIN: [f64; 2] = [170.0, 110.0];
/// Pixels of a strip's height, at least.
const THINNEST: f64 = 130.0;

/// One picture of the plane; arrays are `[y][x]`.
pub struct Plane<'a> {
    /// What stands above it.
    pub title: String,
    /// Of both axes.
    pub labels: [String; 2],
    /// Along x.
    pub x: &'a [f64],
    /// Along y.
    pub y: &'a [f64],
    /// Name and values that are shaded.
    pub shade: (String, Vec<Vec<f64>>),
    /// Components along and across.
    pub arrows: Option<[Vec<Vec<f64>>; 2]>,
    /// What the arrows are.
    pub key: Option<String>,
}

/// Planes side by side.
pub fn planes(title: &str, planes: &[Plane]) -> Drawing {
    let (mut plots, mut layouts, mut says) = (Vec::new(), Vec::new(), Vec::new());
    let mut cell = [0.0_f64; 2];
    for plane in planes {
        let contents = plane.plots();
        let layout = Layout::auto_from_plots(&contents)
            .with_title(plane.title.clone())
            .with_x_label(plane.labels[0].clone())
            .with_y_label(plane.labels[1].clone())
            .with_subtitle(plane.subtitle())
            .with_show_grid(false)
            .with_clamp_axis()
            .with_x_axis_min(plane.x[0])
            .with_x_axis_max(plane.x[plane.x.len() - 1]);
        let [width, height] = plane.extent();
        let unit = SIDE / width.max(height);
        // A thin strip is drawn thicker than it is.
        let thin = unit * height < THINNEST;
        let layout = if thin {
            layout
        } else {
            layout.with_equal_aspect()
        };
        let height = if thin { THINNEST / unit } else { height };
        cell[0] = cell[0].max(unit * width + MARGIN[0]);
        cell[1] = cell[1].max(unit * height + MARGIN[1]);
        plots.push(contents);
        layouts.push(layout);
        says.push(plane.says());
    }
    let figure = Figure::new(1, planes.len())
        .with_title(title)
        .with_plots(plots)
        .with_layouts(layouts)
        .with_cell_size(cell[0], cell[1]);
    Drawing::new(figure, says.join("; ") + ".")
}

impl Plane<'_> {
    fn says(&self) -> String {
        let arrows = self.key.as_ref().map(|key| format!(", arrows: {key}"));
        format!(
            "{}: {}{}",
            self.title,
            self.shade.0,
            arrows.unwrap_or_default()
        )
    }

    fn extent(&self) -> [f64; 2] {
        let length = |values: &[f64]| match values {
            [first, .., last] => last - first,
            _ => 1.0,
        };
        [length(self.x), length(self.y)]
    }

    /// The key of the arrows: how long the longest stands for.
    fn subtitle(&self) -> String {
        let shading = format!("shading: {}", self.shade.0);
        let (Some(key), Some([u, v])) = (&self.key, &self.arrows) else {
            return shading;
        };
        let values = u.iter().flatten().zip(v.iter().flatten());
        let longest = values.map(|(u, v)| u.hypot(*v)).fold(0.0, f64::max);
        format!("{shading}; arrows: {key}, the longest {longest:.3}")
    }

    fn plots(&self) -> Vec<Plot> {
        let (label, values) = &self.shade;
        let (columns, rows) = (thinned(self.x), thinned(self.y));
        let pick = |from: &[f64], places: &[usize]| places.iter().map(|&i| from[i]).collect();
        let grid = rows.iter().map(|&j| pick(&values[j], &columns)).collect();
        let shading = ContourPlot::new()
            .with_grid(grid, pick(self.x, &columns), pick(self.y, &rows))
            .with_n_levels(LEVELS)
            .with_filled()
            .with_colormap(ColorMap::Viridis)
            .with_line_width(0.35)
            .with_legend(label.clone());
        let mut plots: Vec<Plot> = vec![shading.into()];
        if let Some(vector) = &self.arrows {
            plots.push(self.quiver(vector).into());
        }
        plots
    }

    /// Arrows on a square lattice, none longer than its spacing.
    fn quiver(&self, [u, v]: &[Vec<Vec<f64>>; 2]) -> QuiverPlot {
        let [width, height] = self.extent();
        let spacing = width.max(height) / ARROWS;
        let lattice = |values: &[f64], length: f64| -> Vec<usize> {
            let count = (length / spacing).round().max(2.0) as usize;
            // Half a spacing off the walls.
            let place = |i| (i as f64 + 0.5) / count as f64 * (values.len() - 1) as f64;
            (0..count).map(|i| place(i).round() as usize).collect()
        };
        let columns = lattice(self.x, width);
        let mut arrows = Vec::new();
        for j in lattice(self.y, height) {
            for &i in &columns {
                arrows.push((self.x[i], self.y[j], u[j][i], v[j][i]));
            }
        }
        let longest = arrows.iter().map(|a| a.2.hypot(a.3)).fold(1e-300, f64::max);
        QuiverPlot::new()
            .with_arrows(arrows)
            .with_color("#ffffff")
            .with_scale(1.1 * spacing / longest)
            .with_pivot(QuiverPivot::Middle)
            .with_shaft_width(1.1)
            .with_head_min_px(1.5)
            .with_head_max_px(6.0)
            .with_tight_bounds()
    }
}

/// Evenly spaced positions among the points of an axis, both ends included.
fn thinned(values: &[f64]) -> Vec<usize> {
    let last = values.len() - 1;
    let count = values.len().min(SHADED);
    (0..count).map(|i| i * last / (count - 1).max(1)).collect()
}
