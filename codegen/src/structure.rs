//! The shape of a generated model: what the solver has to know besides the kernels.
//!
//! The same types serve the emitted code (where they are written out as literals) and a model that
//! runs from its tape.

use proc_macro2::TokenStream;
use quote::quote;

pub use crate::graph::Jet;
pub use crate::model::End;

/// A value that can be written out as Rust source, given `structure` types in scope as `s`.
pub trait Literal {
    fn literal(&self) -> TokenStream;
}

macro_rules! structures {
    ($($(#[$doc:meta])* pub struct $name:ident { $($(#[$field_doc:meta])* pub $field:ident: $type:ty,)* })*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Debug, PartialEq)]
            pub struct $name { $($(#[$field_doc])* pub $field: $type,)* }

            impl Literal for $name {
                fn literal(&self) -> TokenStream {
                    let mut fields = TokenStream::new();
                    $({
                        let name = quote::format_ident!("{}", stringify!($field));
                        let value = self.$field.literal();
                        fields.extend(quote!(#name: #value,));
                    })*
                    let name = quote::format_ident!("{}", stringify!($name));
                    quote!(s::#name { #fields })
                }
            }
        )*
    };
}

structures! {
    /// Everything about a model that is not a kernel.
    pub struct Structure {
        pub name: String,
        pub title: String,
        /// Highest degree of the nonlinear forms.
        pub order: usize,
        pub periodic: String,
        /// The cross-stream coordinate, if there is one.
        pub coordinate: Option<String>,
        /// Profiles first, then unknown numbers.
        pub fields: Vec<FieldInfo>,
        pub parameters: Vec<ParameterInfo>,
        pub balances: Vec<String>,
        /// Highest y-derivative of base fields that kernels ask for.
        pub base_order: usize,
        pub base: BaseInfo,
        /// Points of the balances and values of the profiles in L.
        pub offsets: OffsetsInfo,
        /// The same for L†: rows are fields, columns balances.
        pub adjoint_offsets: OffsetsInfo,
        pub parity: Option<ParityInfo>,
        /// L (no ∂t) and M0 (one ∂t); coefficients from [`KernelId::Linear`] in this order.
        pub linear: Vec<TermInfo>,
        /// L† and M0†; rows are fields, `jet.field` is a balance.
        pub adjoint: Vec<TermInfo>,
        /// The jets that the nonlinear forms read, in the order of their arguments.
        pub form_jets: Vec<Jet>,
        /// Number of outputs of [`KernelId::Nonlinear`].
        pub form_coefficients: usize,
        /// `forms[d − 2][row]`: whether N_d has terms in that row.
        pub forms: Vec<Vec<bool>>,
        /// The jets that the unexpanded residual reads.
        pub residual_jets: Vec<Jet>,
        /// Parameters (switches) that select the case.
        pub switches: Vec<usize>,
        pub cases: Vec<CaseInfo>,
        pub amplitude: AmplitudeInfo,
        pub outputs: Vec<OutputInfo>,
        pub typical: Option<TypicalInfo>,
        /// Operations of all kernels as written, and after common subexpressions are shared.
        pub operations: Vec<usize>,
    }

    /// A wavenumber that shows what the model is about.
    pub struct TypicalInfo {
        pub k: f64,
        /// Real and imaginary part of the eigenvalue that its mode is near to; empty for the leading one.
        pub near: Vec<f64>,
    }

    pub struct FieldInfo {
        pub name: String,
        pub doc: String,
        /// Range that a base state must keep.
        pub lower: f64,
        pub upper: f64,
        /// A number rather than a profile.
        pub uniform: bool,
    }

    pub struct ParameterInfo {
        pub name: String,
        pub doc: String,
        pub default: f64,
        pub lower: f64,
        pub upper: f64,
        /// Names of the values of a switch.
        pub choices: Vec<String>,
        /// Whether a base condition can determine it (`auto`).
        pub automatic: bool,
    }

    pub struct BaseInfo {
        /// Fields that are solved for; profiles first.
        pub solved: Vec<usize>,
        /// Whether each field has a closed form.
        pub closed: Vec<bool>,
        pub rows: Vec<BaseRowInfo>,
        /// Points of `rows` and values of the profiles among `solved`.
        pub offsets: OffsetsInfo,
        /// Base jets that each integrand depends on.
        pub integrals: Vec<Vec<BaseJet>>,
        /// Parameter and end of each automatic condition.
        pub automatic: Vec<AutomaticInfo>,
    }

    /// Row i is collocated at N + `rows[i]` points, column j has N + `columns[j]` values; as many
    /// conditions as the values are more than the points.
    pub struct OffsetsInfo {
        pub rows: Vec<usize>,
        pub columns: Vec<usize>,
    }

    /// ∂y^order of a base field.
    pub struct BaseJet {
        pub field: usize,
        pub order: usize,
    }

    /// One balance of the base state: [`KernelId::Base`] gives its residual, then its derivative by
    /// each of `jets`.
    pub struct BaseRowInfo {
        pub balance: usize,
        pub jets: Vec<BaseJet>,
    }

    pub struct AutomaticInfo {
        pub parameter: usize,
        pub end: End,
    }

    pub struct ParityInfo {
        pub fields: Vec<bool>,
        pub rows: Vec<bool>,
    }

    pub struct TermInfo {
        pub row: usize,
        pub jet: Jet,
    }

    pub struct CaseInfo {
        /// The choice of each structural switch.
        pub choices: Vec<usize>,
        /// [`KernelId::BaseConditions`]: residual, then its derivative by each jet.
        pub base_conditions: Vec<BaseConditionInfo>,
        /// The ends of the conditions of [`ResidualId::BaseChecks`].
        pub base_checks: Vec<End>,
        /// [`KernelId::Conditions`]: one coefficient a monomial.
        pub conditions: Vec<ConditionInfo>,
        /// [`KernelId::AdjointConditions`]: one coefficient a jet; or why there are none.
        pub adjoint: Result<Vec<AdjointConditionInfo>, String>,
        /// [`KernelId::Closures`]: densities, then columns, of each.
        pub closures: Vec<ClosureInfo>,
    }

    pub struct BaseConditionInfo {
        pub end: End,
        pub jets: Vec<BaseJet>,
    }

    pub struct ConditionInfo {
        pub end: End,
        /// Monomials of degree 1, 2, 3, …
        pub monomials: Vec<Vec<Jet>>,
    }

    pub struct AdjointConditionInfo {
        pub end: End,
        pub jets: Vec<Jet>,
    }

    pub struct ClosureInfo {
        pub kind: ClosureKind,
        /// The gauge or the unknown.
        pub field: Option<usize>,
        pub density: Vec<Jet>,
        /// Balances that the multiplier enters.
        pub column: Vec<usize>,
    }

    pub struct AmplitudeInfo {
        /// Fields with a weight in ∫ Σ w|q|² dy; empty for a point value.
        pub weighted: Vec<usize>,
        /// The field of a point value.
        pub field: Option<usize>,
        /// What is printed beside every coefficient.
        pub description: String,
    }

    pub struct OutputInfo {
        pub name: String,
        pub doc: String,
        /// Evaluated at a place, rather than integrated.
        pub at_point: bool,
        /// Monomials of degree 0 (empty), 1, 2, …
        pub monomials: Vec<Vec<Jet>>,
    }
}

/// The kinds of closure at k = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClosureKind {
    Conserved,
    /// Said to be conserved: recognised in the collocated problem, or dropped.
    Claimed,
    Gauge,
    /// A gauge with a time derivative: its multiplier is the rate at which the constant drifts.
    Drift,
    Unknown,
}

/// The real kernels of a model. All read the point state
/// `[y, k, parameters…, base field 0 and its y-derivatives to base_order, base field 1, …]`.
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
    BaseConditions(usize),
    /// What each balance is divided by.
    Divisors,
    Linear,
    Adjoint,
    Nonlinear,
    /// Coefficients of the boundary conditions of one case.
    Conditions(usize),
    AdjointConditions(usize),
    Closures(usize),
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
    Conditions(usize),
    /// One value a condition that the base state of a case, being in closed form, has to meet.
    BaseChecks(usize),
}

impl Structure {
    /// Length of the point state.
    pub fn state_length(&self) -> usize {
        2 + self.parameters.len() + self.fields.len() * (self.base_order + 1)
    }

    /// Position of a base jet in the point state.
    pub fn base_position(&self, field: usize, order: usize) -> usize {
        2 + self.parameters.len() + field * (self.base_order + 1) + order
    }

    /// The value of a jet in the base state at a point: zero for one with ∂x or ∂t in it.
    pub fn base_jet(&self, jet: Jet, point: &[f64]) -> f64 {
        let order = usize::from(jet.y);
        if jet.is_base() && order <= self.base_order {
            point[self.base_position(usize::from(jet.field), order)]
        } else {
            0.0
        }
    }

    /// Number of profiles among the fields.
    pub fn profiles(&self) -> usize {
        self.fields.iter().filter(|f| !f.uniform).count()
    }
}

impl Literal for usize {
    fn literal(&self) -> TokenStream {
        let value = proc_macro2::Literal::usize_unsuffixed(*self);
        quote!(#value)
    }
}

impl Literal for u8 {
    fn literal(&self) -> TokenStream {
        let value = proc_macro2::Literal::u8_unsuffixed(*self);
        quote!(#value)
    }
}

impl Literal for bool {
    fn literal(&self) -> TokenStream {
        quote!(#self)
    }
}

impl Literal for f64 {
    fn literal(&self) -> TokenStream {
        if *self == f64::INFINITY {
            quote!(f64::INFINITY)
        } else if *self == f64::NEG_INFINITY {
            quote!(f64::NEG_INFINITY)
        } else {
            let size = proc_macro2::Literal::f64_unsuffixed(self.abs());
            if self.is_sign_negative() {
                quote!(-#size)
            } else {
                quote!(#size)
            }
        }
    }
}

impl Literal for String {
    fn literal(&self) -> TokenStream {
        quote!(String::from(#self))
    }
}

impl<T: Literal> Literal for Vec<T> {
    fn literal(&self) -> TokenStream {
        let items = self.iter().map(Literal::literal);
        quote!(vec![#(#items),*])
    }
}

impl<T: Literal> Literal for Option<T> {
    fn literal(&self) -> TokenStream {
        match self {
            Some(value) => {
                let value = value.literal();
                quote!(Some(#value))
            }
            None => quote!(None),
        }
    }
}

impl<T: Literal, E: Literal> Literal for Result<T, E> {
    fn literal(&self) -> TokenStream {
        match self {
            Ok(value) => {
                let value = value.literal();
                quote!(Ok(#value))
            }
            Err(error) => {
                let error = error.literal();
                quote!(Err(#error))
            }
        }
    }
}

impl Literal for Jet {
    fn literal(&self) -> TokenStream {
        let Jet {
            field,
            t,
            x,
            absx,
            y,
        } = self;
        let [field, t, x, absx, y] = [field, t, x, absx, y].map(Literal::literal);
        quote!(s::jet(#field, #t, #x, #absx, #y))
    }
}

/// Shorthand for literals in emitted code.
pub fn jet(field: u8, t: u8, x: u8, absx: u8, y: u8) -> Jet {
    Jet {
        field,
        t,
        x,
        absx,
        y,
    }
}

impl Literal for End {
    fn literal(&self) -> TokenStream {
        match self {
            End::Lower => quote!(s::End::Lower),
            End::Upper => quote!(s::End::Upper),
        }
    }
}

impl Literal for ClosureKind {
    fn literal(&self) -> TokenStream {
        match self {
            ClosureKind::Conserved => quote!(s::ClosureKind::Conserved),
            ClosureKind::Claimed => quote!(s::ClosureKind::Claimed),
            ClosureKind::Gauge => quote!(s::ClosureKind::Gauge),
            ClosureKind::Drift => quote!(s::ClosureKind::Drift),
            ClosureKind::Unknown => quote!(s::ClosureKind::Unknown),
        }
    }
}
