//! What modes of lower order force: the unexpanded residual and boundary conditions run on truncated polynomials.
//!
//! Laws, divisions, roots and state-dependent masses need no case of their own. Of each balance
//! M ∂t X − R the coefficient of z^p z̄^s, with X_ps itself left out, is minus G_ps.

use super::mode::Mode;
use crate::error::{Error, Result};
use crate::model::{C64, End, Id, Jet, Kernel, KernelId, ResidualId, evaluate};
use crate::problem::{Problem, Turned};
use crate::series::{Arithmetic, Levels, Monomials, Program};
use crate::space::Points;

/// The residuals prepared, with all coefficients found so far.
pub(super) struct Forcing {
    groups: Vec<Group>,
    jets: Vec<Jet>,
}

/// Rows of the collocated problem that share their points.
struct Group {
    points: Points,
    program: Program,
    levels: Levels,
    rows: Vec<Row>,
    /// Jets that the program reads.
    read: Vec<usize>,
}

/// Where one output goes, and what it is multiplied by at each point.
struct Row {
    offset: usize,
    factors: Vec<C64>,
}

impl Forcing {
    /// The residuals around the base state of a problem; `k` is the wavenumber that a spec may name.
    ///
    /// # Errors
    /// A model without residual.
    pub fn new(problem: &Problem, k: f64, arithmetic: Arithmetic) -> Result<Self> {
        let structure = problem.structure();
        let model = problem.model();
        let jets = structure.residual_jets.clone();
        let missing = || Error::computation("the model has no unexpanded residual");
        let balances = model.residual(ResidualId::Balances).ok_or_else(missing)?;
        let prepare = Preparation {
            problem,
            k,
            odd: odd_jets(problem, &jets, arithmetic),
        };
        let layout = &problem.direct.layout;
        let mut groups: Vec<Group> = Vec::new();
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
            groups.push(prepare.group(balances, &outputs, states, points, rows.collect()));
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
            let points = Points::end(end);
            let states = prepare.states(points);
            groups.push(prepare.group(conditions, &walls, states, points, rows.collect()));
        }
        Ok(Forcing { groups, jets })
    }

    /// Begins a degree, the next: `wanted` are the stored monomials that are asked for.
    pub fn begin(&mut self, monomials: &Monomials, degree: usize, wanted: &[usize]) {
        for group in &mut self.groups {
            group
                .levels
                .begin(&group.program, monomials, degree, wanted);
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
        let size = problem.direct.layout.size;
        let mut found = vec![PhysicalForcing::new(size); known.len()];
        for group in &mut self.groups {
            let moving = |jet: Jet| jet.t > 0;
            let table = group.table(problem, &self.jets, known, moving);
            let jets = |jet: usize, index: usize| table[index].get(jet)?.clone();
            let outputs = group
                .levels
                .outputs(&group.program, monomials, degree, &jets);
            for (row, values) in group.rows.iter().zip(outputs) {
                for (forcing, values) in found.iter_mut().zip(values) {
                    for (i, (value, factor)) in values.iter().zip(&row.factors).enumerate() {
                        forcing.values[row.offset + i] = *value;
                        forcing.factors[row.offset + i] = *factor;
                    }
                }
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
        for group in &mut self.groups {
            let table = group.table(problem, &self.jets, modes, |_| true);
            let jets = |jet: usize, index: usize| table[index].get(jet)?.clone();
            group
                .levels
                .complete(&group.program, monomials, degree, &jets);
        }
    }
}

/// The residual's coefficient of one monomial, and what makes a right-hand side in the solver's basis of it.
#[derive(Clone)]
pub(super) struct PhysicalForcing {
    values: Vec<C64>,
    factors: Vec<C64>,
}

impl PhysicalForcing {
    fn new(size: usize) -> Self {
        PhysicalForcing {
            values: vec![C64::new(0.0, 0.0); size],
            factors: vec![C64::new(0.0, 0.0); size],
        }
    }

    /// G in the solver's basis.
    pub fn right(&self) -> Turned {
        let pairs = self.values.iter().zip(&self.factors);
        Turned(pairs.map(|(v, f)| v * f).collect())
    }

    /// G of the conjugate monomial.
    pub fn conjugate_right(&self) -> Turned {
        let pairs = self.values.iter().zip(&self.factors);
        Turned(pairs.map(|(v, f)| v.conj() * f).collect())
    }
}

struct Preparation<'a> {
    problem: &'a Problem,
    k: f64,
    odd: Option<Vec<bool>>,
}

impl Preparation<'_> {
    fn states(&self, points: Points) -> Vec<Vec<f64>> {
        let places = self.problem.space().places(points).into_iter();
        places
            .map(|place| self.problem.base.at(place, self.k))
            .collect()
    }

    fn group(
        &self,
        kernel: &Kernel,
        outputs: &[usize],
        states: Vec<Vec<f64>>,
        points: Points,
        rows: Vec<Row>,
    ) -> Group {
        let structure = self.problem.structure();
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
            rows,
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
    /// The chosen jets of each mode at the points, `[mode][jet][point]`; nothing for one that is zero.
    fn table(
        &self,
        problem: &Problem,
        jets: &[Jet],
        modes: &[Option<Mode>],
        chosen: impl Fn(Jet) -> bool,
    ) -> Vec<Vec<Option<Vec<C64>>>> {
        let read: Vec<usize> = self
            .read
            .iter()
            .copied()
            .filter(|&i| chosen(jets[i]))
            .collect();
        let wanted: Vec<Jet> = read.iter().map(|&index| jets[index]).collect();
        let row = |mode: &Option<Mode>| {
            let Some(mode) = mode else { return Vec::new() };
            let mut row = vec![None; jets.len()];
            let columns = mode.columns(problem, &wanted, self.points);
            for (&index, column) in read.iter().zip(columns) {
                row[index] = Some(column);
            }
            row
        };
        modes.iter().map(row).collect()
    }
}
