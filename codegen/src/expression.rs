//! Expressions of the spec language that are wanted beside a model: read, opened, lowered to a kernel.

use crate::derive::Opener;
use crate::diagnostic::{Diagnostic, Diagnostics, Location, SourceFile};
use crate::graph::{Node, Operator};
use crate::kernel::{Lowering, jets};
use crate::model::resolve;
use crate::sources::Sources;
use landau_contract::{Expression, RESIDUAL_INPUTS, StateLayout};

/// Compiles an expression in the names of a spec, for a model whose point state is laid out so.
///
/// # Errors
/// Mistakes of the expression; one that holds a time derivative, or a value of the base state by name.
pub fn compile(
    sources: &Sources,
    state: StateLayout,
    text: &str,
) -> Result<Expression, Diagnostics> {
    let (mut graph, mut model) = resolve(sources)?;
    let source = SourceFile {
        path: "expression".to_owned(),
        text: text.to_owned(),
    };
    let id = model.read(&mut graph, &source, &[])?;
    let refuse = |message: &str, expected: &str| {
        let place = Location {
            file: 0,
            range: 0..text.len(),
        };
        Diagnostics {
            files: vec![source.clone()],
            list: vec![Diagnostic::new(place, message, expected)],
        }
    };
    let graph = &mut graph;
    let moves = |node: &Node| matches!(node, Node::Derivative(Operator::Dt, _));
    if graph.any(id, moves) {
        let expected = "fields and their derivatives in space";
        return Err(refuse("a time derivative has no place here", expected));
    }
    let base = |node: &Node| {
        let base = matches!(node, Node::Base(..) | Node::BaseLaw(_));
        base || matches!(node, Node::Symbol(..))
    };
    if graph.any(id, base) {
        let expected = "fields, laws and parameters by their names";
        return Err(refuse(
            "a symbol of the base state has no place here",
            expected,
        ));
    }
    let uniform = model.fields.map(|f| f.uniform);
    let opened = Opener::new(&model.laws, &model.base.closed, &uniform).at_state(graph, id);
    let jets = jets(graph, &[opened]);
    let locate = |node: &Node| match node {
        Node::Coordinate => Some((0, state.coordinate())),
        Node::Wavenumber => Some((0, state.wavenumber())),
        Node::Parameter(id) => Some((0, state.parameter(*id))),
        Node::Jet(jet) => jets.iter().position(|j| j == jet).map(|p| (1, p)),
        _ => None,
    };
    let lowering = Lowering {
        inputs: RESIDUAL_INPUTS.to_vec(),
        locate: &locate,
    };
    Ok(Expression {
        written: text.trim().to_owned(),
        kernel: lowering.lower(graph, &[opened]),
        jets,
    })
}
