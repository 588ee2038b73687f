//! Integrals that a spec calls conserved, checked in the collocated problem at k = 0.
//!
//! For an eigenvector of eigenvalue c, d/dt ∫ density dy = c ∫ density dy. An integral is conserved if and only if it
//! vanishes for all eigenvectors with c ≠ 0; it then is nonzero for one with c = 0.

use super::Problem;
use super::linear::with_borders;
use crate::error::{Error, Result};
use crate::model::{C64, ClosureKind};
use crate::numerics::dense::norm;
use crate::pencil::Reduced;
use crate::wavevector::WaveVector;

/// An eigenvalue below this part of the scale of its spectrum is zero, and so is an integral below this part of |row| |x|.
/// Slow modes are resolved to far less, and an integral that is not conserved is of order one.
const TOLERANCE: f64 = 1e-6;
/// Number of eigenvectors that are looked at: the slowest ones, which every collocation resolves.
const SLOW: usize = 6;

impl Problem {
    /// Checks the closures that the spec claims to be conserved. Where switches choose between boundary conditions, an
    /// integral that is not conserved may be so for another choice, and its closure is dropped.
    ///
    /// # Errors
    /// A claimed integral is not conserved, and there are no switches.
    pub(super) fn recognise_claims(&mut self) -> Result<()> {
        let is_claim = |position: &usize| self.borders[*position].kind == ClosureKind::Claimed;
        let claims: Vec<usize> = (0..self.borders.len()).filter(is_claim).collect();
        if claims.is_empty() {
            return Ok(());
        }
        let unclaimed = self
            .borders
            .iter()
            .filter(|b| b.kind != ClosureKind::Claimed);
        let unclaimed: Vec<_> = unclaimed.cloned().collect();
        let pencil = with_borders(self.direct.pencil(WaveVector::MEAN), &unclaimed);
        let slow = Reduced::<f64>::new(pencil).and_then(|pencil| pencil.eigenvectors());
        // A problem that is singular bears nothing out.
        let (zero, mut modes) = slow.map_or((0.0, Vec::new()), |(spectrum, modes)| {
            (TOLERANCE * spectrum.scale(), modes)
        });
        modes.sort_by(|a, b| a.0.norm().total_cmp(&b.0.norm()));
        modes.truncate(SLOW);
        let borne_out = |position: usize| {
            let row = &self.borders[position].row;
            // |∫ density dy| relative to what it can be at most.
            let share = |mode: &[C64]| {
                let sum: C64 = row.iter().zip(mode).map(|(r, x)| *x * *r).sum();
                sum.norm() / (norm(row) * norm(mode))
            };
            let moving = modes.iter().filter(|(c, _)| c.norm() > zero);
            let still = modes.iter().filter(|(c, _)| c.norm() <= zero);
            moving.map(|(_, mode)| share(mode)).all(|s| s <= TOLERANCE)
                && still.map(|(_, mode)| share(mode)).any(|s| s > TOLERANCE)
        };
        let dropped: Vec<usize> = claims.into_iter().filter(|&p| !borne_out(p)).collect();
        if self.structure().cases.len() == 1
            && let Some(&position) = dropped.first()
        {
            return Err(Error::input(format!(
                "`{}` in the block `mean`: this integral is not conserved at these parameters; its density must change \
                 by a flux that vanishes at both ends",
                self.borders[position].name
            )));
        }
        for position in dropped.into_iter().rev() {
            self.borders.remove(position);
        }
        Ok(())
    }
}
