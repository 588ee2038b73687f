//! The shape of a generated model: what the solver has to know besides the kernels.
//!
//! The same types serve the emitted code (where they are written out as literals) and a model that
//! runs from its tape.

use crate::ids::{BalanceId, BaseRowId, CaseId, FieldId, Id, ParameterId, SolvedId, Table};
use crate::jet::{End, Jet};
use crate::state::StateLayout;

/// Everything about a model that is not a kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Name in the spec.
    pub name: String,
    /// The text in quotation marks beside the name; empty if there is none.
    pub title: String,
    /// Highest degree of the nonlinear forms.
    pub order: usize,
    /// The name of the periodic coordinate.
    pub periodic: String,
    /// The cross-stream coordinate, if there is one.
    pub coordinate: Option<String>,
    /// Profiles first, then unknown numbers.
    pub fields: Table<FieldId, FieldInfo>,
    /// In the order of their declaration in the spec.
    pub parameters: Table<ParameterId, ParameterInfo>,
    /// Names of the balances, in the order of their declaration.
    pub balances: Table<BalanceId, String>,
    /// Highest y-derivative of base fields that kernels ask for.
    pub base_order: usize,
    /// The problem of the base state.
    pub base: BaseInfo,
    /// Offsets of L, whose rows are balances and whose columns are fields.
    pub offsets: OffsetsInfo<BalanceId, FieldId>,
    /// Offsets of L†, whose rows are fields and whose columns are balances.
    pub adjoint_offsets: OffsetsInfo<FieldId, BalanceId>,
    /// Which fields and balances are odd in the mirror x → −x, where the model has that symmetry.
    pub parity: Option<ParityInfo>,
    /// L (no ∂t) and M0 (one ∂t); coefficients from [`KernelId::Linear`] in this order.
    pub linear: Vec<TermInfo<BalanceId, FieldId>>,
    /// L† and M0†; coefficients from [`KernelId::Adjoint`] in this order.
    pub adjoint: Vec<TermInfo<FieldId, BalanceId>>,
    /// The jets that the nonlinear forms read, in the order of their arguments.
    pub form_jets: Vec<Jet>,
    /// Number of outputs of [`KernelId::Nonlinear`].
    pub form_coefficients: usize,
    /// `forms[d − 2][row]`: whether N_d has terms in that row.
    pub forms: Vec<Table<BalanceId, bool>>,
    /// The jets that the unexpanded residual reads.
    pub residual_jets: Vec<Jet>,
    /// Parameters (switches) that select the case.
    pub switches: Vec<ParameterId>,
    /// One for each combination of the structural switches.
    pub cases: Table<CaseId, CaseInfo>,
    /// What the amplitude measures.
    pub amplitude: AmplitudeInfo,
    /// Output functionals.
    pub outputs: Vec<OutputInfo>,
    /// What the spec calls typical.
    pub typical: Option<TypicalInfo>,
    /// Lines of the spec, for messages.
    pub lines: LinesInfo,
    /// Two numbers: operations of all kernels as written, and after common subexpressions are shared.
    pub operations: Vec<usize>,
}

/// Lines of the spec, from 1; 0 for a block that it does not have.
#[derive(Clone, Debug, PartialEq)]
pub struct LinesInfo {
    /// Where the cross-stream coordinate is declared.
    pub coordinate: usize,
    /// Where the `base` block begins.
    pub base: usize,
    /// Of each field.
    pub fields: Table<FieldId, usize>,
    /// Of each balance.
    pub balances: Table<BalanceId, usize>,
}

/// The wavenumber of the block `typical`: one at which the model shows what it is about.
#[derive(Clone, Debug, PartialEq)]
pub struct TypicalInfo {
    /// Wavenumber.
    pub k: f64,
    /// Real and imaginary part of an eigenvalue near that of the mode: two numbers, or none for the mode that grows
    /// fastest.
    pub near: Vec<f64>,
}

/// A field of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldInfo {
    /// Name in the spec.
    pub name: String,
    /// The text in quotation marks beside the name; empty if there is none.
    pub doc: String,
    /// Range that a base state must keep.
    pub lower: f64,
    /// The largest value that a base state may take.
    pub upper: f64,
    /// A number rather than a profile.
    pub uniform: bool,
}

/// A parameter of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterInfo {
    /// Name in the spec.
    pub name: String,
    /// The text in quotation marks beside the name; empty if there is none.
    pub doc: String,
    /// Its value where none is set.
    pub default: f64,
    /// The least value it accepts; −∞ if there is none.
    pub lower: f64,
    /// The largest value it accepts; +∞ if there is none.
    pub upper: f64,
    /// Names of the values of a switch, whose value is a position in this list; empty for a number.
    pub choices: Vec<String>,
    /// Whether it takes whole numbers alone.
    pub whole: bool,
    /// Whether a base condition can determine it (`auto`).
    pub automatic: bool,
}

/// The problem of the base state: unknown fields, balances, integral and automatic conditions.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseInfo {
    /// Fields that are solved for; profiles first.
    pub solved: Table<SolvedId, FieldId>,
    /// Whether each field has a closed form.
    pub closed: Table<FieldId, bool>,
    /// Balances that it has to satisfy.
    pub rows: Table<BaseRowId, BaseRowInfo>,
    /// Offsets of the base problem, from `rows` to `solved`.
    pub offsets: OffsetsInfo<BaseRowId, SolvedId>,
    /// Base jets that each integrand depends on.
    pub integrals: Vec<Vec<BaseJet>>,
    /// Parameter and end of each automatic condition.
    pub automatic: Vec<AutomaticInfo>,
}

/// The staggered discretisation at resolution N: row i is collocated at N + `rows[i]` points, column j has
/// N + `columns[j]` values. Values exceed points by the number of boundary conditions.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetsInfo<Row, Column> {
    /// Additional points of each row.
    pub rows: Table<Row, usize>,
    /// Additional values of each column.
    pub columns: Table<Column, usize>,
}

/// ∂y^order of a base field.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseJet {
    /// The base field.
    pub field: FieldId,
    /// Powers of ∂y.
    pub order: usize,
}

/// One balance of the base state: [`KernelId::Base`] gives its residual, then its derivative by
/// each of `jets`.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseRowInfo {
    /// Which balance it is.
    pub balance: BalanceId,
    /// The base jets that it depends on.
    pub jets: Vec<BaseJet>,
}

/// A parameter that a condition of the base state can determine.
#[derive(Clone, Debug, PartialEq)]
pub struct AutomaticInfo {
    /// Which parameter.
    pub parameter: ParameterId,
    /// Where the condition holds.
    pub end: End,
}

/// Which fields and balances are odd in the mirror x → −x.
#[derive(Clone, Debug, PartialEq)]
pub struct ParityInfo {
    /// By field.
    pub fields: Table<FieldId, bool>,
    /// By balance.
    pub rows: Table<BalanceId, bool>,
}

/// A term of an operator from columns to rows: L takes fields to balances, L† balances to fields.
#[derive(Clone, Debug, PartialEq)]
pub struct TermInfo<Row, Column> {
    /// The row that holds the term: a balance in L, a field in L†.
    pub row: Row,
    /// The derivative that the coefficient multiplies.
    pub jet: Jet<Column>,
}

/// One combination of the structural switches: its conditions and closures.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseInfo {
    /// The choice of each structural switch.
    pub choices: Vec<usize>,
    /// [`KernelId::BaseConditions`]: residual, then its derivative by each jet.
    pub base_conditions: Vec<BaseConditionInfo>,
    /// The conditions of [`ResidualId::BaseChecks`].
    pub base_checks: Vec<BaseCheckInfo>,
    /// [`KernelId::Conditions`]: one coefficient a monomial.
    pub conditions: Vec<ConditionInfo>,
    /// [`KernelId::AdjointConditions`]: one coefficient a jet; or why there are none.
    pub adjoint: Result<Vec<AdjointConditionInfo>, String>,
    /// [`KernelId::Closures`]: densities, then columns, of each.
    pub closures: Vec<ClosureInfo>,
}

/// A condition of the base state.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseConditionInfo {
    /// The end of the interval at which it holds.
    pub end: End,
    /// The base jets that it depends on.
    pub jets: Vec<BaseJet>,
}

/// A condition that the base state, being in closed form, has to meet.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseCheckInfo {
    /// The end of the interval at which it holds.
    pub end: End,
    /// The condition as the spec writes it.
    pub written: String,
    /// Its line in the spec.
    pub line: usize,
}

/// A boundary condition of the perturbation.
#[derive(Clone, Debug, PartialEq)]
pub struct ConditionInfo {
    /// The end of the interval at which it holds.
    pub end: End,
    /// Monomials of degree 1, 2, 3, …
    pub monomials: Vec<Vec<Jet>>,
}

/// A boundary condition of the adjoint problem.
#[derive(Clone, Debug, PartialEq)]
pub struct AdjointConditionInfo {
    /// The end of the interval at which it holds.
    pub end: End,
    /// Jets of the adjoint fields of balances.
    pub jets: Vec<Jet<BalanceId>>,
}

/// A closure at k = 0: an integral constraint, and the column of its multiplier.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosureInfo {
    /// Which kind.
    pub kind: ClosureKind,
    /// The field of a gauge or a drift, or the unknown number; `None` for conserved and claimed integrals.
    pub field: Option<FieldId>,
    /// The jets of the linear density; one coefficient each in [`KernelId::Closures`].
    pub density: Vec<Jet>,
    /// Balances that the multiplier enters; one weight each in [`KernelId::Closures`].
    pub column: Vec<BalanceId>,
}

/// What the amplitude measures.
#[derive(Clone, Debug, PartialEq)]
pub struct AmplitudeInfo {
    /// Fields with a weight in ∫ Σ w|q|² dy; empty for a point value.
    pub weighted: Vec<FieldId>,
    /// The field of a point value.
    pub field: Option<FieldId>,
    /// What is printed beside every coefficient.
    pub description: String,
}

/// An output functional.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputInfo {
    /// Name in the spec.
    pub name: String,
    /// The text in quotation marks beside the name; empty if there is none.
    pub doc: String,
    /// Evaluated at a place, rather than integrated.
    pub at_point: bool,
    /// Monomials of degree 0 (empty), 1, 2, …
    pub monomials: Vec<Vec<Jet>>,
}

/// The kinds of closure at k = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClosureKind {
    /// An integral that does not change in time.
    Conserved,
    /// An integral that the spec claims to be conserved. The solver keeps it if it is conserved in the collocated problem,
    /// and drops it otherwise.
    Claimed,
    /// The constant of a field that is determined up to one.
    Gauge,
    /// A gauge with a time derivative: its multiplier is the rate at which the constant drifts.
    Drift,
    /// A number without a profile that an integral condition determines.
    Unknown,
}

/// The real kernels of a model. All read the point state of [`StateLayout`]; [`crate::layout`] says what their
/// outputs are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KernelId {
    /// The two ends of the interval.
    Interval,
    /// Closed-form fields and their y-derivatives, in point-state order; zeros for solved ones.
    Closed,
    /// A starting value for each solved field.
    Guess,
    /// Base balances with their Jacobian.
    Base,
    /// Integrands of the base with their Jacobian, then the prescribed value, one after another.
    BaseIntegrals,
    /// Conditions that determine automatic parameters.
    Automatic,
    /// Conditions of the base in one case, with their Jacobian.
    BaseConditions(CaseId),
    /// What each balance is divided by.
    Divisors,
    /// Coefficients of L and M0.
    Linear,
    /// Coefficients of L† and M0†.
    Adjoint,
    /// Coefficients of N2 and N3.
    Nonlinear,
    /// Coefficients of the boundary conditions of one case.
    Conditions(CaseId),
    /// Coefficients of the adjoint boundary conditions of one case.
    AdjointConditions(CaseId),
    /// Densities and columns of the closures at k = 0 of one case.
    Closures(CaseId),
    /// Weights, then the prescribed value, then the place.
    Amplitude,
    /// For each output its place, then its coefficients.
    Outputs,
}

/// The unexpanded residuals of a model, for all number types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ResidualId {
    /// One value a balance, not divided.
    Balances,
    /// One value a boundary condition of a case, in the order of its conditions.
    Conditions(CaseId),
    /// One value a condition that the base state of a case, being in closed form, has to meet.
    BaseChecks(CaseId),
    /// The density of each closure of a case, in the order of its closures; no program if all densities are linear.
    Integrals(CaseId),
}

impl ParameterInfo {
    /// Whether it can vary continuously: a switch and a whole number cannot.
    pub fn is_continuous(&self) -> bool {
        self.choices.is_empty() && !self.whole
    }
}

impl Structure {
    /// The layout of the point state.
    pub fn state(&self) -> StateLayout {
        StateLayout::new(self.parameters.len(), self.fields.len(), self.base_order)
    }

    /// ∂y^order of a base field at a point.
    pub fn base_value(&self, point: &[f64], field: FieldId, order: usize) -> f64 {
        point[self.state().base(field, order)]
    }

    /// The value of a jet in the base state at a point: zero for one with ∂x or ∂t in it.
    pub fn base_jet(&self, jet: Jet, point: &[f64]) -> f64 {
        let order = usize::from(jet.y);
        if jet.is_base() && order <= self.base_order {
            self.base_value(point, jet.of, order)
        } else {
            0.0
        }
    }

    /// The fields that are profiles; they come first.
    pub fn profiles(&self) -> impl ExactSizeIterator<Item = FieldId> + use<> {
        let count = self.fields.iter().filter(|f| !f.uniform).count();
        (0..count).map(FieldId::at)
    }

    /// The field of this name; `None` if there is none.
    pub fn field(&self, name: &str) -> Option<FieldId> {
        self.fields.position(|f| f.name == name)
    }
}
