//! A Landau point in words.

use super::PointReport;
use crate::measured::{Decided, Measured};
use crate::model::C64;
use crate::study::amplitudes::NAMED;
use crate::weakly::{Side, Stable};
use crate::words;
use std::fmt;

impl fmt::Display for PointReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at k = {}", self.title, self.k)?;
        if self.has_coordinate {
            write!(f, ", M = {}", self.resolution)?;
        }
        let [c0, c2] = [self.equation.coefficients[0], self.equation.coefficients[1]];
        write!(f, "\n  {}", words::amplitude_equation(c0, c2))?;
        write!(f, "\n  c0 = {c0}\n  c2 = {c2}")?;
        write!(f, "\n  {}", self.bifurcation)?;
        if self.bifurcation.side == Side::Degenerate {
            write!(f, ": Re c2 is zero within its error")?;
        }
        self.write_amplitude(f)?;
        self.write_orders(f)?;
        write!(f, "\n  distance to resonance: ")?;
        if self.resonance.mean_flow.value.is_finite() {
            write!(f, "mean flow {}, ", self.resonance.mean_flow)?;
        }
        write!(f, "2:1 {}", self.resonance.second_harmonic)?;
        for output in &self.outputs {
            let (name, base, correction) = (&output.name, output.base, output.correction);
            write!(f, "\n  {name} = ({base}) + ({correction}) A²")?;
        }
        for (name, slope) in &self.dc0 {
            match slope {
                Ok(slope) => write!(f, "\n  dc0/d{name} = {slope}")?,
                Err(reason) => write!(f, "\n  dc0/d{name} is not available: {reason}")?,
            }
        }
        self.write_envelope(f)?;
        self.write_waves(f)?;
        for integral in &self.undeclared {
            write!(f, "\n  {}", words::undeclared(integral))?;
        }
        for divisor in self.small_divisors.iter().take(NAMED) {
            write!(f, "\n  {divisor}")?;
        }
        if self.small_divisors.len() > NAMED {
            let more = self.small_divisors.len() - NAMED;
            write!(f, "\n  and {more} more of them")?;
        }
        for note in &self.notes {
            write!(f, "\n  note: {note}")?;
        }
        Ok(())
    }
}

impl PointReport {
    /// −Im dc0/dk
    pub(super) fn group_velocity(&self) -> Measured {
        -self.slope.im()
    }

    fn write_amplitude(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let by = &self.normalization;
        match &self.amplitude {
            Ok(amplitude) => write!(f, "\n  A_e = {amplitude}, normalised by {by}"),
            Err(_) if self.c0.re.abs() <= self.error.c0 => {
                write!(f, "\n  neutral within the error of c0; normalised by {by}")
            }
            Err(reason) => write!(f, "\n  {reason}; normalised by {by}"),
        }
    }

    /// Coefficients and amplitudes beyond third order.
    fn write_orders(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.equation.order() == 3 {
            return Ok(());
        }
        let higher = self.equation.coefficients.iter().enumerate().skip(2);
        for (n, coefficient) in higher {
            write!(f, "\n  c{} = {coefficient}", 2 * n)?;
        }
        let radius = self.equation.radius();
        let judged = |amplitude: Decided| match (amplitude, &radius) {
            (Err(reason), _) => reason,
            (Ok(amplitude), Ok(radius)) if amplitude.value > radius.value => {
                format!("{amplitude} (beyond the radius of convergence)")
            }
            (Ok(amplitude), _) => amplitude.to_string(),
        };
        for order in self.orders() {
            let amplitude = judged(self.equation.equilibrium(order));
            write!(f, "\n  A_e at order {order}: {amplitude}")?;
        }
        let pade = judged(self.equation.pade());
        write!(f, "\n  A_e of the Padé approximant: {pade}")?;
        match radius {
            Ok(radius) => write!(
                f,
                "\n  the series converges to about A = {}",
                radius.digits(4)
            ),
            Err(reason) => write!(f, "\n  radius of convergence not decided: {reason}"),
        }
    }

    fn write_envelope(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (slope, curvature) = (self.slope, self.curvature);
        write!(f, "\n  envelope: dc0/dk = {slope}, d²c0/dk² = {curvature}")?;
        if self.c0.im != 0.0 {
            write!(f, "; group velocity {}, ", self.group_velocity())?;
            match &self.benjamin_feir {
                Ok(number) if number.sign().is_none() => {
                    write!(f, "Benjamin–Feir number {number}: its sign is not decided")?
                }
                Ok(number) => write!(f, "Benjamin–Feir number {number}")?,
                Err(reason) => write!(f, "Benjamin–Feir number not decided: {reason}")?,
            }
        }
        if self.conserved_mean {
            write!(
                f,
                " (a conserved mean couples in: the envelope needs an equation for it)"
            )?;
        }
        Ok(())
    }

    fn write_waves(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let waves = match &self.waves {
            None => return Ok(()),
            Some(Err(reason)) => return write!(f, "\n  {reason}"),
            Some(Ok(waves)) => waves,
        };
        let verdict = match waves.stable() {
            None => "which waves are stable is not decided within the errors".to_owned(),
            Some(Stable::Neither) => {
                "neither travelling nor standing waves are stable at cubic order".to_owned()
            }
            Some(stable) => format!("{stable} waves are stable"),
        };
        let [own, cross]: [Measured<C64>; 2] = [waves.self_coefficient, waves.cross];
        write!(
            f,
            "\n  waves: c2 is that of travelling waves; self {own}, cross {cross}: {verdict}"
        )
    }
}
