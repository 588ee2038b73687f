//! What modes of lower order force: the unexpanded residual and boundary conditions run on truncated polynomials.
//!
//! Laws, divisions, roots and state-dependent masses need no case of their own. Of each balance
//! M ∂t X − R the coefficient of z^p z̄^s, with X_ps itself left out, is minus G_ps.

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

/// The residuals prepared, with all coefficients found so far.
pub(super) struct Forcing {
    equations: Vec<Equations>,
    integrals: Option<Integrals>,
}

/// A residual on one family of points.
pub(super) struct Group {
    points: Points,
    program: Program,
    levels: Levels,
    /// Jets that the program reads, by their position among those of the residual.
    read: Vec<usize>,
    jets: Vec<Jet>,
    weight: Option<Weight>,
}

/// Rows of the collocated problem that share their points.
struct Equations {
    group: Group,
    rows: Vec<Row>,
}

/// Where one output goes, and what it is multiplied by at each point.
struct Row {
    offset: usize,
    factors: Vec<C64>,
}

impl Forcing {
    /// The residuals around the base state of a problem.
    ///
    /// # Errors
    /// A model without residual.
    pub fn new(prepare: &Preparation) -> Result<Self> {
        let problem = prepare.problem;
        let model = problem.model();
        let missing = || Error::computation("the model has no unexpanded residual");
        let balances = model.residual(ResidualId::Balances).ok_or_else(missing)?;
        let layout = &problem.direct.layout;
        let mut equations: Vec<Equations> = Vec::new();
        for (points, same) in layout.groups() {
            let states = prepare.states(points);
            let divisors = states
                .iter()
                .map(|state| evaluate(model, KernelId::Divisors, state));
            let divisors: Vec<Vec<f64>> = divisors.collect();
            let rows = same.iter().map(|&row| Row {
                offset: layout.rows[row].offset,
                factors: divisors
                    .iter()
                    .map(|d| problem.direct.row_factor(row) / -d[row.index()])
                    .collect(),
            });
            let outputs: Vec<usize> = same.iter().map(|row| row.index()).collect();
            equations.push(Equations {
                rows: rows.collect(),
                group: prepare.group(balances, &outputs, points),
            });
        }
        let case = ResidualId::Conditions(problem.base.case);
        for end in End::BOTH {
            let walls = problem.direct.walls.iter().enumerate();
            let walls: Vec<usize> = walls
                .filter(|(_, wall)| wall.end == end)
                .map(|(index, _)| index)
                .collect();
            let Some(conditions) = model.residual(case).filter(|_| !walls.is_empty()) else {
                continue;
            };
            // 0 = W x + N(x): a row of L, and its data beside those of the balances.
            let rows = walls.iter().map(|&index| Row {
                offset: layout.walls + index,
                factors: vec![problem.direct.wall_factor(&problem.direct.walls[index])],
            });
            equations.push(Equations {
                rows: rows.collect(),
                group: prepare.group(conditions, &walls, Points::end(end)),
            });
        }
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

    /// Begins a degree, the next: `wanted` are the stored monomials that are asked for.
    pub fn begin(&mut self, monomials: &Monomials, degree: usize, wanted: &[usize]) {
        for Equations { group, .. } in &mut self.equations {
            group.begin(monomials, degree, wanted);
        }
        if let Some(integrals) = &mut self.integrals {
            integrals.begin(monomials, degree, wanted);
        }
    }

    /// G of every stored monomial of a degree, physical but for the basis of rows: `known` are modes that hold the part
    /// of the rates that is known.
    pub fn outputs(
        &mut self,
        problem: &Problem,
        monomials: &Monomials,
        degree: usize,
        known: &[Option<Mode>],
    ) -> Vec<PhysicalForcing> {
        let mut found = vec![PhysicalForcing::new(problem); known.len()];
        for Equations { group, rows } in &mut self.equations {
            let moving = |jet: Jet| jet.t > 0;
            let table = group.table(problem, known, moving);
            let jets = |jet: usize, index: usize| table[index].get(jet)?.clone();
            let outputs = group.outputs(monomials, degree, &jets);
            for (row, values) in rows.iter().zip(outputs) {
                for (forcing, values) in found.iter_mut().zip(values) {
                    for (i, (value, factor)) in values.iter().zip(&row.factors).enumerate() {
                        forcing.values[row.offset + i] = *value;
                        forcing.factors[row.offset + i] = *factor;
                    }
                }
            }
        }
        if let Some(integrals) = &mut self.integrals {
            let integrals = integrals.outputs(monomials, degree);
            for (forcing, integrals) in found.iter_mut().zip(integrals) {
                forcing.integrals = integrals;
            }
        }
        found
    }

    /// Completes a degree with the modes found.
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

/// The residual's coefficient of one monomial, and what makes a right-hand side in the solver's basis of it.
#[derive(Clone)]
pub(super) struct PhysicalForcing {
    values: Vec<C64>,
    factors: Vec<C64>,
    /// ∫ F dy of each closure; none where all densities are linear.
    integrals: Vec<C64>,
    /// What brings them into the solver's basis, with the sign of a right-hand side.
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

    /// The right-hand side in the solver's basis.
    pub fn right(&self) -> RightSide {
        self.right_of(|value| value)
    }

    /// That of the conjugate monomial.
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
    /// The wavenumber that a spec may name.
    k: WaveVector,
    odd: Option<Vec<bool>>,
    weight: Option<Weight>,
}

impl<'a> Preparation<'a> {
    /// For numbers of some arithmetic, every jet times its weight where there are weights.
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

    /// Some outputs of a residual on a family of points.
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

/// Which jets are i times real where every mode is its own mirror image.
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

    pub fn begin(&mut self, monomials: &Monomials, degree: usize, wanted: &[usize]) {
        self.levels.begin(&self.program, monomials, degree, wanted);
    }

    /// The outputs of the degree begun, `[output][monomial][point]`, with the given coefficients of the jets.
    pub fn outputs(
        &mut self,
        monomials: &Monomials,
        degree: usize,
        jets: &dyn Fn(usize, usize) -> Option<Vec<C64>>,
    ) -> Vec<Vec<Vec<C64>>> {
        self.levels.outputs(&self.program, monomials, degree, jets)
    }

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

    /// The chosen jets of each mode at the points, `[mode][jet][point]`; nothing for one that is zero.
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
