//! MuJoCo's functions, found in the library that its Python package has loaded.

use std::ffi::c_void;
use std::path::PathBuf;

use pyo3::exceptions::PyImportError;
use pyo3::prelude::*;

/// `void mj_step1(const mjModel* m, mjData* d)`, and `mj_step2` alike.
pub(crate) type HalfStep = unsafe extern "C" fn(*const c_void, *mut c_void);

/// The two halves of a physics step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Library {
    /// From positions and velocities to all that follows from them.
    pub(crate) step1: HalfStep,
    /// From controls to the next positions and velocities.
    pub(crate) step2: HalfStep,
}

impl Library {
    /// The functions of the loaded library; `ctypes` finds it by the path that the package has it under, and loads nothing twice.
    pub(crate) fn of_package(py: Python<'_>) -> PyResult<Self> {
        let path = path(py)?;
        let ctypes = py.import("ctypes")?;
        let library = ctypes.call_method1("CDLL", (path.to_string_lossy(),))?;
        let address = |name: &str| -> PyResult<usize> {
            let kind = ctypes.getattr("c_void_p")?;
            ctypes
                .call_method1("cast", (library.getattr(name)?, kind))?
                .getattr("value")?
                .extract()
        };
        Ok(Self {
            step1: step(address("mj_step1")?)?,
            step2: step(address("mj_step2")?)?,
        })
    }
}

/// Where the package keeps its library.
fn path(py: Python<'_>) -> PyResult<PathBuf> {
    let file: PathBuf = py.import("mujoco")?.getattr("__file__")?.extract()?;
    let folder = file.parent().unwrap_or(&file);
    let is_library = |name: &str| name.starts_with("libmujoco") || name == "mujoco.dll";
    folder
        .read_dir()?
        .filter_map(Result::ok)
        .find(|entry| is_library(&entry.file_name().to_string_lossy()))
        .map(|entry| entry.path())
        .ok_or_else(|| {
            PyImportError::new_err(format!("{}: has no MuJoCo library", folder.display()))
        })
}

/// The function at an address.
fn step(address: usize) -> PyResult<HalfStep> {
    if address == 0 {
        return Err(PyImportError::new_err(
            "MuJoCo's library lacks mj_step1 or mj_step2",
        ));
    }
    // SAFETY: the address is that of `mj_step1` or `mj_step2` in the library that stays loaded as long as the process lives; both are
    // `void (const mjModel*, mjData*)` in every version of MuJoCo, and an address that is not 0 is a valid function pointer.
    Ok(unsafe { std::mem::transmute::<*const c_void, HalfStep>(address as *const c_void) })
}
