//! G_α, what modes of lower order force: the unexpanded residual and boundary conditions run on truncated polynomials.
//!
//! In the balance M(X) ∂t X − R(X) = 0 the coefficient of z^p z̄^s is [σ_α M0 − L_q] X_α − G_α. With X_α left out of the
//! argument it is −G_α. Laws, divisions, roots and masses that depend on the state are computed like any other operation.

use super::integrals::Integrals;
use super::mode::Mode;
use super::response::RightSide;
use super::scramble::Weight;
use crate::error::{Error, Result};
use crate::model::{C64, End, Id, Jet, Kernel, KernelId, ResidualId, evaluate};
use crate::problem::{Problem, Turned};
use crate::series::{Arithmetic, Levels, Monomials, Program};
use crate::space::Points;
use crate::wavevector::WaveVector;

/// The residuals of balances, boundary conditions and closures, with their coefficients through the degree completed.
pub(super) struct Forcing {
    equations: Vec<Equations>,
    /// `None` where the densities of all closures are linear.
    integrals: Option<Integrals>,
}

/// A residual at the points of one family.
pub(super) struct Group {
    points: Points,
    program: Program,
    levels: Levels,
    /// Positions in `jets` of those that the program reads.
    read: Vec<usize>,
    /// All jets of the residual.
    jets: Vec<Jet>,
    weight: Option<Weight>,
}

/// Rows of the collocated problem that share their points.
struct Equations {
    group: Group,
    rows: Vec<Row>,
}

/// Where one output of a residual stands among the rows of the collocated problem.
struct Row {
    offset: usize,
    /// By point: the factor that makes a right-hand side in the solver's basis of it.
    factors: Vec<C64>,
}

impl Forcing {
    /// The residuals around the base state of a problem.
    ///
    /// # Errors
    /// The model has no unexpanded residual.
    pub fn new(prepare: &Preparation) -> Result<Self> {
        let mut equations = Equations::balances(prepare)?;
        equations.extend(Equations::conditions(prepare));
        Ok(Forcing {
            equations,
            integrals: Integrals::new(prepare),
        })
    }

    /// Whether all residuals run in real arithmetic: the mirror then holds at every degree.
    pub fn is_real(&self) -> bool {
        let mut equations = self.equations.iter();
        equations.all(|equations| equations.group.is_real())
            && self.integrals.as_ref().is_none_or(Integrals::is_real)
    }

    /// Begins the next degree. `wanted` are the indices of the stored monomials that will be asked for.
    pub fn begin(&mut self, monomials: &Monomials, degree: usize, wanted: &[usize]) {
        for Equations { group, .. } in &mut self.equations {
            group.begin(monomials, degree, wanted);
        }
        if let Some(integrals) = &mut self.integrals {
            integrals.begin(monomials, degree, wanted);
        }
    }

    /// G_α of every stored monomial of the degree begun, `[index]`. Of `moving[index]` the rate alone is read: what lower
    /// orders contribute to ∂t X beside z^p z̄^s.
    pub fn outputs(
        &mut self,
        problem: &Problem,
        monomials: &Monomials,
        degree: usize,
        moving: &[Option<Mode>],
    ) -> Vec<PhysicalForcing> {
        let mut forcings = vec![PhysicalForcing::new(problem); moving.len()];
        for Equations { group, rows } in &mut self.equations {
            let table = group.table(problem, moving, |jet| jet.t > 0);
            let jets = |jet: usize, index: usize| table[index].get(jet)?.clone();
            let outputs = group.outputs(monomials, degree, &jets);
            for (row, values) in rows.iter().zip(outputs) {
                for (forcing, values) in forcings.iter_mut().zip(values) {
                    for (i, (value, factor)) in values.iter().zip(&row.factors).enumerate() {
                        forcing.values[row.offset + i] = *value;
                        forcing.factors[row.offset + i] = *factor;
                    }
                }
            }
        }
        if let Some(integrals) = &mut self.integrals {
            let integrals = integrals.outputs(monomials, degree);
            for (forcing, integrals) in forcings.iter_mut().zip(integrals) {
                forcing.integrals = integrals;
            }
        }
        forcings
    }

    /// Completes the degree begun with its modes.
    pub fn complete(
        &mut self,
        problem: &Problem,
        monomials: &Monomials,
        degree: usize,
        modes: &[Option<Mode>],
    ) {
        for Equations { group, .. } in &mut self.equations {
            group.complete(problem, monomials, degree, modes);
        }
        if let Some(integrals) = &mut self.integrals {
            integrals.complete(problem, monomials, degree, modes);
        }
    }
}

impl Equations {
    /// The balances, by the points at which they are collocated.
    fn balances(prepare: &Preparation) -> Result<Vec<Self>> {
        let problem = prepare.problem;
        let model = problem.model();
        let missing = || Error::computation("the model has no unexpanded residual");
        let residual = model.residual(ResidualId::Balances).ok_or_else(missing)?;
        let layout = &problem.direct.layout;
        let mut equations: Vec<Equations> = Vec::new();
        for (points, balances) in layout.groups() {
            // L and M0 are those of the balances over a divisor, by which the residual is divided likewise.
            let states = prepare.states(points);
            let divisors = states
                .iter()
                .map(|state| evaluate(model, KernelId::Divisors, state));
            let divisors: Vec<Vec<f64>> = divisors.collect();
            let rows = balances.iter().map(|&balance| Row {
                offset: layout.rows[balance].offset,
                factors: divisors
                    .iter()
                    .map(|d| problem.direct.row_factor(balance) / -d[balance.index()])
                    .collect(),
            });
            let outputs: Vec<usize> = balances.iter().map(|balance| balance.index()).collect();
            equations.push(Equations {
                rows: rows.collect(),
                group: prepare.group(residual, &outputs, points),
            });
        }
        Ok(equations)
    }

    /// The boundary conditions, by end.
    fn conditions(prepare: &Preparation) -> Vec<Self> {
        let problem = prepare.problem;
        let case = ResidualId::Conditions(problem.base.case);
        let mut equations: Vec<Equations> = Vec::new();
        for end in End::BOTH {
            let walls = problem.direct.walls.iter().enumerate();
            let walls: Vec<usize> = walls
                .filter(|(_, wall)| wall.end == end)
                .map(|(index, _)| index)
                .collect();
            let conditions = problem.model().residual(case);
            let Some(conditions) = conditions.filter(|_| !walls.is_empty()) else {
                continue;
            };
            // A condition is 0 = W X + N(X), W being a row of L: −L X = N(X).
            let rows = walls.iter().map(|&index| Row {
                offset: problem.direct.layout.walls + index,
                factors: vec![problem.direct.wall_factor(&problem.direct.walls[index])],
            });
            equations.push(Equations {
                rows: rows.collect(),
                group: prepare.group(conditions, &walls, Points::end(end)),
            });
        }
        equations
    }
}

/// The residuals' coefficients of one monomial in physical values, of which either G_α or that of the conjugate
/// monomial can be made.
#[derive(Clone)]
pub(super) struct PhysicalForcing {
    /// Coefficients in balances and boundary conditions, by row.
    values: Vec<C64>,
    /// By row: the factor that makes a right-hand side in the solver's basis of a value.
    factors: Vec<C64>,
    /// ∫ F dy of each closure; empty where all densities are linear.
    integrals: Vec<C64>,
    /// By closure: the factor that makes a right-hand side in the solver's basis of an integral.
    closure_factors: Vec<C64>,
}

impl PhysicalForcing {
    fn new(problem: &Problem) -> Self {
        let zero = vec![C64::new(0.0, 0.0); problem.direct.layout.size];
        PhysicalForcing {
            values: zero.clone(),
            factors: zero,
            integrals: Vec::new(),
            closure_factors: problem.borders.iter().map(|b| -b.factor()).collect(),
        }
    }

    /// G_α in the solver's basis.
    pub fn right(&self) -> RightSide {
        self.right_of(|value| value)
    }

    /// G of the conjugate monomial in the solver's basis.
    pub fn conjugate_right(&self) -> RightSide {
        self.right_of(|value| value.conj())
    }

    fn right_of(&self, value: impl Fn(C64) -> C64) -> RightSide {
        let product = |(v, f): (&C64, &C64)| value(*v) * f;
        let equations = self.values.iter().zip(&self.factors).map(product);
        let closures = self
            .integrals
            .iter()
            .zip(&self.closure_factors)
            .map(product);
        RightSide {
            equations: Turned(equations.collect()),
            closures: closures.collect(),
        }
    }
}

/// What residuals are prepared from.
pub(super) struct Preparation<'a> {
    pub problem: &'a Problem,
    /// The wavenumber that the spec's block `amplitude` may name.
    k: WaveVector,
    /// Whether each jet is i times real, where that or real is all they are.
    odd: Option<Vec<bool>>,
    weight: Option<Weight>,
}

impl<'a> Preparation<'a> {
    /// Residuals around the base state of `problem`. In real arithmetic every mode has to be its mirror image. With
    /// weights every jet is multiplied by its weight.
    pub fn new(
        problem: &'a Problem,
        k: WaveVector,
        arithmetic: Arithmetic,
        weight: Option<Weight>,
    ) -> Self {
        Preparation {
            problem,
            k,
            odd: odd_jets(problem, &problem.structure().residual_jets, arithmetic),
            weight,
        }
    }

    fn states(&self, points: Points) -> Vec<Vec<f64>> {
        let places = self.problem.space().places(points).into_iter();
        places
            .map(|place| self.problem.base.at(place, self.k))
            .collect()
    }

    /// Some outputs of a residual at the points of a family.
    pub fn group(&self, kernel: &Kernel, outputs: &[usize], points: Points) -> Group {
        let structure = self.problem.structure();
        let states = self.states(points);
        let jets = |state: &Vec<f64>| -> Vec<f64> {
            let jets = structure.residual_jets.iter();
            jets.map(|jet| structure.base_jet(*jet, state)).collect()
        };
        let base: Vec<Vec<f64>> = states.iter().map(jets).collect();
        let program = Program::new(kernel, outputs, &states[0], self.odd.as_deref());
        Group {
            points,
            levels: Levels::new(&program, &states, &base),
            read: program.jets(),
            program,
            jets: structure.residual_jets.clone(),
            weight: self.weight,
        }
    }
}

/// Whether each jet is i times real, where every mode is its mirror image; `None` in complex arithmetic.
fn odd_jets(problem: &Problem, jets: &[Jet], arithmetic: Arithmetic) -> Option<Vec<bool>> {
    let parity = problem.structure().parity.as_ref()?;
    let odd = |jet: &Jet| parity.fields[jet.of] != (jet.x % 2 == 1);
    (arithmetic == Arithmetic::Real).then(|| jets.iter().map(odd).collect())
}

impl Group {
    /// Whether it runs in real arithmetic.
    pub fn is_real(&self) -> bool {
        self.program.arithmetic() == Arithmetic::Real
    }

    /// Begins the next degree, for the stored monomials `wanted`.
    pub fn begin(&mut self, monomials: &Monomials, degree: usize, wanted: &[usize]) {
        self.levels.begin(&self.program, monomials, degree, wanted);
    }

    /// The outputs of the degree begun, `[output][monomial][point]`, with `jets(jet, monomial)` as the coefficients of the
    /// jets, `[point]`; `None` is zero.
    pub fn outputs(
        &mut self,
        monomials: &Monomials,
        degree: usize,
        jets: &dyn Fn(usize, usize) -> Option<Vec<C64>>,
    ) -> Vec<Vec<Vec<C64>>> {
        self.levels.outputs(&self.program, monomials, degree, jets)
    }

    /// Completes the degree begun with its modes, `[monomial]`.
    pub fn complete(
        &mut self,
        problem: &Problem,
        monomials: &Monomials,
        degree: usize,
        modes: &[Option<Mode>],
    ) {
        let table = self.table(problem, modes, |_| true);
        let jets = |jet: usize, index: usize| table[index].get(jet)?.clone();
        self.levels
            .complete(&self.program, monomials, degree, &jets);
    }

    /// The chosen jets of each mode at the points, `[mode][jet][point]`; `None` for a jet that is zero or not chosen.
    fn table(
        &self,
        problem: &Problem,
        modes: &[Option<Mode>],
        chosen: impl Fn(Jet) -> bool,
    ) -> Vec<Vec<Option<Vec<C64>>>> {
        let read: Vec<usize> = self
            .read
            .iter()
            .copied()
            .filter(|&i| chosen(self.jets[i]))
            .collect();
        let wanted: Vec<Jet> = read.iter().map(|&index| self.jets[index]).collect();
        let row = |mode: &Option<Mode>| {
            let Some(mode) = mode else { return Vec::new() };
            let mut row = vec![None; self.jets.len()];
            let columns = mode.columns(problem, &wanted, self.points);
            for (&index, mut column) in read.iter().zip(columns) {
                if let Some(weight) = self.weight {
                    let factor = weight(self.jets[index]);
                    column.iter_mut().for_each(|value| *value *= factor);
                }
                row[index] = Some(column);
            }
            row
        };
        modes.iter().map(row).collect()
    }
}
