//! The expression graph: hash-consed, exact, deterministic.
//!
//! Every expression of a model is a node of one [`Graph`]; equal expressions are one node, so
//! common subexpressions are shared from the start. Numbers are exact rationals. Constructors keep
//! a canonical form: sums collect equal terms, products collect equal bases, and nothing else is
//! rewritten, so an expression prints as it was derived.

mod algebra;
mod calculus;
mod linear;
mod node;
mod undefined;
mod zero;

pub use calculus::Variable;
pub use linear::LinearSystem;
pub use node::{
    BalanceId, CaseId, FieldId, Function, Jet, LawAtom, LawId, Node, Operator, ParameterId,
    Rational, Table,
};

use std::collections::HashMap;

/// A node of a [`Graph`]; equal expressions of one graph have equal ids.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Id(u32);

impl Id {
    /// Position of the node in creation order.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The arena of all expressions of one model.
#[derive(Default, Clone)]
pub struct Graph {
    nodes: Vec<Node>,
    ids: HashMap<Node, Id>,
    /// Levels of each node down to its leaves.
    depths: Vec<u32>,
    /// Whether each node holds 1/0 or ln 0.
    undefined: Vec<bool>,
    /// Levels of the body of each law.
    law_depths: Vec<u32>,
    /// Terms and factors handled so far.
    work: usize,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// The node behind an id.
    pub fn node(&self, id: Id) -> &Node {
        &self.nodes[id.index()]
    }

    /// Number of distinct expressions met so far.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Terms and factors that constructors have handled: a measure of time spent.
    pub fn work(&self) -> usize {
        self.work
    }

    /// Whether no expression has been made yet.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The id of a node that is already in canonical form.
    pub(crate) fn intern(&mut self, node: Node) -> Id {
        if let Some(&id) = self.ids.get(&node) {
            return id;
        }
        let id = Id(self.nodes.len() as u32);
        let mut below = match &node {
            Node::StateLaw(atom) => self
                .law_depths
                .get(usize::from(atom.law.0))
                .copied()
                .unwrap_or(0),
            _ => 0,
        };
        node.for_each_child(|child| below = below.max(self.depths[child.index()]));
        self.depths.push(below + 1);
        self.undefined.push(self.is_undefined_node(&node));
        self.nodes.push(node.clone());
        self.ids.insert(node, id);
        id
    }

    /// How many nodes lie on the longest way from `id` to a leaf, through the bodies of the laws on it.
    pub fn depth(&self, id: Id) -> usize {
        self.depths[id.index()] as usize
    }

    /// Takes note of how deep the body of the next law is.
    pub(crate) fn declare_law(&mut self, body: Id) {
        self.law_depths.push(self.depths[body.index()]);
    }

    /// Whether any node below `id` (itself included) satisfies `predicate`.
    pub fn any(&self, id: Id, predicate: impl Fn(&Node) -> bool) -> bool {
        let mut seen = vec![false; self.nodes.len()];
        let mut stack = vec![id];
        while let Some(next) = stack.pop() {
            if std::mem::replace(&mut seen[next.index()], true) {
                continue;
            }
            let node = self.node(next);
            if predicate(node) {
                return true;
            }
            node.for_each_child(|child| stack.push(child));
        }
        false
    }

    /// All nodes below `roots`, children before parents, each once.
    pub fn topological(&self, roots: &[Id]) -> Vec<Id> {
        let mut seen = vec![false; self.nodes.len()];
        let mut stack: Vec<Id> = roots.to_vec();
        while let Some(next) = stack.pop() {
            if !std::mem::replace(&mut seen[next.index()], true) {
                self.node(next).for_each_child(|child| stack.push(child));
            }
        }
        // A child is always interned before its parent.
        (0..self.nodes.len())
            .filter(|&i| seen[i])
            .map(|i| Id(i as u32))
            .collect()
    }
}
