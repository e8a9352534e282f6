//! What is learned of the ground: weights of costs from ways, and a number from a few others.

use costs::{Features, LocalRegression, LocalRegressionConfig, PathWeights, PathWeightsConfig};
use geometry::{Cell, Grid};
use nalgebra::DVector;
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyUntypedArrayMethods, ToPyArray,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::costs::array;
use crate::error::{bad_setting, parse, run};

/// A number learned online from others, by local linear models; `prior` is told where nothing was learned. `settings` is JSON:
/// `[costs.local_regression]`.
#[pyclass(name = "LocalRegression", module = "treadwell._core")]
pub(crate) struct PyLocalRegression {
    learned: LocalRegression,
}

fn values(array: &Bound<'_, PyArray1<f64>>) -> Vec<f64> {
    array.readonly().as_array().to_vec()
}

#[pymethods]
impl PyLocalRegression {
    #[new]
    #[pyo3(signature = (inputs, prior=0.0, settings="{}"))]
    fn new(py: Python<'_>, inputs: usize, prior: f64, settings: &str) -> PyResult<Self> {
        let config: LocalRegressionConfig = parse(py, settings)?;
        let learned = LocalRegression::new(config, inputs, prior);
        let learned = learned.map_err(|error| bad_setting(py, &error))?;
        Ok(Self { learned })
    }

    /// Learns what the number was, (n,), where the inputs were (n, inputs), one after the other.
    fn learn(
        &mut self,
        py: Python<'_>,
        inputs: &Bound<'_, PyArray2<f64>>,
        measured: &Bound<'_, PyArray1<f64>>,
    ) -> PyResult<()> {
        if inputs.shape()[0] != measured.len() {
            return Err(PyValueError::new_err(format!(
                "inputs must be (n, inputs) and measured (n,), got {:?} and {:?}",
                inputs.shape(),
                measured.shape()
            )));
        }
        for (row, measured) in inputs
            .readonly()
            .as_array()
            .rows()
            .into_iter()
            .zip(values(measured))
        {
            let learned = self.learned.learn(&row.to_vec(), measured);
            learned.map_err(|error| bad_setting(py, &error))?;
        }
        Ok(())
    }

    /// What the number is thought to be, (n,), where the inputs are (n, inputs); and on how many measurements that rests, (n,).
    #[expect(clippy::type_complexity, reason = "two arrays")]
    fn predict<'py>(
        &self,
        py: Python<'py>,
        inputs: &Bound<'_, PyArray2<f64>>,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>)> {
        let mut told = [Vec::new(), Vec::new()];
        for row in inputs.readonly().as_array().rows() {
            let one = self.learned.predict(&row.to_vec());
            let one = one.map_err(|error| bad_setting(py, &error))?;
            told[0].push(one.value);
            told[1].push(one.support);
        }
        let [value, support] = told.map(|all| all.into_pyarray(py));
        Ok((value, support))
    }
}

/// Weights of features that make costs, learned from ways; to begin with, `weights` (features,). `settings` is JSON:
/// `[costs.path_weights]`.
#[pyclass(name = "PathWeights", module = "treadwell._core")]
pub(crate) struct PyPathWeights {
    learned: PathWeights,
}

/// Features of cells; those of a cell in which one is NaN are none.
fn features(array: &Bound<'_, PyArray3<f64>>) -> Features {
    let array = array.readonly();
    let array = array.as_array();
    let (rows, cols, _) = array.dim();
    let mut features = Grid::filled(cols, rows, None);
    for (one, of) in (features.values_mut().iter_mut()).zip(array.rows()) {
        let known = of.iter().all(|value| !value.is_nan());
        *one = known.then(|| DVector::from_iterator(of.len(), of.iter().copied()));
    }
    features
}

#[pymethods]
impl PyPathWeights {
    #[new]
    #[pyo3(signature = (weights, settings="{}"))]
    fn new(py: Python<'_>, weights: &Bound<'_, PyArray1<f64>>, settings: &str) -> PyResult<Self> {
        let config: PathWeightsConfig = parse(py, settings)?;
        let learned = PathWeights::new(config, &values(weights));
        let learned = learned.map_err(|error| bad_setting(py, &error))?;
        Ok(Self { learned })
    }

    /// (features,) the weights as they are now.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.learned.weights().to_pyarray(py)
    }

    /// (rows, cols) what a metre costs in each cell by `features` (rows, cols, features); infinite where one of them is NaN.
    fn costs<'py>(
        &self,
        py: Python<'py>,
        features: &Bound<'_, PyArray3<f64>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let of = self::features(features);
        let costs = run(py, || self.learned.costs(&of))?;
        let costs = costs.map_err(|error| bad_setting(py, &error))?;
        Ok(array(py, &costs))
    }

    /// Learns from a way that was shown, (n, 2) rows and columns, over `features` (rows, cols, features) of cells of `cell` m. Says how much
    /// dearer it seemed than the best other one.
    fn learn_shown(
        &mut self,
        py: Python<'_>,
        features: &Bound<'_, PyArray3<f64>>,
        way: &Bound<'_, PyArray2<i64>>,
        cell: f64,
    ) -> PyResult<f64> {
        if way.shape()[1] != 2 {
            return Err(PyValueError::new_err(format!(
                "way must be (n, 2), got {:?}",
                way.shape()
            )));
        }
        let of = self::features(features);
        let way: Vec<_> = (way.readonly().as_array().rows().into_iter())
            .map(|row| Cell::new(row[1] as i32, row[0] as i32))
            .collect();
        let learned = run(py, || self.learned.learn_shown(&of, &way, cell))?;
        learned.map_err(|error| bad_setting(py, &error))
    }

    /// Learns that a place with features `better` (features,) turned out better than one with `worse`, which should cost more by `margin` in
    /// logarithms. Says whether it did not yet.
    fn prefer(
        &mut self,
        py: Python<'_>,
        better: &Bound<'_, PyArray1<f64>>,
        worse: &Bound<'_, PyArray1<f64>>,
        margin: f64,
    ) -> PyResult<bool> {
        let [better, worse] = [better, worse].map(|one| DVector::from_vec(values(one)));
        let learned = self.learned.prefer(&better, &worse, margin);
        learned.map_err(|error| bad_setting(py, &error))
    }
}
