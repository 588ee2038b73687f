//! The identity of this build of the generator: its sources and the contract's.

#[path = "contract/build_identity.rs"]
mod build_identity;

fn main() {
    build_identity::announce(&["src", "contract/src"]);
}
