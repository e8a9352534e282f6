//! How much a robot's feet slip, by what it feels.

use costs::{
    GAIT_STATISTICS, GaitSample, SlipSense, SlipSenseConfig, gait_statistics as statistics,
};
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyUntypedArrayMethods, ToPyArray,
    ndarray,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::{bad_setting, parse, run};

fn wrong(name: &str, expected: &str, found: &[usize]) -> PyErr {
    PyValueError::new_err(format!("{name} must be {expected}, got {found:?}"))
}

/// (27,) statistics of some ticks of walking, a second or more: turn rates, rad/s, and forces, m/s², of the inertial unit (n, 3), velocities,
/// rad/s, and angles, rad, of the legs' joints (n, 2, 6), left and right, from the hip down.
#[pyfunction]
pub(crate) fn gait_statistics<'py>(
    py: Python<'py>,
    angular_velocity: &Bound<'_, PyArray2<f64>>,
    specific_force: &Bound<'_, PyArray2<f64>>,
    leg_velocities: &Bound<'_, PyArray3<f64>>,
    leg_positions: &Bound<'_, PyArray3<f64>>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let count = angular_velocity.shape()[0];
    for (name, of) in [
        ("angular_velocity", angular_velocity),
        ("specific_force", specific_force),
    ] {
        if of.shape() != [count, 3] {
            return Err(wrong(name, "(n, 3)", of.shape()));
        }
    }
    for (name, of) in [
        ("leg_velocities", leg_velocities),
        ("leg_positions", leg_positions),
    ] {
        if of.shape() != [count, 2, 6] {
            return Err(wrong(name, "(n, 2, 6)", of.shape()));
        }
    }
    let [turns, forces] =
        [angular_velocity, specific_force].map(|of| of.readonly().as_array().to_owned());
    let [speeds, angles] =
        [leg_velocities, leg_positions].map(|of| of.readonly().as_array().to_owned());
    let axes = |of: &ndarray::Array2<f64>, tick: usize| [0, 1, 2].map(|axis| of[[tick, axis]]);
    let joints = |of: &ndarray::Array3<f64>, tick: usize| {
        [0, 1].map(|leg| [0, 1, 2, 3, 4, 5].map(|joint| of[[tick, leg, joint]]))
    };
    let samples: Vec<_> = (0..count)
        .map(|tick| GaitSample {
            angular_velocity_rps: axes(&turns, tick),
            specific_force_mps2: axes(&forces, tick),
            leg_velocities_rps: joints(&speeds, tick),
            leg_positions_rad: joints(&angles, tick),
        })
        .collect();
    let found = statistics(&samples).map_err(|error| bad_setting(py, &error))?;
    Ok(found.to_pyarray(py))
}

/// Tells how fast loaded soles slip, learned from statistics (n, 27) of walks whose slip (n,), m/s, was known. `settings` is JSON:
/// `[costs.slip_sense]`.
#[pyclass(frozen, name = "SlipSense", module = "treadwell._core")]
pub(crate) struct PySlipSense {
    sense: SlipSense,
}

fn rows(array: &Bound<'_, PyArray2<f64>>) -> PyResult<Vec<[f64; GAIT_STATISTICS]>> {
    if array.shape()[1] != GAIT_STATISTICS {
        let expected = format!("(n, {GAIT_STATISTICS})");
        return Err(wrong("statistics", &expected, array.shape()));
    }
    let array = array.readonly();
    let array = array.as_array();
    let row = |row: ndarray::ArrayView1<'_, f64>| std::array::from_fn(|at| row[at]);
    Ok(array.rows().into_iter().map(row).collect())
}

#[pymethods]
impl PySlipSense {
    #[new]
    #[pyo3(signature = (statistics, slip, settings="{}"))]
    fn new(
        py: Python<'_>,
        statistics: &Bound<'_, PyArray2<f64>>,
        slip: &Bound<'_, PyArray1<f64>>,
        settings: &str,
    ) -> PyResult<Self> {
        let config: SlipSenseConfig = parse(py, settings)?;
        if slip.len() != statistics.shape()[0] {
            return Err(wrong("slip", "(n,) as statistics are", slip.shape()));
        }
        let slips = slip.readonly().as_array().to_vec();
        let examples: Vec<_> = rows(statistics)?.into_iter().zip(slips).collect();
        let sense = run(py, || SlipSense::learn(&config, &examples))?;
        let sense = sense.map_err(|error| bad_setting(py, &error))?;
        Ok(Self { sense })
    }

    /// (n,) m/s how fast loaded soles slip where the statistics are (n, 27).
    fn slip<'py>(
        &self,
        py: Python<'py>,
        statistics: &Bound<'_, PyArray2<f64>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let rows = rows(statistics)?;
        let told: Vec<f64> = rows.iter().map(|row| self.sense.slip_mps(row)).collect();
        Ok(told.into_pyarray(py))
    }
}
