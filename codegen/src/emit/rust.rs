//! Kernels → Rust source.
//!
//! Every kernel is a function of straight-line code; the equations stand in its documentation.

use super::comment::{Comments, comment, comments, registers_of, with_comments};
use super::literal::Literal;
use super::name::Identifiers;
use super::text;
use crate::derive::Derivation;
use crate::kernel::{Kernel, ModelKernels, Operation};
use landau_contract::{CaseId, Id as _, KernelId, ResidualId};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The module of one model: a type that implements the solver's `Model` trait; its parent holds `LAWS`, the law
/// files of the crate.
pub fn module(derivation: &Derivation, model: &ModelKernels) -> String {
    let structure = model.structure.literal();
    let kernels = kernels(derivation, model);
    let forms = forms(derivation, model);
    let residuals = residuals(model);
    let functions = [&kernels, &forms, &residuals].map(|part| &part.functions);
    let texts = texts();
    let evaluation = evaluation(&kernels, &forms, &residuals);
    let undeclared = undeclared(&model.undeclared);
    let sources = derivation.model.sources.iter().map(|file| {
        let (path, text) = (&file.path, &file.text);
        quote!((#path, #text))
    });
    let generated = generated();
    let code = quote! {
        use landau_contract as s;
        use s::C64;
        use std::borrow::Cow;

        #generated

        impl s::Model for Generated {
            #texts
            #evaluation
            #undeclared
        }

        /// The spec and its law files, as they were when this module was generated.
        const SOURCES: &[(&str, &str)] = &[#(#sources),*];

        fn structure() -> s::Structure {
            #structure
        }

        #(#functions)*
    };
    with_comments(&pretty(code))
}

/// The type that the module defines.
fn generated() -> TokenStream {
    quote! {
        /// The generated operators, for the solver.
        pub struct Generated {
            structure: s::Structure,
        }

        impl Generated {
            /// The model, ready to be solved.
            pub fn new() -> Self {
                Generated { structure: structure() }
            }
        }

        impl Default for Generated {
            fn default() -> Self {
                Self::new()
            }
        }
    }
}

/// The methods that say what the module was made from.
fn texts() -> TokenStream {
    let build = crate::BUILD;
    quote! {
        fn structure(&self) -> &s::Structure {
            &self.structure
        }

        fn sources(&self) -> Vec<(String, String)> {
            SOURCES.iter().map(|(path, text)| (path.to_string(), text.to_string())).collect()
        }

        fn laws(&self) -> Vec<(String, String)> {
            super::LAWS.iter().map(|(path, text)| (path.to_string(), text.to_string())).collect()
        }

        fn generator(&self) -> &str {
            #build
        }
    }
}

/// The methods that pick a kernel, a nonlinear form or a residual.
fn evaluation(kernels: &Dispatch, forms: &Dispatch, residuals: &Dispatch) -> TokenStream {
    let [kernels, forms, residuals] = [kernels, forms, residuals].map(|part| &part.arms);
    quote! {
        fn evaluate(&self, kernel: s::KernelId, point: &[f64], out: &mut [f64]) {
            match kernel {
                #kernels
                absent => panic!("this model has no kernel {absent:?}"),
            }
        }

        fn form(&self, degree: usize, row: s::BalanceId, c: &[f64], x: &[&[C64]]) -> C64 {
            #forms
        }

        fn residual(&self, residual: s::ResidualId) -> Option<&s::Kernel> {
            match residual {
                #residuals
                _ => None,
            }
        }
    }
}

/// Functions or constants, and the arms of the `match` that picks one of them.
struct Dispatch {
    functions: TokenStream,
    arms: TokenStream,
}

/// The kernels over the point state.
fn kernels(derivation: &Derivation, model: &ModelKernels) -> Dispatch {
    let (mut functions, mut arms) = (TokenStream::new(), TokenStream::new());
    for (id, kernel) in &model.kernels {
        let (name, pattern) = (kernel_name(*id), kernel_pattern(*id));
        let comments = comments(derivation, model, *id);
        functions.extend(real_function(&name, kernel, &comments));
        arms.extend(quote!(s::KernelId::#pattern => #name(point, out),));
    }
    Dispatch { functions, arms }
}

/// N2, N3, … of each balance. A balance without terms of a degree has an arm that returns zero.
fn forms(derivation: &Derivation, model: &ModelKernels) -> Dispatch {
    let (mut functions, mut arms) = (TokenStream::new(), TokenStream::new());
    let mut identifiers = Identifiers::default();
    let balances = &model.structure.balances;
    let identifiers = balances.map(|name| identifiers.balance(name));
    for (index, rows) in model.forms.iter().enumerate() {
        let degree = index + 2;
        for (row, kernel) in rows.pairs() {
            let place = row.literal();
            let Some(kernel) = kernel else {
                arms.extend(quote!((#degree, #place) => C64::new(0.0, 0.0),));
                continue;
            };
            let name = format_ident!("n{}_{}", degree, identifiers[row]);
            let equation = text::nonlinear_row(derivation, degree, row);
            functions.extend(form_function(
                &name,
                kernel,
                degree,
                &balances[row],
                &equation,
            ));
            let arguments = (0..degree).map(proc_macro2::Literal::usize_unsuffixed);
            arms.extend(quote!((#degree, #place) => #name(c, #(x[#arguments]),*),));
        }
    }
    // A linear model reads neither coefficients nor jets.
    let unread = functions.is_empty().then(|| quote!(let _ = (c, x);));
    let arms = quote! {
        #unread
        match (degree, row) {
            #arms
            absent => panic!("this model has no nonlinear terms {absent:?}"),
        }
    };
    Dispatch { functions, arms }
}

/// The residuals of the full state.
fn residuals(model: &ModelKernels) -> Dispatch {
    let (mut functions, mut arms) = (TokenStream::new(), TokenStream::new());
    for (id, kernel) in &model.residuals {
        let (name, pattern) = residual_name(*id);
        functions.extend(residual_program(&name, kernel));
        arms.extend(quote!(s::ResidualId::#pattern => Some(&#name),));
    }
    Dispatch { functions, arms }
}

/// The method that names conserved integrals which the spec does not declare; `None` if no case has any.
fn undeclared(cases: &[(CaseId, Vec<String>)]) -> Option<TokenStream> {
    let arms = cases.iter().map(|(case, words)| {
        let case = case.literal();
        quote!(#case => vec![#(#words.to_string()),*],)
    });
    (!cases.is_empty()).then(|| {
        quote! {
            fn undeclared(&self, case: s::CaseId) -> Vec<String> {
                match case {
                    #(#arms)*
                    _ => Vec::new(),
                }
            }
        }
    })
}

/// Formats tokens; the emitter only makes valid items.
fn pretty(code: TokenStream) -> String {
    match syn::parse2::<syn::File>(code.clone()) {
        Ok(file) => prettyplease::unparse(&file),
        Err(_) => code.to_string(),
    }
}

fn kernel_name(id: KernelId) -> Ident {
    match id {
        KernelId::Interval => format_ident!("interval"),
        KernelId::Closed => format_ident!("closed_base"),
        KernelId::Guess => format_ident!("base_guess"),
        KernelId::Base => format_ident!("base_residual"),
        KernelId::BaseIntegrals => format_ident!("base_integrals"),
        KernelId::Automatic => format_ident!("automatic_conditions"),
        KernelId::BaseConditions(case) => format_ident!("base_conditions_{}", case.index()),
        KernelId::Divisors => format_ident!("divisors"),
        KernelId::Linear => format_ident!("linear_coefficients"),
        KernelId::Adjoint => format_ident!("adjoint_coefficients"),
        KernelId::Nonlinear => format_ident!("nonlinear_coefficients"),
        KernelId::Conditions(case) => format_ident!("boundary_conditions_{}", case.index()),
        KernelId::AdjointConditions(case) => format_ident!("adjoint_conditions_{}", case.index()),
        KernelId::Closures(case) => format_ident!("closures_{}", case.index()),
        KernelId::Amplitude => format_ident!("amplitude"),
        KernelId::Outputs => format_ident!("output_coefficients"),
    }
}

fn kernel_pattern(id: KernelId) -> TokenStream {
    match id {
        KernelId::BaseConditions(case) => case_pattern("BaseConditions", case),
        KernelId::Conditions(case) => case_pattern("Conditions", case),
        KernelId::AdjointConditions(case) => case_pattern("AdjointConditions", case),
        KernelId::Closures(case) => case_pattern("Closures", case),
        plain => {
            let name = format_ident!("{}", format!("{plain:?}"));
            quote!(#name)
        }
    }
}

fn case_pattern(kernel: &str, case: CaseId) -> TokenStream {
    let (kernel, case) = (format_ident!("{kernel}"), case.literal());
    quote!(#kernel(#case))
}

fn residual_name(id: ResidualId) -> (Ident, TokenStream) {
    match id {
        ResidualId::Balances => (format_ident!("RESIDUAL_BALANCES"), quote!(Balances)),
        ResidualId::Conditions(case) => (
            format_ident!("RESIDUAL_CONDITIONS_{}", case.index()),
            case_pattern("Conditions", case),
        ),
        ResidualId::BaseChecks(case) => (
            format_ident!("RESIDUAL_BASE_CHECKS_{}", case.index()),
            case_pattern("BaseChecks", case),
        ),
        ResidualId::Integrals(case) => (
            format_ident!("RESIDUAL_INTEGRALS_{}", case.index()),
            case_pattern("Integrals", case),
        ),
    }
}

/// `fn name(p, out)`: `p` is the point state.
fn real_function(name: &Ident, kernel: &Kernel, comments: &Comments) -> TokenStream {
    let body = body(kernel, &registers_of(kernel, comments));
    let outputs = outputs(kernel, comments);
    let doc = counts(kernel);
    let unused = unused_inputs(kernel);
    quote! {
        #[doc = #doc]
        fn #name(p: &[f64], out: &mut [f64]) {
            #unused
            #body
            #outputs
        }
    }
}

/// `fn name(c, x, y, …)`: coefficients, then the jets of each argument.
fn form_function(
    name: &Ident,
    kernel: &Kernel,
    degree: usize,
    balance: &str,
    equation: &str,
) -> TokenStream {
    let body = body(kernel, &Comments::new());
    let result = register(kernel.outputs[0]);
    let arguments = kernel.inputs[1..]
        .iter()
        .map(|array| format_ident!("{}", array.name));
    let title = format!(
        " N{degree} of `{balance}` as a symmetric {degree}-linear form; on the diagonal:\n\n ```text\n {equation}\n ```\n\n{}",
        counts(kernel)
    );
    quote! {
        #[doc = #title]
        fn #name(c: &[f64], #(#arguments: &[C64]),*) -> C64 {
            #body
            #result
        }
    }
}

/// A program over the point state and the jets of the full state, as data: the solver runs it on every type of number
/// that it has.
fn residual_program(name: &Ident, kernel: &Kernel) -> TokenStream {
    let doc = counts(kernel);
    let kernel = kernel.literal();
    quote! {
        #[doc = #doc]
        static #name: s::Kernel = #kernel;
    }
}

fn counts(kernel: &Kernel) -> String {
    format!(
        " {} operations, {} before sharing.",
        kernel.shared(),
        kernel.unshared
    )
}

/// Statements `let _ = …;` for inputs that a kernel does not read, since all kernels have one signature.
fn unused_inputs(kernel: &Kernel) -> TokenStream {
    let read = |array: usize| {
        kernel
            .operations
            .iter()
            .any(|op| matches!(op, Operation::Input(a, _) if *a == array))
    };
    let mut tokens = TokenStream::new();
    for (index, array) in kernel.inputs.iter().enumerate() {
        if !read(index) {
            let name = format_ident!("{}", array.name);
            tokens.extend(quote!(let _ = #name;));
        }
    }
    if kernel.outputs.is_empty() {
        tokens.extend(quote!(let _ = out;));
    }
    tokens
}

fn register(index: usize) -> Ident {
    format_ident!("t{index}")
}

fn outputs(kernel: &Kernel, comments: &Comments) -> TokenStream {
    let mut tokens = TokenStream::new();
    for (index, &value) in kernel.outputs.iter().enumerate() {
        tokens.extend(comments.get(&index).map(|words| comment(words)));
        let index = proc_macro2::Literal::usize_unsuffixed(index);
        let value = register(value);
        tokens.extend(quote!(out[#index] = #value;));
    }
    tokens
}

/// The statements of a kernel, one register each. Real registers are `f64`; all further ones are of the kernel's number
/// type.
fn body(kernel: &Kernel, comments: &Comments) -> TokenStream {
    let mut tokens = TokenStream::new();
    let real = kernel.real();
    for (index, operation) in kernel.operations.iter().enumerate() {
        tokens.extend(comments.get(&index).map(|words| comment(words)));
        let name = register(index);
        let value = expression(kernel, &real, operation);
        let annotation = matches!(operation, Operation::Constant(_)).then(|| quote!(: f64));
        tokens.extend(quote!(let #name #annotation = #value;));
    }
    tokens
}

fn expression(kernel: &Kernel, real: &[bool], operation: &Operation) -> TokenStream {
    match operation {
        Operation::Constant(value) => value.literal(),
        Operation::Input(array, position) => {
            let name = format_ident!("{}", kernel.inputs[*array].name);
            let position = proc_macro2::Literal::usize_unsuffixed(*position);
            quote!(#name[#position])
        }
        Operation::Add(..)
        | Operation::Subtract(..)
        | Operation::Multiply(..)
        | Operation::Divide(..) => arithmetic(real, operation),
        Operation::Negate(a) => {
            let x = register(*a);
            quote!(-#x)
        }
        Operation::Sqrt(a) => {
            let x = register(*a);
            quote!(s::Number::sqrt(#x))
        }
        Operation::PowerI(a, exponent) => {
            let x = register(*a);
            let exponent = proc_macro2::Literal::i32_unsuffixed(*exponent);
            quote!(s::Number::powi(#x, #exponent))
        }
        Operation::PowerF(a, exponent) => {
            let (x, exponent) = (register(*a), exponent.literal());
            quote!(s::Number::powf(#x, #exponent))
        }
        Operation::Call(function, a) => {
            let (x, name) = (register(*a), format_ident!("{}", function.name()));
            quote!(s::Number::#name(#x))
        }
        Operation::Select(switch, branches) => {
            let switch = register(*switch);
            let branches = branches.iter().map(|&b| register(b));
            quote!(s::choose(#switch, &[#(#branches),*]))
        }
    }
}

/// An operation between two registers. A number type has operations with an `f64` on the right alone, so a real left
/// register changes sides.
fn arithmetic(real: &[bool], operation: &Operation) -> TokenStream {
    let (Operation::Add(a, b)
    | Operation::Subtract(a, b)
    | Operation::Multiply(a, b)
    | Operation::Divide(a, b)) = operation
    else {
        unreachable!("internal error: not an operation between two registers");
    };
    let changes_sides = real[*a] && !real[*b];
    let (x, y) = (register(*a), register(*b));
    if changes_sides {
        match operation {
            Operation::Add(..) => quote!(#y + #x),
            Operation::Subtract(..) => quote!(-#y + #x),
            Operation::Multiply(..) => quote!(#y * #x),
            _ => quote!(s::Number::recip(#y) * #x),
        }
    } else {
        match operation {
            Operation::Add(..) => quote!(#x + #y),
            Operation::Subtract(..) => quote!(#x - #y),
            Operation::Multiply(..) => quote!(#x * #y),
            _ => quote!(#x / #y),
        }
    }
}
