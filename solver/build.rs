//! The identity of this build of the solver: its sources and the contract's.

#[path = "../codegen/contract/build_identity.rs"]
mod build_identity;

fn main() {
    build_identity::announce(&["src", "../codegen/contract/src"]);
}
