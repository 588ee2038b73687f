//! The models of this crate, generated from `models/*.model` and `laws/*.law`.

include!(concat!(env!("OUT_DIR"), "/models.rs"));
