//! The extension module `stuart_landau._core`: models, and the library's answers as the JSON that the command line
//! prints. Classes, arrays and pictures are made of it in Python.

mod model;
mod studies;
mod watch;

use landau_solver::error::Error;
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    stuart_landau,
    InputError,
    PyValueError,
    "A bad parameter, name or spec; of a spec the text names place and expectation."
);
create_exception!(
    stuart_landau,
    ComputationError,
    PyRuntimeError,
    "A computation that did not converge, or has no answer."
);

/// The library's error as an exception.
fn raised(error: Error) -> PyErr {
    match error {
        Error::Input(message) => InputError::new_err(message),
        error => ComputationError::new_err((error.to_string(), error.kind())),
    }
}

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<model::Core>()?;
    module.add("InputError", module.py().get_type::<InputError>())?;
    module.add(
        "ComputationError",
        module.py().get_type::<ComputationError>(),
    )?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    Ok(())
}
