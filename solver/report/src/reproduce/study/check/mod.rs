//! What a study may say: every number in its range, every key where it has a meaning, before anything is computed.

mod claims;
mod critical;
mod kinds;

use super::place::{Mistake, Step};
use super::{Axis, Case, Figure, Spacing, Study};
use landau_solver::study::check_resolution;
use landau_solver::wavevector::WaveVector;

/// Values along one axis.
const VALUES: std::ops::RangeInclusive<usize> = 2..=10_000;
/// Points of a task: its cases, each along its axis, at each resolution.
const POINTS: usize = 100_000;
/// Characters of the id of a figure.
const ID: usize = 64;

/// Whether something can be meant.
pub(in crate::reproduce) type Checked = Result<(), Mistake>;

/// A part of a study: how a message names it, and where it stands in the file.
#[derive(Clone, Debug, Default)]
pub(in crate::reproduce) struct Spot {
    words: Vec<String>,
    steps: Vec<Step>,
}

impl Spot {
    /// A task of a figure; both from 1 in words.
    pub fn task(figure: (usize, &Figure), task: (usize, &super::Task)) -> Self {
        Spot::default()
            .entry("figure", figure.0, format!("figure {}", figure.1.id))
            .entry(
                "task",
                task.0,
                format!("task {} ({})", task.0 + 1, task.1.kind().name()),
            )
    }

    /// An entry of a list, and how it is named.
    pub fn entry(&self, key: &str, index: usize, words: String) -> Self {
        let mut spot = self.key(key);
        spot.steps.push(Step::At(index));
        spot.words.push(words);
        spot
    }

    /// A case of a task.
    pub fn case(&self, index: usize, case: &Case) -> Self {
        let words = if case.label.is_empty() {
            format!("case {}", index + 1)
        } else {
            format!("case `{}`", case.label)
        };
        self.entry("case", index, words)
    }

    /// What stands under a key.
    pub fn key(&self, key: &str) -> Self {
        let mut spot = self.clone();
        spot.steps.push(Step::Key(key.to_owned()));
        spot
    }

    /// The mistake that stands here.
    pub fn mistake(&self, message: impl AsRef<str>) -> Mistake {
        let mut words = self.words.join(", ");
        if !words.is_empty() {
            words += ": ";
        }
        Mistake {
            steps: self.steps.clone(),
            message: words + message.as_ref(),
        }
    }

    /// Refuses what is not so.
    pub fn demand(&self, so: bool, message: impl FnOnce() -> String) -> Checked {
        if so {
            Ok(())
        } else {
            Err(self.mistake(message()))
        }
    }

    /// Refuses a list without entries.
    fn not_empty<T>(&self, key: &str, list: &[T], of: &str) -> Checked {
        self.key(key).demand(!list.is_empty(), || {
            format!("`{key}` is empty: it accepts one or more {of}")
        })
    }

    /// Refuses a number that is not finite.
    fn finite(&self, key: &str, value: f64) -> Checked {
        self.key(key).demand(value.is_finite(), || {
            format!("{key} = {value}: it accepts finite numbers")
        })
    }

    /// Refuses a wavenumber that cannot be one.
    fn wavenumber(&self, key: &str, k: f64) -> Checked {
        WaveVector::wave(k)
            .map(|_| ())
            .map_err(|error| self.key(key).mistake(error.to_string()))
    }

    /// Refuses a number of collocation points out of range, as the command line does.
    fn resolution(&self, key: &str, resolution: usize) -> Checked {
        check_resolution(resolution)
            .map_err(|error| self.key(key).mistake(format!("{key}: {error}")))
    }

    /// Refuses two numbers that are no range from the lower to the upper.
    fn range(&self, key: &str, [from, to]: [f64; 2]) -> Checked {
        let so = from.is_finite() && to.is_finite() && from < to;
        self.key(key).demand(so, || {
            format!("{key} = [{from}, {to}]: it accepts two finite numbers, the lower first")
        })?;
        self.key(key).demand((to - from).is_finite(), || {
            format!("{key} = [{from:e}, {to:e}]: it accepts a range whose width is a number, below {:.1e}", f64::MAX)
        })
    }
}

/// What is well written but cannot be meant.
pub(super) fn check(study: &Study) -> Checked {
    let top = Spot::default();
    top.resolution("resolution", study.resolution)?;
    top.not_empty("figure", &study.figure, "sections")?;
    let mut ids: Vec<String> = Vec::new();
    for (index, figure) in study.figure.iter().enumerate() {
        let spot = top.entry("figure", index, format!("figure {}", figure.id));
        id(&spot.key("id"), &figure.id)?;
        // Two names that differ in the size of letters alone are one file on some systems.
        spot.key("id")
            .demand(!ids.contains(&figure.id.to_lowercase()), || {
                format!(
                    "two figures have the id `{}`: the files of one would replace those of the other",
                    figure.id
                )
            })?;
        ids.push(figure.id.to_lowercase());
        spot.not_empty("task", &figure.task, "tasks")?;
        for (number, task) in figure.task.iter().enumerate() {
            let spot = Spot::task((index, figure), (number, task));
            cases(&spot, task.kind().cases())?;
            task.kind().check(&spot)?;
        }
    }
    Ok(())
}

/// An id begins the names of files and is the aim of links.
fn id(spot: &Spot, id: &str) -> Checked {
    let letters = |c: char| c.is_ascii_alphanumeric() || c == '-';
    let so = !id.is_empty()
        && !id.starts_with('-')
        && !id.ends_with('-')
        && id.len() <= ID
        && id.chars().all(letters);
    spot.demand(so, || {
        format!(
            "id = {id:?}: it begins the names of files, and accepts up to {ID} letters (a to z), digits and hyphens, a \
             letter or a digit at both ends"
        )
    })
}

fn cases(spot: &Spot, cases: &[Case]) -> Checked {
    spot.not_empty("case", cases, "cases")?;
    for (index, case) in cases.iter().enumerate() {
        let spot = spot.case(index, case);
        if let Some(resolution) = case.resolution {
            spot.resolution("resolution", resolution)?;
        }
        if let Some(k) = case.k {
            spot.wavenumber("k", k)?;
        }
    }
    Ok(())
}

/// The values of an axis.
fn axis(spot: &Spot, key: &str, axis: &Axis) -> Checked {
    let spot = spot.key(key);
    spot.key("count").demand(VALUES.contains(&axis.count), || {
        let (least, most) = (VALUES.start(), VALUES.end());
        format!(
            "count = {} along `{}`: it accepts whole numbers from {least} to {most}",
            axis.count, axis.name
        )
    })?;
    spot.finite("from", axis.from)?;
    spot.finite("to", axis.to)?;
    spot.key("from").demand(axis.from < axis.to, || {
        format!(
            "`{}` goes from {} to {}: an axis accepts the lower end as `from`",
            axis.name, axis.from, axis.to
        )
    })?;
    if axis.name == "k" {
        spot.wavenumber("from", axis.from)?;
    }
    let geometric = axis.spacing == Spacing::Geometric;
    spot.key("from").demand(!geometric || axis.from > 0.0, || {
        format!(
            "`{}` by equal factors accepts numbers above zero",
            axis.name
        )
    })?;
    // Values lie at parts of the width, or of the quotient.
    let (what, size) = match axis.spacing {
        Spacing::Even => ("width", axis.to - axis.from),
        Spacing::Geometric => ("quotient", axis.to / axis.from),
    };
    spot.key("to").demand(size.is_finite(), || {
        format!(
            "`{}` goes from {:e} to {:e}: an axis accepts ends whose {what} is a number, below {:.1e}",
            axis.name,
            axis.from,
            axis.to,
            f64::MAX
        )
    })
}

/// Refuses cases that fix what an axis varies.
fn free(spot: &Spot, cases: &[Case], axis: &Axis) -> Checked {
    let name = &axis.name;
    if name == "k" {
        for (index, case) in cases.iter().enumerate() {
            let k = case.k.unwrap_or_default();
            spot.case(index, case)
                .key("k")
                .demand(case.k.is_none(), || {
                    format!("k = {k} stands beside an axis of k: a task accepts one of the two")
                })?;
        }
    }
    not_set(spot, cases, name)
}

/// Refuses cases that set a parameter which varies.
fn not_set(spot: &Spot, cases: &[Case], name: &str) -> Checked {
    for (index, case) in cases.iter().enumerate() {
        let sets = |text: &&String| text.split_once('=').is_some_and(|(n, _)| n.trim() == name);
        let set = case.set.iter().find(sets);
        spot.case(index, case)
            .key("set")
            .demand(set.is_none(), || {
                format!(
                    "`{}` stands beside an axis of {name}: a task accepts one of the two",
                    set.map_or("", String::as_str)
                )
            })?;
    }
    Ok(())
}

/// An axis that can be nothing but the wavenumber.
fn along_k(spot: &Spot, over: &Axis) -> Checked {
    axis(spot, "over", over)?;
    spot.key("over").key("name").demand(over.name == "k", || {
        format!("name = `{}`: this task goes along `k` alone", over.name)
    })
}

/// Bounds the work of a task.
fn points(spot: &Spot, cases: &[Case], factors: &[usize]) -> Checked {
    let product = factors
        .iter()
        .try_fold(cases.len(), |product, factor| product.checked_mul(*factor));
    spot.demand(product.is_some_and(|points| points <= POINTS), || {
        format!("the task asks for more than {POINTS} points: give it fewer cases, values or resolutions")
    })
}

/// Every case needs a wavenumber of its own.
fn each_has_k(spot: &Spot, cases: &[Case], why: &str) -> Checked {
    for (index, case) in cases.iter().enumerate() {
        let spot = spot.case(index, case);
        spot.key("k").demand(case.k.is_some(), || {
            format!("`k` is missing: {why}; it accepts a positive number")
        })?;
    }
    Ok(())
}
