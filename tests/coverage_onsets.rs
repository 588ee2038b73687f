//! Do the error bars of onsets hold? Random parameters, each onset against an exact value or one of much higher resolution:
//! the slow profile, `cargo test --workspace -- --ignored`.

use crate::support::{built, number};
use landau_solver::study::critical::{CriticalReport, Quantity, Question, Request, Tracking};
use landau_solver::study::{Setup, Silent};
use serde_json::Value;

/// A model, its range of M, the M of the truth, and the question at random parameters.
struct Family {
    model: &'static str,
    resolutions: [f64; 2],
    truth: usize,
    vary: &'static str,
    between: [f64; 2],
    minimize: [f64; 2],
    /// Parameters with their ranges.
    set: &'static [(&'static str, f64, f64)],
    count: usize,
}

const FAMILIES: [Family; 6] = [
    Family {
        model: "swift_hohenberg",
        resolutions: [10.0, 10.0],
        truth: 10,
        vary: "r",
        between: [-0.4, 0.7],
        minimize: [0.4, 2.0],
        set: &[("b", -2.0, 2.0)],
        count: 20,
    },
    Family {
        model: "brusselator",
        resolutions: [10.0, 10.0],
        truth: 10,
        vary: "B",
        between: [0.5, 30.0],
        minimize: [0.05, 20.0],
        set: &[("A", 2.0, 4.0), ("D1", 0.1, 1.0), ("D2", 3.0, 10.0)],
        count: 20,
    },
    Family {
        model: "swift_hohenberg_strip",
        resolutions: [14.0, 50.0],
        truth: 36,
        vary: "r",
        between: [-0.4, 3.0],
        minimize: [0.5, 1.5],
        set: &[("b", -2.0, 2.0)],
        count: 8,
    },
    Family {
        model: "rayleigh_benard",
        resolutions: [12.0, 40.0],
        truth: 50,
        vary: "Ra",
        between: [1200.0, 2500.0],
        minimize: [2.0, 5.0],
        set: &[("Pr", 0.2, 20.0)],
        count: 8,
    },
    Family {
        model: "plane_poiseuille",
        resolutions: [32.0, 70.0],
        truth: 110,
        vary: "R",
        between: [5000.0, 6500.0],
        minimize: [0.9, 1.15],
        set: &[],
        count: 4,
    },
    Family {
        model: "vibrated_bed",
        resolutions: [40.0, 60.0],
        truth: 90,
        vary: "S",
        between: [30.0, 90.0],
        minimize: [0.06, 0.2],
        set: &[("F", 5.5, 6.5), ("e", 0.89, 0.91)],
        count: 2,
    },
];

impl Family {
    /// The `index`-th question, at one resolution of its own and at that of the truth.
    fn pair(&self, index: usize) -> Option<[CriticalReport; 2]> {
        // Multiples of irrational numbers are spread evenly.
        let part =
            |name: usize| ((index + 1) as f64 * (0.618_033_988_75 + 0.101_3 * name as f64)).fract();
        let [low, high] = self.resolutions;
        let own = low + (high - low) * part(0);
        let answer = |m: usize| {
            let mut setup = Setup::new(built(self.model), m).expect("M");
            let values = self.set.iter().enumerate();
            let set: Vec<String> = values
                .map(|(i, (name, from, to))| format!("{name}={}", from + (to - from) * part(i + 1)))
                .collect();
            setup.set(&set).expect("parameters");
            let request = Request {
                vary: self.vary,
                between: self.between,
                of: Quantity::Growth,
                k: None,
                minimize: Some(self.minimize),
                tracking: Tracking::Leading,
            };
            let question = Question::new(&setup, &request).expect("a question");
            CriticalReport::compute(&setup, &question, &Silent).ok()
        };
        Some([answer(own as usize)?, answer(self.truth)?])
    }
}

/// The errors of onsets at random parameters cover an answer of much higher resolution, in 99 of 100 numbers.
#[test]
#[ignore = "slow profile"]
fn errors_of_random_onsets_hold() {
    let (mut total, mut outside) = (0, Vec::new());
    for family in &FAMILIES {
        let mut answers = 0;
        for [own, truth] in (0..family.count).filter_map(|index| family.pair(index)) {
            answers += 1;
            let numbers = |report: &CriticalReport| {
                let found = report.json(&report.found[0]);
                let mut numbers = vec![
                    (number(&found, "/value"), number(&found, "/error")),
                    (number(&found, "/k"), number(&found, "/k_error")),
                ];
                for name in ["tau0", "xi0_squared", "g", "group_velocity"] {
                    let value = found
                        .pointer(&format!("/envelope/{name}"))
                        .and_then(Value::as_f64);
                    let error = found.pointer(&format!("/envelope/error/{name}"));
                    let error = error.and_then(Value::as_f64);
                    numbers.push((value.unwrap_or(f64::NAN), error.unwrap_or(0.0)));
                }
                numbers
            };
            for (i, (a, b)) in numbers(&own).iter().zip(numbers(&truth)).enumerate() {
                if a.0.is_nan() || b.0.is_nan() {
                    continue;
                }
                total += 1;
                let ratio = (a.0 - b.0).abs() / (a.1 + b.1);
                if ratio > 1.0 {
                    outside.push(format!(
                        "{} number {i}: {:e} ± {:.0e}, by {ratio:.2}",
                        family.model, a.0, a.1
                    ));
                }
            }
        }
        assert!(
            2 * answers > family.count,
            "{}: {answers} answers",
            family.model
        );
    }
    println!(
        "{} of {total} outside\n{}",
        outside.len(),
        outside.join("\n")
    );
    assert!(
        outside.len() * 100 <= total,
        "{} of {total} outside\n{}",
        outside.len(),
        outside.join("\n")
    );
}
