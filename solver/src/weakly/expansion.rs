//! The amplitude expansion for any modes, to any order.
//!
//! X' = Σ_j z_j φ_j e^{i q_j x} + c.c. + Σ_{|α| ≥ 2} X_α z^p z̄^s e^{i q_α x},  α = (p, s),  q_α = Σ_j (p_j − s_j) q_j
//! dz_j/dt = c_j z_j + Σ_{α ∈ R_j} g_jα z^p z̄^s
//!
//! [σ_α M0 − L_{q_α}] X_α = G_α − Σ_{j: α ∈ R_j} g_jα M0 φ_j,  σ_α = Σ_j (p_j c_j + s_j c̄_j),  ⟨ψ_j, M0 X_α⟩ = 0
//!
//! R_j, the resonant monomials of mode j, have its wavenumber and, where something oscillates, about its frequency. One
//! mode to third order is P (3.13)–(3.22).
//!
//! Of α and its conjugate (s, p) one is stored, since X_(s,p) is the conjugate of X_(p,s).

use super::cubic::fundamental;
use super::distance::Distance;
use super::forcing::{Forcing, Preparation};
use super::mode::Mode;
use super::response::{ForcedProblem, Multiplier, Response, RightSide, arithmetic};
use super::scramble::turned;
use super::system::{AmplitudeSystem, Term};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::numerics::Applied;
use crate::numerics::dense::dot;
use crate::problem::{Problem, Profile, Turned};
use crate::series::{Arithmetic, Monomial, Monomials};
use crate::spectrum::EigenPair;
use crate::wavevector::WaveVector;
use std::sync::Arc;

/// A frequency below this part of the size of its eigenvalue, or of the scale of the spectrum, is zero. It lies above the
/// rounding of an eigenvalue and far below a frequency that moves anything.
const STILL: f64 = 1e-9;

/// A mode with an amplitude z_j.
#[derive(Clone)]
pub struct CriticalMode {
    /// q_j and c_j with both vectors.
    pub pair: EigenPair,
    /// φ_j, normalised as the spec says.
    pub profile: Mode,
    /// M0 φ_j, in the solver's basis.
    column: Turned,
    /// M0ᴴ ψ_j, in the solver's basis.
    row: Turned,
}

/// The expansion through some order, which [`Expansion::advance`] raises by one.
pub struct Expansion {
    /// The collocated problem around the base state.
    pub problem: Arc<Problem>,
    /// The modes with amplitudes.
    pub modes: Vec<CriticalMode>,
    /// Their amplitude equations through the order reached.
    pub system: AmplitudeSystem,
    /// Multipliers of the closures in all problems at q = 0.
    pub multipliers: Vec<Multiplier>,
    arithmetic: Arithmetic,
    monomials: Monomials,
    /// X_α of the stored monomials, `[degree − 1][index]`.
    profiles: Vec<Vec<Mode>>,
    forcing: Forcing,
    /// The solved problem of each X_α from degree 2 on.
    responses: Vec<(Monomial, Response)>,
}

impl Expansion {
    /// The expansion at order 1: the modes alone.
    ///
    /// # Errors
    /// A mode cannot be normalised, or two modes are the same.
    pub fn new(problem: &Arc<Problem>, pairs: Vec<EigenPair>) -> Result<Self> {
        let rates: Vec<C64> = pairs.iter().map(|pair| pair.c).collect();
        distinct(&pairs)?;
        let mut arithmetic = arithmetic(problem, &rates);
        let mut modes = Vec::new();
        for pair in pairs {
            let profile = fundamental(problem, &pair)?;
            let mass = problem.direct.mass::<C64>(pair.k);
            modes.push(CriticalMode {
                column: Turned(mass.apply(&problem.direct.turned(&profile.values))),
                row: Turned(mass.apply_adjoint(&pair.left)),
                profile,
                pair,
            });
        }
        let k = modes.first().map_or(WaveVector::MEAN, |mode| mode.pair.k);
        let mut forcing = Forcing::new(&Preparation::new(problem, k, arithmetic, None))?;
        if arithmetic == Arithmetic::Real && !forcing.is_real() {
            // The mirror is known of the balances to third degree. Terms of higher degree may break it.
            arithmetic = Arithmetic::Complex;
            forcing = Forcing::new(&Preparation::new(problem, k, arithmetic, None))?;
        }
        let mut expansion = Expansion {
            problem: problem.clone(),
            system: AmplitudeSystem::linear(&rates),
            multipliers: Vec::new(),
            arithmetic,
            monomials: Monomials::new(modes.len()),
            profiles: vec![modes.iter().map(|mode| mode.profile.clone()).collect()],
            forcing,
            responses: Vec::new(),
            modes,
        };
        expansion.monomials.extend();
        let wanted: Vec<usize> = (0..expansion.modes.len()).collect();
        expansion.forcing.begin(&expansion.monomials, 1, &wanted);
        expansion.complete(1);
        Ok(expansion)
    }

    /// The expansion through an order.
    ///
    /// # Errors
    /// As [`Expansion::new`] and [`Expansion::advance`].
    pub fn to(problem: &Arc<Problem>, pairs: Vec<EigenPair>, order: usize) -> Result<Self> {
        let mut expansion = Expansion::new(problem, pairs)?;
        while expansion.order() < order {
            expansion.advance()?;
        }
        Ok(expansion)
    }

    /// The order reached.
    pub fn order(&self) -> usize {
        self.profiles.len()
    }

    /// Every X_α through the order reached, from degree 1 on, with its monomial; conjugates included.
    pub fn coefficients(&self) -> Vec<(Monomial, Mode)> {
        let mut all = Vec::new();
        for (degree, profiles) in (1..).zip(&self.profiles) {
            for (monomial, mode) in self.monomials.of(degree).iter().zip(profiles) {
                all.push((monomial.clone(), mode.clone()));
                if !monomial.is_real() {
                    all.push((monomial.conjugate(), mode.conjugate()));
                }
            }
        }
        all
    }

    /// X_α of one monomial; `None` beyond the order reached.
    pub fn profile(&self, monomial: &Monomial) -> Option<Mode> {
        let place = self.monomials.place(monomial)?;
        let mode = self
            .profiles
            .get(place.degree.checked_sub(1)?)?
            .get(place.index)?;
        Some(if place.conjugate {
            mode.conjugate()
        } else {
            mode.clone()
        })
    }

    /// q_α = Σ_j (p_j − s_j) q_j. Where that is ±q_j or zero but for rounding, it is exactly so.
    pub fn wavevector(&self, alpha: &Monomial) -> WaveVector {
        let modes = || self.modes.iter().map(|mode| mode.pair.k);
        let q: WaveVector = alpha.differences().zip(modes()).map(|(d, q)| d * q).sum();
        let longest = modes().map(WaveVector::length).fold(0.0, f64::max);
        let mut exact = modes().chain(modes().map(|q| -q)).chain([WaveVector::MEAN]);
        let exact = exact.find(|candidate| q.is_same(*candidate, longest));
        exact.unwrap_or(q)
    }

    /// σ_α = Σ_j (p_j c_j + s_j c̄_j)
    pub fn shift(&self, alpha: &Monomial) -> C64 {
        let exponents = alpha.z.iter().zip(&alpha.conj);
        let terms = exponents.zip(&self.modes).map(|((&p, &s), mode)| {
            let c = mode.pair.c;
            c * f64::from(p) + c.conj() * f64::from(s)
        });
        terms.sum()
    }

    /// The modes j with α ∈ R_j: q_α = q_j, and |Im σ_α − Im c_j| at most half the smallest frequency of the modes.
    fn resonant(&self, alpha: &Monomial) -> Vec<usize> {
        let (q, shift) = (self.wavevector(alpha), self.shift(alpha));
        let frequency = |mode: &CriticalMode| {
            let size = mode.pair.c.norm().max(mode.pair.scale);
            let omega = mode.pair.c.im.abs();
            (omega > STILL * size).then_some(omega)
        };
        let least = self.modes.iter().filter_map(frequency);
        let reach = 0.5 * least.fold(f64::INFINITY, f64::min);
        let meets =
            |mode: &CriticalMode| q == mode.pair.k && (shift.im - mode.pair.c.im).abs() <= reach;
        let modes = self.modes.iter().enumerate();
        modes.filter(|(_, m)| meets(m)).map(|(j, _)| j).collect()
    }

    /// Raises the order by one: solves for every X_α of the next degree and for the coefficients g_jα.
    ///
    /// # Errors
    /// A problem is singular: X_α resonates with a mode that has no amplitude.
    pub fn advance(&mut self) -> Result<()> {
        let (degree, posed) = self.begin();
        let all: Vec<usize> = (0..posed.len()).collect();
        let mut profiles = Vec::with_capacity(posed.len());
        for (posed, right) in self.forcings(degree, &posed, &all) {
            let mode = self.solve(&posed, right)?;
            profiles.push(if posed.mirrored {
                mode.conjugate()
            } else {
                mode
            });
        }
        self.profiles.push(profiles);
        self.complete(degree);
        Ok(())
    }

    /// The amplitude equations through the next order, whose X_α are not solved for. This ends the expansion.
    pub fn last_coefficients(mut self) -> AmplitudeSystem {
        let (degree, posed) = self.begin();
        let resonant: Vec<usize> = (0..posed.len())
            .filter(|&index| !posed[index].resonant.is_empty())
            .collect();
        for (posed, right) in self.forcings(degree, &posed, &resonant) {
            for j in posed.resonant {
                // g_jα = ⟨ψ_j, G_α⟩ / ⟨ψ_j, M0 φ_j⟩
                let mode = &self.modes[j];
                let left = &mode.pair.left;
                let g = dot(left, &right.equations) / dot(left, &mode.column);
                let monomial = posed.alpha.clone();
                self.system.equations[j].push(Term { monomial, g });
            }
        }
        self.system
    }

    /// Opens the next degree: the problems of its stored monomials.
    fn begin(&mut self) -> (usize, Vec<Posed>) {
        self.monomials.extend();
        let degree = self.monomials.degree();
        let posed = self.monomials.of(degree).iter();
        (degree, posed.map(|stored| self.pose(stored)).collect())
    }

    /// The problem of a stored monomial or that of its conjugate: the one that is resonant, or else the one of positive
    /// wavenumber.
    fn pose(&self, stored: &Monomial) -> Posed {
        let conjugate = stored.conjugate();
        let [of_stored, of_conjugate] = [stored, &conjugate].map(|alpha| self.resonant(alpha));
        let mirrored = if !of_stored.is_empty() {
            false
        } else if !of_conjugate.is_empty() {
            true
        } else {
            self.wavevector(stored).is_reversed()
        };
        let (alpha, resonant) = if mirrored {
            (conjugate, of_conjugate)
        } else {
            (stored.clone(), of_stored)
        };
        Posed {
            alpha,
            resonant,
            mirrored,
        }
    }

    /// G_α of the wanted problems of a degree, in the solver's basis.
    fn forcings(
        &mut self,
        degree: usize,
        posed: &[Posed],
        wanted: &[usize],
    ) -> Vec<(Posed, RightSide)> {
        self.forcing.begin(&self.monomials, degree, wanted);
        // A mode whose values, X_α, are still unknown, and whose rate holds what lower orders contribute.
        let moving = |(index, posed): (usize, &Posed)| {
            let rate = self.rate_of_lower_orders(&posed.alpha)?;
            let still = Profile::zero(rate.len());
            let mode = Mode::new(self.wavevector(&posed.alpha), still, rate);
            let mode = if posed.mirrored {
                mode.conjugate()
            } else {
                mode
            };
            wanted.contains(&index).then_some(mode)
        };
        let moving: Vec<Option<Mode>> = posed.iter().enumerate().map(moving).collect();
        let forcings = self
            .forcing
            .outputs(&self.problem, &self.monomials, degree, &moving);
        let right = |&index: &usize| {
            let right = if posed[index].mirrored {
                forcings[index].conjugate_right()
            } else {
                forcings[index].right()
            };
            (posed[index].clone(), right)
        };
        wanted.iter().map(right).collect()
    }

    /// Solves one problem for X_α and its g_jα, which enter the amplitude equations.
    fn solve(&mut self, posed: &Posed, forcing: RightSide) -> Result<Mode> {
        forcing.check_range()?;
        let alpha = &posed.alpha;
        let borders = posed.resonant.iter().map(|&j| {
            let mode = &self.modes[j];
            (mode.column.clone(), mode.row.clone())
        });
        let borders: Vec<_> = borders.collect();
        // [σ_α M0 − L_{q_α}] X_α + Σ_j g_jα M0 φ_j = G_α,  ⟨ψ_j, M0 X_α⟩ = 0
        let forced = ForcedProblem {
            q: self.wavevector(alpha),
            sigma: self.shift(alpha),
            forcing,
            arithmetic: self.arithmetic,
            order: alpha.degree(),
            is_real: alpha.is_real(),
            borders: &borders,
            uncancelled: &|| self.uncancelled(alpha),
        };
        let response = forced
            .solve(&self.problem)
            .ok_or_else(|| self.singular(alpha))?;
        // What stands beside z^p z̄^s in ∂t X: σ_α X_α + Σ_j g_jα φ_j, and what lower orders contribute.
        let mut mode = response.mode.clone();
        if let Some(rate) = self.rate_of_lower_orders(alpha) {
            mode.rate.add(C64::new(1.0, 0.0), &rate);
        }
        for (&j, &g) in posed.resonant.iter().zip(&response.coefficients) {
            mode.rate.add(g, &self.modes[j].profile.values);
            let monomial = alpha.clone();
            self.system.equations[j].push(Term { monomial, g });
        }
        self.multipliers
            .extend(response.multipliers.iter().cloned());
        self.responses.push((alpha.clone(), response));
        Ok(mode)
    }

    /// G_α with a weight on every jet, so that its terms do not cancel, in the solver's basis. The contribution of lower
    /// orders to the rates is left out.
    fn uncancelled(&self, alpha: &Monomial) -> Option<Turned> {
        let k = self
            .modes
            .first()
            .map_or(WaveVector::MEAN, |mode| mode.pair.k);
        let prepare = Preparation::new(&self.problem, k, Arithmetic::Complex, Some(turned));
        let mut forcing = Forcing::new(&prepare).ok()?;
        let mut monomials = Monomials::new(self.modes.len());
        for (degree, profiles) in (1..).zip(&self.profiles) {
            monomials.extend();
            let all: Vec<usize> = (0..profiles.len()).collect();
            forcing.begin(&monomials, degree, &all);
            let modes: Vec<Option<Mode>> = profiles.iter().cloned().map(Some).collect();
            forcing.complete(&self.problem, &monomials, degree, &modes);
        }
        monomials.extend();
        let index = monomials.place(alpha)?.index;
        let degree = alpha.degree();
        forcing.begin(&monomials, degree, &[index]);
        let still = vec![None; monomials.of(degree).len()];
        let forcings = forcing.outputs(&self.problem, &monomials, degree, &still);
        Some(forcings.get(index)?.right().equations)
    }

    /// The part of ∂t X beside z^p z̄^s that lower orders contribute: Σ_γ X_γ times the coefficient of α in dγ/dt, over
    /// monomials γ of degree 2 and more. `None` where it is zero.
    fn rate_of_lower_orders(&self, alpha: &Monomial) -> Option<Profile> {
        let mut rate: Option<Profile> = None;
        for degree in 2..alpha.degree() {
            let monomials = self.monomials.of(degree).iter();
            for (stored, mode) in monomials.zip(&self.profiles[degree - 1]) {
                for gamma in [stored.clone(), stored.conjugate()] {
                    let factor = self.rate_factor(alpha, &gamma);
                    if factor != C64::new(0.0, 0.0) {
                        let rate = rate.get_or_insert_with(|| Profile::zero(mode.values.len()));
                        if gamma == *stored {
                            rate.add(factor, &mode.values);
                        } else {
                            rate.add(factor, &mode.values.conjugate());
                        }
                    }
                    if stored.is_real() {
                        break;
                    }
                }
            }
        }
        rate
    }

    /// The coefficient of α in the part of dγ/dt that is nonlinear in the amplitudes. With γ = z^p z̄^s,
    ///
    /// dγ/dt = Σ_j p_j (γ/z_j) dz_j/dt + Σ_j s_j (γ/z̄_j) dz̄_j/dt.
    fn rate_factor(&self, alpha: &Monomial, gamma: &Monomial) -> C64 {
        let n = self.modes.len();
        let mut factor = C64::new(0.0, 0.0);
        for j in 0..n {
            let z = Monomial::amplitude(n, j);
            let coefficient = |beta: Option<Monomial>| {
                let beta = beta.filter(|beta| beta.degree() > 1)?;
                self.system.coefficient(j, &beta)
            };
            // The β of dz_j/dt with (γ/z_j) β = α.
            let beta = |z: &Monomial| gamma.over(z).and_then(|quotient| alpha.over(&quotient));
            if let Some(g) = coefficient(beta(&z)) {
                factor += g * f64::from(gamma.z[j]);
            }
            // dz̄_j/dt holds the conjugates of the terms of dz_j/dt.
            let conjugate = beta(&z.conjugate()).map(|beta| beta.conjugate());
            if let Some(g) = coefficient(conjugate) {
                factor += g.conj() * f64::from(gamma.conj[j]);
            }
        }
        factor
    }

    /// Hands the X_α of a degree to the residuals, whose coefficients of that degree are then complete.
    fn complete(&mut self, degree: usize) {
        let modes = self.profiles[degree - 1].iter().cloned().map(Some);
        let modes: Vec<Option<Mode>> = modes.collect();
        self.forcing
            .complete(&self.problem, &self.monomials, degree, &modes);
    }

    /// The distance of every solved problem from singularity.
    pub fn distances(&self) -> Vec<Distance> {
        let distance = |(monomial, response): &(Monomial, Response)| Distance {
            monomial: monomial.clone(),
            q: self.wavevector(monomial),
            shift: self.shift(monomial),
            distance: response.distance(&self.problem),
        };
        self.responses.iter().map(distance).collect()
    }

    fn singular(&self, alpha: &Monomial) -> Error {
        let (q, of) = (
            self.wavevector(alpha),
            format!("the coefficient of {}", alpha.name()),
        );
        let distance = None;
        if q.is_mean() {
            return Error::OpenMean { of, distance };
        }
        Error::Resonance {
            of,
            q: q.k(),
            modes: self.modes.iter().map(|mode| mode.pair.k.k()).collect(),
            distance,
        }
    }
}

/// The problem of one X_α.
#[derive(Clone)]
struct Posed {
    alpha: Monomial,
    /// The modes j with α ∈ R_j.
    resonant: Vec<usize>,
    /// Whether α is the conjugate of the stored monomial.
    mirrored: bool,
}

/// Refuses two modes that are the same: equal in wavenumber and eigenvalue to 10⁻⁶, or one the conjugate of the other, at
/// −q with the conjugate eigenvalue. The tolerance is relative to the eigenvalue or to the scale of its spectrum, and far
/// above the error that inverse iteration leaves.
fn distinct(pairs: &[EigenPair]) -> Result<()> {
    for (i, a) in pairs.iter().enumerate() {
        for b in &pairs[..i] {
            let near = |x: C64, y: C64| (x - y).norm() <= 1e-6 * a.scale.max(a.c.norm());
            let same = |q: WaveVector| a.k.is_same(q, a.k.length());
            if (same(b.k) && near(a.c, b.c)) || (same(-b.k) && near(a.c, b.c.conj())) {
                return Err(Error::input(format!(
                    "the modes at k = {} and k = {} are one and the same: its amplitude and the conjugate of that \
                     stand in one equation",
                    b.k, a.k
                )));
            }
        }
    }
    Ok(())
}
