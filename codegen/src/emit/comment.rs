//! Comments in emitted code: to which balance the next lines belong.
//!
//! The formatter works on tokens, which hold no comments. A macro carries each comment through it and is then replaced.

use crate::derive::Derivation;
use crate::kernel::{Kernel, ModelKernels};
use landau_contract::KernelId;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::BTreeMap;

/// Comments by the position of the output, or of the register, that they stand above.
pub(super) type Comments = BTreeMap<usize, String>;

/// Comments above outputs of a kernel: for L and L†, the balance or field of the outputs that follow.
pub(super) fn comments(derivation: &Derivation, model: &ModelKernels, id: KernelId) -> Comments {
    let (structure, operators) = (&model.structure, &derivation.operators);
    let mut comments = Comments::new();
    let mut comment = |outputs: &mut dyn Iterator<Item = String>| {
        let mut last = String::new();
        for (output, words) in outputs.enumerate() {
            if words != last {
                comments.insert(output, words.clone());
                last = words;
            }
        }
    };
    let balance = |row| format!("the balance `{}`", structure.balances[row]);
    match id {
        KernelId::Linear => comment(&mut structure.linear.iter().map(|term| balance(term.row))),
        KernelId::Adjoint => comment(&mut structure.adjoint.iter().map(|term| {
            format!(
                "the adjoint equation of `{}`",
                structure.fields[term.row].name
            )
        })),
        KernelId::Divisors => comment(&mut operators.divisors.ids().map(balance)),
        _ => {}
    }
    comments
}

/// The name of the macro that carries a comment through the formatter.
const COMMENT: &str = "landau_comment";

/// Comments in the place of the macros that stand for them: the formatter keeps no comments.
pub(super) fn with_comments(code: &str) -> String {
    let line = |line: &str| {
        let (indent, call) = line.split_once(COMMENT)?;
        let words = call.strip_prefix("!(\"")?.strip_suffix("\");")?;
        Some(format!("{indent}// {words}\n"))
    };
    let lines = code.lines();
    lines
        .map(|text| line(text).unwrap_or_else(|| format!("{text}\n")))
        .collect()
}

pub(super) fn comment(words: &str) -> TokenStream {
    let name = format_ident!("{COMMENT}");
    quote!(#name!(#words);)
}

/// The comments of outputs, each above the first register that no output before it has used.
pub(super) fn registers_of(kernel: &Kernel, comments: &Comments) -> Comments {
    let mut above = Comments::new();
    let mut next = 0;
    let ends: Vec<usize> = comments
        .keys()
        .skip(1)
        .copied()
        .chain([kernel.outputs.len()])
        .collect();
    for ((&start, words), end) in comments.iter().zip(ends) {
        let last = kernel.outputs[start..end].iter().max();
        let Some(&last) = last.filter(|&&last| last >= next) else {
            continue;
        };
        above.insert(next, words.clone());
        next = last + 1;
    }
    above
}
