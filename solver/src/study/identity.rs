//! Everything that the rows of a sweep follow from, by name: files of one sweep are told by it from another's.

use super::sweep::{Range, Sweep};
use crate::file::hash;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What a journal, a share or a table was computed from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepIdentity {
    /// Name of the model.
    pub model: String,
    /// Hash of the text of the spec and its laws.
    pub sources: String,
    /// The axes, the first varying fastest.
    pub axes: Vec<AxisIdentity>,
    /// Values of the parameters that do not vary, by name, as a user writes them.
    pub parameters: BTreeMap<String, String>,
    /// M
    #[serde(rename = "M")]
    pub resolution: usize,
    /// The wavenumber, where it does not vary.
    pub k: Option<f64>,
    /// Which mode the rows hold, in words.
    pub mode: String,
    /// Columns besides those of every sweep.
    pub columns: Vec<String>,
    /// Version of the program.
    pub version: String,
    /// Build of the solver and of the generator.
    pub build: String,
}

/// One axis of a sweep, in a length that does not depend on its number of values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisIdentity {
    /// `k` or a parameter.
    pub name: String,
    /// Number of values.
    pub count: usize,
    /// The first value.
    pub from: Option<f64>,
    /// The last value.
    pub to: Option<f64>,
    /// Hash of all values.
    pub values: String,
}

impl AxisIdentity {
    fn new(range: &Range) -> Self {
        let bytes = range.values.iter().flat_map(|value| value.to_le_bytes());
        AxisIdentity {
            name: range.name.clone(),
            count: range.values.len(),
            from: range.values.first().copied(),
            to: range.values.last().copied(),
            values: format!("{:016x}", hash(bytes)),
        }
    }

    fn words(&self) -> String {
        let end = |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
        format!(
            "{} values from {} to {}, hash {}",
            self.count,
            end(self.from),
            end(self.to),
            self.values
        )
    }
}

/// Longest value that a message quotes, in characters.
const QUOTED: usize = 60;

impl SweepIdentity {
    /// The identity of a sweep.
    pub fn new(sweep: &Sweep) -> Self {
        let (setup, structure) = (sweep.setup, sweep.setup.model.structure());
        let varies = |name: &str| sweep.ranges.iter().any(|range| range.name == name);
        let parameters = structure.parameters.pairs();
        let fixed = parameters.filter(|(_, info)| !varies(&info.name));
        let shown = |id| setup.parameters.shown(structure, id);
        SweepIdentity {
            model: structure.name.clone(),
            sources: setup.hash(),
            axes: sweep.ranges.iter().map(AxisIdentity::new).collect(),
            parameters: fixed
                .map(|(id, info)| (info.name.clone(), shown(id)))
                .collect(),
            resolution: setup.resolution,
            k: sweep.k,
            mode: sweep.mode.to_string(),
            columns: sweep.derived.iter().map(|d| d.name.clone()).collect(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            build: setup.build(),
        }
    }

    /// The first thing in which two sweeps differ, in one line: `M is 50 here and 60 there`.
    pub fn difference(&self, there: &Self) -> Option<String> {
        let there = there.named();
        let pairs = self.named().into_iter().zip(&there);
        for ((name, value), (name_there, value_there)) in pairs {
            if name != *name_there {
                return Some(format!("it has {name} here and {name_there} there"));
            }
            if value != *value_there {
                let [here, there] = [&value, value_there].map(|text| quoted(text));
                return Some(format!("{name} is {here} here and {there} there"));
            }
        }
        None
    }

    /// Whether both are tables of one sweep, whichever builds computed them.
    pub fn is_same_table(&self, there: &Self) -> bool {
        let by_one_build = SweepIdentity {
            version: self.version.clone(),
            build: self.build.clone(),
            ..there.clone()
        };
        *self == by_one_build
    }

    /// Every part by its name, in words; parts on which the presence of later ones depends come first.
    fn named(&self) -> Vec<(String, String)> {
        let text = |name: &str, value: String| (name.to_owned(), value);
        let or_none = |value: Option<String>| value.unwrap_or_else(|| "none".to_owned());
        let names: Vec<&str> = self.axes.iter().map(|axis| axis.name.as_str()).collect();
        let mut parts = vec![
            text("the model", self.model.clone()),
            text("the hash of the spec and its laws", self.sources.clone()),
            text("the list of axes", names.join(", ")),
        ];
        for axis in &self.axes {
            parts.push((format!("the axis {}", axis.name), axis.words()));
        }
        for (name, value) in &self.parameters {
            parts.push((name.clone(), value.clone()));
        }
        parts.extend([
            text("M", self.resolution.to_string()),
            text("k", or_none(self.k.map(|k| k.to_string()))),
            text("the mode of the rows", self.mode.clone()),
            text("the list of columns", self.columns.join("; ")),
            text("the version of Landau", self.version.clone()),
            text("the build of Landau", self.build.clone()),
        ]);
        parts
    }
}

fn quoted(text: &str) -> String {
    let mut quoted: String = text.chars().take(QUOTED).collect();
    if quoted.len() < text.len() {
        quoted.push('…');
    }
    if quoted.is_empty() {
        quoted = "empty".to_owned();
    }
    quoted
}

#[cfg(test)]
impl SweepIdentity {
    /// Some sweep.
    pub fn example() -> Self {
        SweepIdentity {
            model: "m".to_owned(),
            sources: "0".to_owned(),
            axes: vec![AxisIdentity {
                name: "k".to_owned(),
                count: 3,
                from: Some(0.1),
                to: Some(0.3),
                values: "0".to_owned(),
            }],
            parameters: BTreeMap::from([("S".to_owned(), "100".to_owned())]),
            resolution: 50,
            k: None,
            mode: "leading".to_owned(),
            columns: Vec::new(),
            version: "0.1.0".to_owned(),
            build: "a".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::SweepIdentity;
    use std::collections::BTreeMap;

    #[test]
    fn the_first_difference_is_named() {
        let here = SweepIdentity::example();
        assert_eq!(here.difference(&SweepIdentity::example()), None);
        let said = |change: &dyn Fn(&mut SweepIdentity)| {
            let mut there = SweepIdentity::example();
            change(&mut there);
            here.difference(&there).expect("a difference")
        };
        assert_eq!(said(&|i| i.resolution = 60), "M is 50 here and 60 there");
        assert_eq!(
            said(&|i| i.parameters = BTreeMap::from([("S".to_owned(), "auto".to_owned())])),
            "S is 100 here and auto there"
        );
        assert!(said(&|i| i.axes[0].count = 4).contains("3 values from 0.1 to 0.3"));
        assert!(
            said(&|i| i.columns = vec!["c".repeat(9000)])
                .chars()
                .count()
                < 200
        );
        assert!(said(&|i| i.build = "b".to_owned()).contains("build"));
    }

    #[test]
    fn a_table_does_not_belong_to_a_build() {
        let mut there = SweepIdentity::example();
        there.build = "b".to_owned();
        assert!(SweepIdentity::example().is_same_table(&there));
        there.k = Some(1.0);
        assert!(!SweepIdentity::example().is_same_table(&there));
    }
}
