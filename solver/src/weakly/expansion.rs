//! The amplitude expansion for any modes, to any order.
//!
//! X' = Σ_j z_j φ_j e^{i q_j x} + c.c. + Σ_α X_α z^p z̄^s e^{i q_α x},  α = (p, s),  q_α = Σ_j (p_j − s_j) q_j,
//! dz_j/dt = c_j z_j + Σ_{α ∈ R_j} g_jα z^p z̄^s,
//! [σ_α M0 − L_{q_α}] X_α = G_α − Σ_{j: α ∈ R_j} g_jα M0 φ_j,  σ_α = Σ_j (p_j c_j + s_j c̄_j),  ⟨ψ_j, M0 X_α⟩ = 0.
//!
//! One mode to third order is P (3.13)–(3.22). Resonant, in R_j, are the monomials with the wavenumber of mode j
//! and, where something oscillates, its frequency.

use super::cubic::fundamental;
use super::forcing::{Forcing, Preparation};
use super::mode::Mode;
use super::response::{Multiplier, Question, Response, RightSide, arithmetic};
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

/// Wavenumbers that differ by a smaller part of the largest are one.
const SAME: f64 = 1e-9;

/// A mode with an amplitude of its own.
#[derive(Clone)]
pub struct CriticalMode {
    /// Eigenvalue and vectors.
    pub pair: EigenPair,
    /// φ, normalised.
    pub profile: Mode,
    /// M0 φ, in the solver's basis.
    column: Turned,
    /// M0ᴴ ψ
    row: Turned,
}

/// The modes and coefficients found so far.
pub struct Expansion {
    /// The collocated problem.
    pub problem: Arc<Problem>,
    /// The modes with amplitudes.
    pub modes: Vec<CriticalMode>,
    /// Their equations, as far as they are known.
    pub system: AmplitudeSystem,
    /// Multipliers of the closures at q = 0.
    pub multipliers: Vec<Multiplier>,
    arithmetic: Arithmetic,
    monomials: Monomials,
    /// X_α by degree, from 1 on, of the stored monomials.
    profiles: Vec<Vec<Mode>>,
    forcing: Forcing,
    responses: Vec<(Monomial, Response)>,
}

impl Expansion {
    /// The modes alone: order 1.
    ///
    /// # Errors
    /// A mode that the spec's normalisation does not fit, two modes that are one.
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

    /// All modes and coefficients to an order.
    ///
    /// # Errors
    /// As [`Expansion::new`], and a singular problem: resonance.
    pub fn to(problem: &Arc<Problem>, pairs: Vec<EigenPair>, order: usize) -> Result<Self> {
        let mut expansion = Expansion::new(problem, pairs)?;
        while expansion.order() < order {
            expansion.advance()?;
        }
        Ok(expansion)
    }

    /// The order of the modes found.
    pub fn order(&self) -> usize {
        self.profiles.len()
    }

    /// All monomials, conjugates too, whose modes are known, with these, from degree 1 on.
    pub fn known(&self) -> Vec<(Monomial, Mode)> {
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

    /// The mode of z^p z̄^s.
    pub fn profile(&self, monomial: &Monomial) -> Option<Mode> {
        let place = self.monomials.place(monomial)?;
        let mode = self
            .profiles
            .get(place.degree.checked_sub(1)?)?
            .get(place.index)?;
        Some(match place.conjugate {
            true => mode.conjugate(),
            false => mode.clone(),
        })
    }

    /// q_α, with the wavenumbers of modes to the last digit.
    pub fn wavevector(&self, alpha: &Monomial) -> WaveVector {
        let modes = || self.modes.iter().map(|mode| mode.pair.k);
        let q: WaveVector = alpha.differences().zip(modes()).map(|(d, q)| d * q).sum();
        let longest = modes().map(WaveVector::length).fold(0.0, f64::max);
        let mut exact = modes().chain(modes().map(|q| -q)).chain([WaveVector::MEAN]);
        let exact = exact.find(|candidate| q.is_same(*candidate, longest));
        exact.unwrap_or(q)
    }

    /// σ_α
    pub fn shift(&self, alpha: &Monomial) -> C64 {
        let exponents = alpha.z.iter().zip(&alpha.conj);
        let terms = exponents.zip(&self.modes).map(|((&p, &s), mode)| {
            let c = mode.pair.c;
            c * f64::from(p) + c.conj() * f64::from(s)
        });
        terms.sum()
    }

    /// The modes whose amplitude equations a monomial enters.
    fn resonant(&self, alpha: &Monomial) -> Vec<usize> {
        let (q, shift) = (self.wavevector(alpha), self.shift(alpha));
        let frequency = |mode: &CriticalMode| {
            let size = mode.pair.c.norm().max(mode.pair.scale);
            let own = mode.pair.c.im;
            (own.abs() > SAME * size).then_some(own.abs())
        };
        let least = self.modes.iter().filter_map(frequency);
        let reach = 0.5 * least.fold(f64::INFINITY, f64::min);
        let meets =
            |mode: &CriticalMode| q == mode.pair.k && (shift.im - mode.pair.c.im).abs() <= reach;
        let modes = self.modes.iter().enumerate();
        modes.filter(|(_, m)| meets(m)).map(|(j, _)| j).collect()
    }

    /// The next order: every X_α, and the coefficients of the amplitude equations.
    ///
    /// # Errors
    /// A singular problem: resonance.
    pub fn advance(&mut self) -> Result<()> {
        let (degree, posed) = self.begin();
        let all: Vec<usize> = (0..posed.len()).collect();
        let mut profiles = Vec::with_capacity(posed.len());
        for (posed, right) in self.forcings(degree, &posed, &all) {
            let mode = self.solve(&posed, right)?;
            profiles.push(match posed.mirrored {
                true => mode.conjugate(),
                false => mode,
            });
        }
        self.profiles.push(profiles);
        self.complete(degree);
        Ok(())
    }

    /// The coefficients of the next order without its modes, by projection: ⟨ψ_j, G_α⟩ / ⟨ψ_j, M0 φ_j⟩.
    /// The expansion ends here.
    pub fn last_coefficients(mut self) -> AmplitudeSystem {
        let (degree, posed) = self.begin();
        let resonant: Vec<usize> = (0..posed.len())
            .filter(|&index| !posed[index].resonant.is_empty())
            .collect();
        for (posed, right) in self.forcings(degree, &posed, &resonant) {
            for j in posed.resonant {
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

    /// The problem of a monomial, or that of its conjugate: the one that amplitude equations need, or the one of
    /// positive wavenumber.
    fn pose(&self, stored: &Monomial) -> Posed {
        let (own, other) = (stored.clone(), stored.conjugate());
        let (resonant, conjugate) = (self.resonant(&own), self.resonant(&other));
        let mirrored = match (resonant.is_empty(), conjugate.is_empty()) {
            (false, _) => false,
            (true, false) => true,
            (true, true) => self.wavevector(&own).is_reversed(),
        };
        Posed {
            alpha: if mirrored { other } else { own },
            resonant: if mirrored { conjugate } else { resonant },
            mirrored,
        }
    }

    /// G of the wanted problems of a degree, in the solver's basis, the known part of the rates included.
    fn forcings(
        &mut self,
        degree: usize,
        posed: &[Posed],
        wanted: &[usize],
    ) -> Vec<(Posed, RightSide)> {
        self.forcing.begin(&self.monomials, degree, wanted);
        let known = |(index, posed): (usize, &Posed)| {
            let rate = self.known_rate(&posed.alpha)?;
            let still = Profile::zero(rate.len());
            let mode = Mode::new(self.wavevector(&posed.alpha), still, rate);
            let mode = if posed.mirrored {
                mode.conjugate()
            } else {
                mode
            };
            wanted.contains(&index).then_some(mode)
        };
        let known: Vec<Option<Mode>> = posed.iter().enumerate().map(known).collect();
        let found = self
            .forcing
            .outputs(&self.problem, &self.monomials, degree, &known);
        let right = |&index: &usize| {
            let right = match posed[index].mirrored {
                true => found[index].conjugate_right(),
                false => found[index].right(),
            };
            (posed[index].clone(), right)
        };
        wanted.iter().map(right).collect()
    }

    fn solve(&mut self, posed: &Posed, forcing: RightSide) -> Result<Mode> {
        forcing.check_range()?;
        let alpha = &posed.alpha;
        let borders = posed.resonant.iter().map(|&j| {
            let mode = &self.modes[j];
            (mode.column.clone(), mode.row.clone())
        });
        let borders: Vec<_> = borders.collect();
        let question = Question {
            q: self.wavevector(alpha),
            shift: self.shift(alpha),
            forcing,
            arithmetic: self.arithmetic,
            order: alpha.degree(),
            is_real: alpha.is_real(),
            borders: &borders,
            uncancelled: &|| self.uncancelled(alpha),
        };
        let response = question
            .answer(&self.problem)
            .ok_or_else(|| self.singular(alpha))?;
        let mut mode = response.mode.clone();
        if let Some(rate) = self.known_rate(alpha) {
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

    /// G of a monomial with weights on all jets that let nothing cancel, in the solver's basis; the known part of the
    /// rates is left out.
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
        let found = forcing.outputs(&self.problem, &monomials, degree, &still);
        Some(found.get(index)?.right().equations)
    }

    /// Σ X_γ d/dt of lower monomials γ that gives z^p z̄^s through the nonlinear terms of the amplitude equations.
    fn known_rate(&self, alpha: &Monomial) -> Option<Profile> {
        let mut rate: Option<Profile> = None;
        for degree in 2..alpha.degree() {
            let found = self
                .monomials
                .of(degree)
                .iter()
                .zip(&self.profiles[degree - 1]);
            for (stored, mode) in found {
                for gamma in [stored.clone(), stored.conjugate()] {
                    let factor = self.rate_factor(alpha, &gamma);
                    if factor != C64::new(0.0, 0.0) {
                        let rate = rate.get_or_insert_with(|| Profile::zero(mode.values.len()));
                        match gamma == *stored {
                            true => rate.add(factor, &mode.values),
                            false => rate.add(factor, &mode.values.conjugate()),
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

    /// The coefficient of α in the part of dγ/dt that is nonlinear in the amplitudes:
    /// Σ_j p_j γ/z_j Σ g_jβ β and its like for z̄_j.
    fn rate_factor(&self, alpha: &Monomial, gamma: &Monomial) -> C64 {
        let n = self.modes.len();
        let mut factor = C64::new(0.0, 0.0);
        for j in 0..n {
            let z = Monomial::amplitude(n, j);
            let coefficient = |beta: Option<Monomial>| {
                let beta = beta.filter(|beta| beta.degree() > 1)?;
                self.system.coefficient(j, &beta)
            };
            let own = gamma.over(&z).and_then(|rest| alpha.over(&rest));
            if let Some(g) = coefficient(own) {
                factor += g * f64::from(gamma.z[j]);
            }
            let other = gamma
                .over(&z.conjugate())
                .and_then(|rest| alpha.over(&rest));
            if let Some(g) = coefficient(other.map(|beta| beta.conjugate())) {
                factor += g.conj() * f64::from(gamma.conj[j]);
            }
        }
        factor
    }

    fn complete(&mut self, degree: usize) {
        let modes = self.profiles[degree - 1].iter().cloned().map(Some);
        let modes: Vec<Option<Mode>> = modes.collect();
        self.forcing
            .complete(&self.problem, &self.monomials, degree, &modes);
    }

    /// Every solved problem's distance from singularity.
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

/// How far one solved problem is from singularity.
#[derive(Clone, Debug)]
pub struct Distance {
    /// The coefficient that it was solved for.
    pub monomial: Monomial,
    /// Its wavenumber.
    pub q: WaveVector,
    /// σ_α
    pub shift: C64,
    /// Of σ_α from the spectrum of L at q.
    pub distance: f64,
}

impl Distance {
    /// What is near, and the command that gives it an amplitude of its own beside those of the modes at `q`.
    pub fn in_words(&self, q: &[f64]) -> String {
        let (name, distance) = (self.monomial.name(), self.distance);
        if self.q.is_mean() {
            return format!(
                "small divisor: the mean that {name} forces is met by a slow mean mode, {distance:.1e} away"
            );
        }
        let mut modes: Vec<String> = q.iter().map(|q| format!("--mode k={q}")).collect();
        modes.push(match q.contains(&self.q.k()) {
            // Not the mode that is there already.
            true => format!(
                "--mode k={},near={:.6}:{:.6}",
                self.q, self.shift.re, self.shift.im
            ),
            false => format!("--mode k={}", self.q),
        });
        format!(
            "small divisor: {name} meets a mode at k = {}, {distance:.1e} away, which wants an amplitude of its own: \
             landau amplitudes with {}",
            self.q,
            modes.join(" ")
        )
    }
}

/// A problem of the expansion.
#[derive(Clone)]
struct Posed {
    alpha: Monomial,
    /// The modes whose amplitude equations it gives a coefficient to.
    resonant: Vec<usize>,
    /// Whether it is that of the conjugate of the stored monomial.
    mirrored: bool,
}

/// Two modes at q and −q whose eigenvalues are conjugate are one, as are two that agree in both.
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
