//! Integrals that a spec calls conserved, recognised in the collocated problem at k = 0.
//!
//! d/dt ∫ density = c ∫ density for an eigenvector of eigenvalue c, so that an integral is conserved if and
//! only if it vanishes for all of them but one, whose eigenvalue is zero.

use super::Problem;
use super::linear::with_borders;
use crate::error::{Error, Result};
use crate::model::{C64, ClosureKind};
use crate::numerics::dense::norm;
use crate::pencil::Reduced;
use crate::wavevector::WaveVector;

/// What counts as zero, relative to the terms.
const TOLERANCE: f64 = 1e-6;
/// Eigenvectors that are looked at: the slow ones, which are resolved.
const SLOW: usize = 6;

impl Problem {
    /// Recognises the claimed closures. Where switches change the walls, one that the problem does not bear out may
    /// hold for other choices, and is dropped.
    ///
    /// # Errors
    /// A claim that the problem does not bear out, whatever the switches.
    pub(super) fn recognise_claims(&mut self) -> Result<()> {
        let is_claim = |position: &usize| self.borders[*position].kind == ClosureKind::Claimed;
        let claims: Vec<usize> = (0..self.borders.len()).filter(is_claim).collect();
        if claims.is_empty() {
            return Ok(());
        }
        let known = self
            .borders
            .iter()
            .filter(|b| b.kind != ClosureKind::Claimed);
        let known: Vec<_> = known.cloned().collect();
        let slow = Reduced::<f64>::new(with_borders(self.direct.pencil(WaveVector::MEAN), &known))
            .and_then(|pencil| pencil.eigenvectors());
        // A problem that is singular bears nothing out.
        let (zero, mut modes) = slow.map_or((0.0, Vec::new()), |(spectrum, modes)| {
            (TOLERANCE * spectrum.scale(), modes)
        });
        modes.sort_by(|a, b| a.0.norm().total_cmp(&b.0.norm()));
        modes.truncate(SLOW);
        let borne_out = |position: usize| {
            let row = &self.borders[position].row;
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
