//! Checked model → operators: expansion, L, L† with its boundary conditions, N2, N3.
//!
//! Each pass is a function from one type to the next; [`derive()`] shows the whole of it.

mod base;
mod base_wall;
mod boundary;
mod case;
mod check;
mod closure;
mod density;
mod deriver;
mod expand;
mod gauge;
mod invariant;
mod linear;
mod mean;
mod offsets;
mod open;
mod pairing;
mod parity;
mod redundant;
mod regular;
mod value;
mod wall;

pub use base::BaseRow;
pub use base_wall::BaseCheck;
pub use boundary::{Combination, Symbol};
pub use case::{AdjointCondition, Case};
pub use closure::CaseClosure;
pub use density::Density;
pub use linear::{AdjointTerm, DirectTerm, Term};
pub use offsets::Offsets;
pub use open::{Dependence, Opener, carry_out, dependence};
pub use parity::Parity;
pub use value::base_value;
pub use wall::{BaseCondition, WallCondition};

use crate::diagnostic::Diagnostics;
use crate::form::Form;
use crate::graph::{BalanceId, CaseId, FieldId, Graph, Id, ParameterId, Table};
use crate::model::Model;
use deriver::Deriver;
use landau_contract::{BaseRowId, SolvedId};

/// A model and what follows from it.
pub struct Derivation {
    /// Every expression of the model and of the operators.
    pub graph: Graph,
    /// The model that everything is derived from.
    pub model: Model,
    /// The operators.
    pub operators: Operators,
}

/// Everything that follows from a model by symbolic derivation; laws still opaque.
pub struct Operators {
    /// Truncation order of the expansion.
    pub order: usize,
    /// M ∂t X − R of each balance, expanded, not divided.
    pub balances: Table<BalanceId, Form>,
    /// The divisor of each balance; 1 if the spec gives none.
    pub divisors: Table<BalanceId, Id>,
    /// L and M0, divided.
    pub linear: Vec<DirectTerm>,
    /// L† and M0†.
    pub adjoint: Vec<AdjointTerm>,
    /// N2, N3, … : `nonlinear[d − 2][row]`, divided, on the right-hand side.
    pub nonlinear: Vec<Table<BalanceId, Form>>,
    /// Numbers of values of the fields and of points of the balances in L.
    pub offsets: Offsets<BalanceId, FieldId>,
    /// The same numbers in L†, whose rows are fields and whose columns are balances.
    pub adjoint_offsets: Offsets<FieldId, BalanceId>,
    /// The field that each balance determines.
    pub pairing: Table<BalanceId, FieldId>,
    /// Odd fields and balances, where the model has the mirror symmetry.
    pub parity: Option<Parity>,
    /// Balances that determine the base state, or have to hold for it.
    pub base: Table<BaseRowId, BaseRow>,
    /// Numbers of points of `base` and of values of `solved`.
    pub base_offsets: Offsets<BaseRowId, SolvedId>,
    /// Fields that the base state is solved for, numbers last.
    pub solved: Table<SolvedId, FieldId>,
    /// Integral conditions of the base state: integrand and value.
    pub base_integrals: Vec<(Id, Id)>,
    /// Switches that change boundary conditions.
    pub switches: Vec<ParameterId>,
    /// One for each combination of their choices.
    pub cases: Table<CaseId, Case>,
    /// Output functionals, expanded.
    pub outputs: Vec<Form>,
}

/// Derives all operators to the given order.
///
/// # Errors
/// Every mistake that the derivation meets, with its place in the spec.
pub fn derive(mut graph: Graph, model: Model, order: usize) -> Result<Derivation, Diagnostics> {
    let mut mistakes = Vec::new();
    let operators = Deriver::new(&model, &mut graph, order).run(&mut mistakes);
    match operators {
        Some(operators) if mistakes.is_empty() => Ok(Derivation {
            graph,
            model,
            operators,
        }),
        _ => Err(Diagnostics {
            files: model.sources,
            list: mistakes,
        }),
    }
}
