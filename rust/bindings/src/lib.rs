//! The Python module `treadwell._core`: converts and forwards, decides nothing. One file a class.

mod error;
mod observation;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    use pyo3::prelude::*;

    /// Version of the core; equal to the package's.
    #[pyfunction]
    fn version() -> &'static str {
        env!("CARGO_PKG_VERSION")
    }
}
