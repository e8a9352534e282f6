//! What there is to choose from and to set: the components and the tables of settings.

use pyo3::prelude::*;
use robot::Description;
use settings::{Scale, TableDescription};

use crate::error::parse;

/// A row of `components`.
type Row = (
    &'static str,
    &'static str,
    &'static str,
    Option<&'static str>,
    Vec<&'static str>,
);

/// Slot, name, one line and paper of each component that a name stands for, and the names of its tables, as in `fog` of `[navigation.fog]`.
#[pyfunction]
pub(crate) fn components() -> Vec<Row> {
    let all = pilot::components().into_iter();
    all.map(|(slot, one)| {
        let tables = one.tables.iter().map(last_word).collect();
        (slot, one.name, one.about, one.source, tables)
    })
    .collect()
}

/// The names of the tables of settings, as in `fog` of `[navigation.fog]`, and `gait`.
#[pyfunction]
pub(crate) fn tables() -> Vec<&'static str> {
    pilot::tables().iter().map(last_word).collect()
}

fn last_word(table: &TableDescription) -> &'static str {
    let key = table.key;
    key.rsplit_once('.').map_or(key, |(_, name)| name)
}

/// All tables of settings as JSON, those of what is not part of a run as well: key, about, parameters, schema; with the defaults that
/// follow from the size of a robot, of which a description is given as JSON.
#[pyfunction]
#[pyo3(signature = (description_json=None))]
pub(crate) fn parameters(py: Python<'_>, description_json: Option<&str>) -> PyResult<String> {
    let robot: Option<Description> = description_json.map(|json| parse(py, json)).transpose()?;
    let size = robot.map_or(Scale::ONE, |robot| robot.size());
    let mut all = pilot::tables();
    all.extend_from_slice(classification::TABLES);
    all.extend_from_slice(costs::TABLES);
    all.extend_from_slice(plan_view::TABLES);
    all.extend_from_slice(scan_matching::TABLES);
    all.extend_from_slice(dynamic_scenes::TABLES);
    all.extend_from_slice(landmarks::TABLES);
    let all: Vec<_> = all
        .iter()
        .map(|table| {
            let mut parameters = table.parameters();
            for one in &mut parameters {
                one.default = size.default_of(one).unwrap_or_else(|| one.default.take());
            }
            serde_json::json!({
                "key": table.key,
                "about": table.about,
                "parameters": parameters,
                "schema": table.schema(),
            })
        })
        .collect();
    Ok(serde_json::Value::from(all).to_string())
}
