//! The structure of a model written out as Rust source, with the contract's types in scope as `s`.

use landau_contract::*;
use proc_macro2::TokenStream;
use quote::quote;

/// A value that can be written out as Rust source.
pub trait Literal {
    /// The tokens.
    fn literal(&self) -> TokenStream;
}

/// Every field of a structure, by name: one that is missing here does not compile.
macro_rules! literals {
    ($($name:ident { $($field:ident),* })*) => {
        $(impl Literal for $name {
            fn literal(&self) -> TokenStream {
                let $name { $($field),* } = self;
                let mut fields = TokenStream::new();
                $({
                    let name = quote::format_ident!("{}", stringify!($field));
                    let value = $field.literal();
                    fields.extend(quote!(#name: #value,));
                })*
                let name = quote::format_ident!("{}", stringify!($name));
                quote!(s::#name { #fields })
            }
        })*
    };
}

literals! {
    Structure { name, title, order, periodic, coordinate, fields, parameters, balances, base_order, base, offsets, adjoint_offsets, parity, linear, adjoint, form_jets, form_coefficients, forms, residual_jets, switches, cases, amplitude, outputs, typical, lines, operations }
    TypicalInfo { k, near }
    LinesInfo { coordinate, base, fields, balances }
    BaseCheckInfo { end, written, line }
    FieldInfo { name, doc, lower, upper, uniform }
    ParameterInfo { name, doc, default, lower, upper, choices, whole, automatic }
    BaseInfo { solved, closed, rows, offsets, integrals, automatic }
    BaseJet { field, order }
    BaseRowInfo { balance, jets }
    AutomaticInfo { parameter, end }
    ParityInfo { fields, rows }
    CaseInfo { choices, base_conditions, base_checks, conditions, adjoint, closures }
    BaseConditionInfo { end, jets }
    ConditionInfo { end, monomials }
    AdjointConditionInfo { end, jets }
    ClosureInfo { kind, field, density, column }
    AmplitudeInfo { weighted, field, description }
    OutputInfo { name, doc, at_point, monomials }
}

impl<Row: Literal, Column: Literal> Literal for OffsetsInfo<Row, Column> {
    fn literal(&self) -> TokenStream {
        let OffsetsInfo { rows, columns } = self;
        let (rows, columns) = (rows.literal(), columns.literal());
        quote!(s::OffsetsInfo { rows: #rows, columns: #columns })
    }
}

impl<Row: Literal, Column: Literal> Literal for TermInfo<Row, Column> {
    fn literal(&self) -> TokenStream {
        let TermInfo { row, jet } = self;
        let (row, jet) = (row.literal(), jet.literal());
        quote!(s::TermInfo { row: #row, jet: #jet })
    }
}

macro_rules! id_literals {
    ($($name:ident)*) => {$(
        impl Literal for $name {
            fn literal(&self) -> TokenStream {
                let name = quote::format_ident!("{}", stringify!($name));
                let position = self.index().literal();
                quote!(s::#name(#position))
            }
        }
    )*};
}

id_literals! { FieldId BalanceId ParameterId CaseId BaseRowId SolvedId }

impl<I, T: Literal> Literal for Table<I, T> {
    fn literal(&self) -> TokenStream {
        let items = self.iter().map(Literal::literal);
        quote!(s::Table::from(vec![#(#items),*]))
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

impl<V: Literal> Literal for Jet<V> {
    fn literal(&self) -> TokenStream {
        let Jet { of, t, x, absx, y } = self;
        let [t, x, absx, y] = [t, x, absx, y].map(Literal::literal);
        let of = of.literal();
        quote!(s::jet(#of, #t, #x, #absx, #y))
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

/// A slice of a constant.
fn borrowed<T: Literal>(items: &[T]) -> TokenStream {
    let items = items.iter().map(Literal::literal);
    quote!(Cow::Borrowed(&[#(#items),*]))
}

impl Literal for Kernel {
    fn literal(&self) -> TokenStream {
        let inputs = borrowed(&self.inputs);
        let operations = borrowed(&self.operations);
        let outputs = borrowed(&self.outputs);
        let unshared = self.unshared.literal();
        quote!(s::Kernel {
            inputs: #inputs,
            operations: #operations,
            outputs: #outputs,
            unshared: #unshared,
        })
    }
}

impl Literal for Array {
    fn literal(&self) -> TokenStream {
        let Array { name, real } = self;
        quote!(s::Array { name: #name, real: #real })
    }
}

impl Literal for Operation {
    fn literal(&self) -> TokenStream {
        let name = match self {
            Operation::Constant(_) => "Constant",
            Operation::Input(..) => "Input",
            Operation::Add(..) => "Add",
            Operation::Subtract(..) => "Subtract",
            Operation::Multiply(..) => "Multiply",
            Operation::Divide(..) => "Divide",
            Operation::Negate(_) => "Negate",
            Operation::Sqrt(_) => "Sqrt",
            Operation::PowerI(..) => "PowerI",
            Operation::PowerF(..) => "PowerF",
            Operation::Call(..) => "Call",
            Operation::Select(..) => "Select",
        };
        let name = quote::format_ident!("{name}");
        let operands = match self {
            Operation::Constant(value) => value.literal(),
            Operation::Negate(a) | Operation::Sqrt(a) => a.literal(),
            Operation::Input(a, b)
            | Operation::Add(a, b)
            | Operation::Subtract(a, b)
            | Operation::Multiply(a, b)
            | Operation::Divide(a, b) => {
                let (a, b) = (a.literal(), b.literal());
                quote!(#a, #b)
            }
            Operation::PowerI(a, exponent) => {
                let (a, exponent) = (a.literal(), proc_macro2::Literal::i32_unsuffixed(*exponent));
                quote!(#a, #exponent)
            }
            Operation::PowerF(a, exponent) => {
                let (a, exponent) = (a.literal(), exponent.literal());
                quote!(#a, #exponent)
            }
            Operation::Call(function, a) => {
                let (function, a) = (quote::format_ident!("{function:?}"), a.literal());
                quote!(s::Function::#function, #a)
            }
            Operation::Select(switch, branches) => {
                let (switch, branches) = (switch.literal(), borrowed(branches));
                quote!(#switch, #branches)
            }
        };
        quote!(s::Operation::#name(#operands))
    }
}
