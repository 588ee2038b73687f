//! Studies worked through into figures, data files and a page; pictures and arrays by themselves; the models at hand.
//!
//! [`library`] (built models, and others from their files) → [`reproduce`] (a study file, worked through) →
//! [`figure`] (SVG), [`data`] (npz, NetCDF, VTK).

#![warn(missing_docs)]

pub mod data;
pub mod figure;
pub mod library;
pub mod reproduce;
mod text;

pub(crate) use text::{is_shown, shown, shown_lines};
