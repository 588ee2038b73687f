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
    _core,
    InputError,
    PyValueError,
    "A bad parameter, name or spec; of a spec the text names place and expectation."
);
create_exception!(
    _core,
    ComputationError,
    PyRuntimeError,
    "A computation that did not converge, or has no answer."
);

/// The library's error as an exception.
fn raised(error: Error) -> PyErr {
    match error {
        Error::Input(message) => InputError::new_err(message),
        Error::Computation(message) => ComputationError::new_err(message),
    }
}

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    // Parallelism is over points; a matrix belongs to one thread.
    faer::set_global_parallelism(faer::Par::Seq);
    module.add_class::<model::Core>()?;
    module.add("InputError", module.py().get_type::<InputError>())?;
    module.add(
        "ComputationError",
        module.py().get_type::<ComputationError>(),
    )?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    Ok(())
}
