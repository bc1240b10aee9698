//! The core of the Python package: the engine behind a few functions and three classes.
//!
//! Nothing is decided here: a question goes in as texts, an answer comes out as the document that the program writes. What
//! people see is written in Python, in the folder `jurist`.

#![deny(unsafe_code, missing_docs)]

mod errors;
mod model;
mod pool;
mod program;
mod question;
mod real;
mod wait;

use pyo3::prelude::*;

/// The module `jurist._jurist`.
#[pymodule(gil_used = false)]
mod _jurist {
    use super::*;

    #[pymodule_export]
    use super::model::{Answered, Model};
    #[pymodule_export]
    use super::pool::{renew_threads, set_threads, threads};
    #[pymodule_export]
    use super::program::{check, codes, defect, program, words};
    #[pymodule_export]
    use super::real::Algebraic;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        // A panic becomes an exception with the same words; printing them too would say everything twice.
        std::panic::set_hook(Box::new(|_| {}));
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
