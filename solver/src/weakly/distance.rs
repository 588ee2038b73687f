//! Small divisors: how far the solved problems of an expansion are from singularity.

use crate::model::C64;
use crate::series::Monomial;
use crate::wavevector::WaveVector;

/// How far one solved problem is from singularity.
#[derive(Clone, Debug)]
pub struct Distance {
    /// α of the coefficient X_α that was solved for.
    pub monomial: Monomial,
    /// q_α
    pub q: WaveVector,
    /// σ_α
    pub shift: C64,
    /// Distance of σ_α from the spectrum of L at q, in units of σ_α.
    pub distance: f64,
}

impl Distance {
    /// A message: which mode is near, and the command that gives it an amplitude beside those of the modes at the
    /// wavenumbers `q`.
    pub fn in_words(&self, q: &[f64]) -> String {
        let (name, distance) = (self.monomial.name(), self.distance);
        if self.q.is_mean() {
            return format!(
                "small divisor: the mean that {name} forces is met by a slow mean mode, {distance:.1e} away"
            );
        }
        let mut modes: Vec<String> = q.iter().map(|q| format!("--mode k={q}")).collect();
        modes.push(if q.contains(&self.q.k()) {
            // A mode at this wavenumber has an amplitude already: tell the two apart by their eigenvalues.
            format!(
                "--mode k={},near={:.6}:{:.6}",
                self.q, self.shift.re, self.shift.im
            )
        } else {
            format!("--mode k={}", self.q)
        });
        format!(
            "small divisor: {name} meets a mode at k = {}, {distance:.1e} away, which wants an amplitude of its own: \
             landau amplitudes with {}",
            self.q,
            modes.join(" ")
        )
    }
}
