//! Tasks, one kind after another.

use super::critical::{asked, question};
use super::{Checked, Spot, along_k, axis, claims, each_has_k, free, not_set, points};
use crate::reproduce::study::kinds::{
    Circulation, Claims, Convergence, Critical, Kind, Law, Orders, Pattern, PowerLaw, Profiles,
    Resonance, SecondHarmonic, Spectrum, Sweep, Values,
};
use crate::reproduce::study::{Asked, Axis, Case, Reference, Tail, Together};
use landau_solver::study::orders::HIGHEST;

/// Wavelengths that a picture shows at most.
const WAVELENGTHS: f64 = 100.0;
/// Distances from a critical point.
const DISTANCES: std::ops::RangeInclusive<usize> = 3..=1000;

/// The name and the cases of a kind.
macro_rules! named {
    ($name:literal) => {
        fn name(&self) -> &'static str {
            $name
        }

        fn cases(&self) -> &[Case] {
            &self.case
        }

        fn cases_mut(&mut self) -> &mut Vec<Case> {
            &mut self.case
        }
    };
}

impl Kind for Profiles {
    named!("profiles");

    fn check(&self, spot: &Spot) -> Checked {
        spot.not_empty("fields", &self.fields, "fields or expressions")?;
        for (index, mark) in self.mark.iter().enumerate() {
            let spot = spot.entry("mark", index, format!("mark {}", index + 1));
            spot.finite("at", mark.at)?;
        }
        self.tail
            .as_ref()
            .map_or(Ok(()), |tail| of_tail(spot, tail))
    }
}

impl Kind for Law {
    named!("law");

    fn check(&self, spot: &Spot) -> Checked {
        spot.not_empty("expressions", &self.expressions, "expressions")?;
        axis(spot, "over", &self.over)?;
        for (name, value) in &self.at {
            spot.key("at").finite(name, *value)?;
        }
        points(spot, &self.case, &[self.over.count])
    }
}

impl Kind for Convergence {
    named!("convergence");

    fn check(&self, spot: &Spot) -> Checked {
        axis(spot, "over", &self.over)?;
        each_along(spot, &self.case, &self.over)?;
        let several = self.resolutions.len() > 1;
        spot.key("resolutions").demand(several, || {
            "resolutions: it accepts two or more, for each is compared with the last".to_owned()
        })?;
        of_resolutions(spot, &self.resolutions)?;
        points(spot, &self.case, &[self.over.count, self.resolutions.len()])
    }
}

impl Kind for Spectrum {
    named!("spectrum");

    fn check(&self, spot: &Spot) -> Checked {
        along_k(spot, &self.over)?;
        free(spot, &self.case, &self.over)?;
        of_resolutions(spot, &self.resolutions)?;
        points(spot, &self.case, &[self.over.count, self.resolutions.len()])
    }
}

impl Kind for Sweep {
    named!("sweep");

    fn references(&self) -> &[Reference] {
        &self.reference
    }

    fn check(&self, spot: &Spot) -> Checked {
        let over = &self.over;
        axis(spot, "over", over)?;
        each_along(spot, &self.case, over)?;
        panels(spot, &self.columns, &self.reference)?;
        marks(spot, &self.mark, &over.name, &self.case)?;
        let so = !self.logarithmic[0] || over.from > 0.0;
        spot.key("logarithmic").demand(so, || {
            format!(
                "a logarithmic axis accepts numbers above zero: `{}` begins at {}",
                over.name, over.from
            )
        })?;
        points(spot, &self.case, &[over.count])
    }
}

impl Kind for Resonance {
    named!("resonance");

    fn check(&self, spot: &Spot) -> Checked {
        along_k(spot, &self.over)?;
        free(spot, &self.case, &self.over)?;
        marks(spot, &self.mark, "k", &self.case)?;
        points(spot, &self.case, &[self.over.count, 2])
    }
}

impl Kind for Orders {
    named!("orders");

    fn check(&self, spot: &Spot) -> Checked {
        along_k(spot, &self.over)?;
        free(spot, &self.case, &self.over)?;
        let highest = self.highest;
        let so = !highest.is_multiple_of(2) && (5..=HIGHEST).contains(&highest);
        spot.key("highest").demand(so, || {
            format!("highest = {highest} is no order: it accepts odd numbers from 5 to {HIGHEST}")
        })?;
        for (index, [k, amplitude]) in self.reference.iter().enumerate() {
            let spot = spot.entry("reference", index, format!("reference {}", index + 1));
            let so = k.is_finite() && amplitude.is_finite() && *k > 0.0;
            spot.demand(so, || {
                format!("[{k}, {amplitude}]: it accepts a wavenumber and an amplitude")
            })?;
        }
        points(spot, &self.case, &[self.over.count, highest])
    }
}

impl Kind for SecondHarmonic {
    named!("second_harmonic");

    fn check(&self, spot: &Spot) -> Checked {
        along_k(spot, &self.over)?;
        free(spot, &self.case, &self.over)?;
        points(spot, &self.case, &[self.over.count])
    }
}

impl Kind for Critical {
    named!("critical");

    fn check(&self, spot: &Spot) -> Checked {
        spot.not_empty("asked", &self.asked, "questions")?;
        for index in 0..self.asked.len() {
            self.check_question(spot, index)?;
        }
        if let Some(over) = &self.against {
            axis(spot, "against", over)?;
            free(spot, &self.case, over)?;
        }
        let values = self.against.as_ref().map_or(1, |axis| axis.count);
        points(spot, &self.case, &[values, self.asked.len()])
    }
}

impl Critical {
    /// A question, by its position, with its name and its wavenumber beside the axis.
    fn check_question(&self, spot: &Spot, index: usize) -> Checked {
        let question_here = &self.asked[index];
        let (name, vary) = (&question_here.name, &question_here.vary);
        let spot = spot.entry("asked", index, format!("question {}", index + 1));
        let earlier = self.asked[..index].iter().any(|q| q.name == *name);
        spot.key("name").demand(!earlier, || {
            format!("two questions are called `{name}`: numbers are found by their names")
        })?;
        match &self.against {
            // The axis says at which wavenumber.
            Some(axis) if axis.name == "k" => {
                spot.key("vary").demand(vary != "k", || {
                    "vary = `k` against an axis of `k`: it accepts a parameter".to_owned()
                })?;
                question(&spot, question_here)?;
                let free = question_here.k.is_none() && question_here.minimize.is_none();
                spot.key("k").demand(free, || {
                    "`k` or `minimize` stands beside an axis of `k`: a question accepts one wavenumber"
                        .to_owned()
                })?;
            }
            _ => asked(&spot, question_here, &self.case)?,
        }
        let same = self.against.as_ref().is_some_and(|axis| axis.name == *vary);
        spot.key("vary").demand(!same, || {
            format!("vary = `{vary}` is the axis too: it accepts another name")
        })
    }
}

impl Kind for Claims {
    named!("claims");

    fn check(&self, spot: &Spot) -> Checked {
        spot.not_empty("claim", &self.claim, "statements")?;
        for (index, statement) in self.claim.iter().enumerate() {
            claims::statement(spot, index, statement, &self.case)?;
        }
        Ok(())
    }
}

impl Kind for Values {
    named!("values");

    fn check(&self, spot: &Spot) -> Checked {
        each_has_k(spot, &self.case, "values are those of a Landau point")
    }
}

impl Kind for PowerLaw {
    named!("power_law");

    fn check(&self, spot: &Spot) -> Checked {
        asked(&spot.key("critical"), &self.critical, &self.case)?;
        not_set(spot, &self.case, &self.critical.vary)?;
        let count = self.count;
        spot.key("count").demand(DISTANCES.contains(&count), || {
            let (least, most) = (DISTANCES.start(), DISTANCES.end());
            format!("count = {count}: it accepts whole numbers from {least} to {most}")
        })?;
        let [near, far] = self.distances;
        let one_side = near.signum() == far.signum();
        let so = one_side && near != 0.0 && near.abs() < far.abs() && far.is_finite() && far > -1.0;
        spot.key("distances").demand(so, || {
            format!(
                "distances = [{near}, {far}]: it accepts two relative distances of one sign, the nearer first, above −1"
            )
        })?;
        // The law is that of one axis; an extremum over k moves along another.
        spot.key("critical")
            .key("minimize")
            .demand(self.critical.minimize.is_none(), || {
                "minimize: a power law is taken at one `k`".to_owned()
            })?;
        points(spot, &self.case, &[count])
    }
}

impl Kind for Pattern {
    named!("pattern");

    fn check(&self, spot: &Spot) -> Checked {
        each_has_k(spot, &self.case, "a pattern is that of a Landau point")?;
        let wavelengths = self.wavelengths;
        let so = wavelengths > 0.0 && wavelengths <= WAVELENGTHS;
        spot.key("wavelengths").demand(so, || {
            format!("wavelengths = {wavelengths}: it accepts a number above 0, up to {WAVELENGTHS}")
        })
    }
}

impl Kind for Circulation {
    named!("circulation");

    fn check(&self, spot: &Spot) -> Checked {
        axis(spot, "over", &self.over)?;
        let along_k = self.over.name == "k";
        spot.key("over").key("name").demand(!along_k, || {
            "name = `k`: a circulation goes along a parameter, at one `k`".to_owned()
        })?;
        free(spot, &self.case, &self.over)?;
        spot.wavenumber("k", self.k)?;
        let side = self.side;
        spot.key("side").demand(side > 0.0 && side <= 1.0, || {
            format!("side = {side}: it accepts a part of the wavelength, above 0 up to 1")
        })?;
        points(spot, &self.case, &[self.over.count])
    }
}

/// Panels of a sweep, and the points of others that are drawn in them.
fn panels(spot: &Spot, columns: &[Together], reference: &[Reference]) -> Checked {
    spot.not_empty("columns", columns, "columns")?;
    for (index, together) in columns.iter().enumerate() {
        let spot = spot.entry("columns", index, format!("column {}", index + 1));
        spot.demand(!together.drawn().is_empty(), || {
            "a panel without columns: brackets accept one or more".to_owned()
        })?;
    }
    for (index, reference) in reference.iter().enumerate() {
        let spot = spot.entry("reference", index, format!("reference {}", index + 1));
        let (panel, count) = (reference.panel, columns.len());
        spot.key("panel").demand((1..=count).contains(&panel), || {
            format!("panel = {panel}: it accepts 1 to {count}")
        })?;
    }
    Ok(())
}

/// Where a parameter varies, every case says at which wavenumber; no case fixes what varies.
fn each_along(spot: &Spot, cases: &[Case], over: &Axis) -> Checked {
    free(spot, cases, over)?;
    if over.name == "k" {
        return Ok(());
    }
    let why = format!(
        "the axis is `{}`, and a row is a Landau point at a wavenumber",
        over.name
    );
    each_has_k(spot, cases, &why)
}

/// Marks are verticals on the axis.
fn marks(spot: &Spot, marks: &[Asked], over: &str, cases: &[Case]) -> Checked {
    for (index, mark) in marks.iter().enumerate() {
        let spot = spot.entry("mark", index, format!("mark {}", index + 1));
        asked(&spot, mark, cases)?;
        spot.key("vary").demand(mark.vary == over, || {
            format!(
                "vary = `{}`: a mark is a vertical on the axis, and accepts `{over}`",
                mark.vary
            )
        })?;
    }
    Ok(())
}

fn of_resolutions(spot: &Spot, resolutions: &[usize]) -> Checked {
    spot.not_empty("resolutions", resolutions, "numbers of collocation points")?;
    resolutions
        .iter()
        .try_for_each(|&resolution| spot.resolution("resolutions", resolution))
}

fn of_tail(spot: &Spot, tail: &Tail) -> Checked {
    let spot = spot.key("tail");
    spot.range("between", tail.between)?;
    let [from, to] = tail.between;
    spot.key("between").demand(from >= 0.0 && to <= 1.0, || {
        format!("between = [{from}, {to}]: it accepts parts of the interval, from 0 to 1")
    })
}
