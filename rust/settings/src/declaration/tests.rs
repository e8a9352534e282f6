//! The macro, with a table in a table, choices and settings that hold against each other.

use crate::{ANY, ConfigError, POSITIVE, SHARE, Table, Tables, choices, read, require};
use serde_json::json;

/// How a frame may change a voxel.
#[derive(
    Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub(super) enum Update {
    /// Once.
    #[default]
    PerFrame,
    /// By every ray.
    PerPoint,
}

choices!(Update);

settings! {
    /// Numbers that few turn.
    pub(super) struct Inner("navigation.grid.tuning") {
        /// A share of the old.
        nu: f64 = 0.9, "1", SHARE, "000, equation (9)";
        /// Offsets along
        /// both axes.
        offsets: [f32; 2] = [0.0, 0.1], "m", SHARE;
    }
    require (offsets[0]) <= (offsets[1]);
}

settings! {
    /// A grid.
    pub(super) struct Grid("navigation.grid") {
        /// Side of a cell.
        cell: f64 = 0.04, "m", POSITIVE;
        /// Cells along each side.
        cells: usize = 100, "1", crate::within(4.0, 2000.0);
        /// Room above a floor.
        headroom: Option<f64> = None, "m", POSITIVE;
        /// How often a frame may change a voxel.
        update: Update = Update::PerFrame, "-", ANY;
        /// Numbers that few turn.
        tuning: Inner;
        /// Numbers that few turn, of another kind of cell.
        other: Inner = Inner::of_another_kind(), "-", ANY;
    }
    require (tuning.nu) > (other.nu);
    check Grid::fits;
}

impl Inner {
    fn of_another_kind() -> Self {
        Self {
            nu: 0.7,
            ..Self::default()
        }
    }
}

impl Grid {
    fn fits(&self, key: &str) -> Result<(), ConfigError> {
        let size = self.cell * self.cells as f64;
        require(
            size < 100.0,
            &format!("{key}.cells"),
            "less than 100 m",
            size,
        )
    }
}

fn refused(grid: &Grid) -> String {
    grid.check().unwrap_err().to_string()
}

#[test]
fn each_setting_is_refused_by_its_key_with_what_is_allowed() {
    assert_eq!(Grid::default().check(), Ok(()));
    let mut grid = Grid::default();
    grid.tuning.offsets[1] = 1.5;
    let said = "navigation.grid.tuning.offsets.1 must be from 0 to 1, got 1.5";
    assert_eq!(refused(&grid), said);
    let grid = Grid {
        cells: 3,
        ..Grid::default()
    };
    assert_eq!(
        refused(&grid),
        "navigation.grid.cells must be from 4 to 2000, got 3"
    );
    let grid = Grid {
        headroom: Some(f64::NAN),
        ..Grid::default()
    };
    assert_eq!(
        refused(&grid),
        "navigation.grid.headroom must be > 0, got NaN"
    );
    let grid = Grid {
        cell: 1.0,
        ..Grid::default()
    };
    assert_eq!(
        refused(&grid),
        "navigation.grid.cells must be less than 100 m, got 100"
    );
}

#[test]
fn a_setting_that_does_not_fit_another_is_refused_with_the_other() {
    let mut grid = Grid::default();
    grid.tuning.offsets = [0.3, 0.2];
    let said = "navigation.grid.tuning.offsets.0 must be <= offsets.1 (0.2), got 0.3";
    assert_eq!(refused(&grid), said);
    let mut grid = Grid::default();
    grid.tuning.nu = 0.05;
    let said = "navigation.grid.tuning.nu must be > other.nu (0.7), got 0.05";
    assert_eq!(refused(&grid), said);
}

#[test]
fn the_list_says_of_each_what_it_is() {
    let all = Grid::parameters();
    let keys: Vec<_> = all.iter().map(|one| one.key.as_str()).collect();
    assert_eq!(
        keys,
        [
            "navigation.grid.cell",
            "navigation.grid.cells",
            "navigation.grid.headroom",
            "navigation.grid.update",
            "navigation.grid.tuning.nu",
            "navigation.grid.tuning.offsets",
            "navigation.grid.other.nu",
            "navigation.grid.other.offsets",
        ]
    );
    assert_eq!(all[0].default, json!(0.04));
    assert_eq!((all[0].unit, all[0].tuning), ("m", false));
    assert_eq!(all[2].bounds, "> 0, or left out");
    assert_eq!(all[3].bounds, "per_frame, per_point");
    assert_eq!(all[4].source, Some("000, equation (9)"));
    assert!(all[4].tuning);
    assert_eq!(all[5].meaning, "Offsets along both axes.");
    assert_eq!(
        (&all[4].default, &all[6].default),
        (&json!(0.9), &json!(0.7))
    );
    // Not what 32 bits make of it.
    assert_eq!(all[5].default, json!([0.0, 0.1]));
}

#[test]
fn the_schema_holds_tables_within_tables() {
    let schema = crate::TableDescription::of::<Grid>().schema();
    let cell = &schema["properties"]["cell"];
    assert_eq!(cell["minimum"], json!(1e-9));
    assert_eq!(cell["default"], json!(0.04));
    let inner = &schema["properties"]["tuning"]["properties"]["nu"];
    assert_eq!(inner["maximum"], json!(1.0));
    assert_eq!(inner["description"], json!("A share of the old."));
}

#[test]
fn what_a_table_within_a_table_does_not_say_has_its_default() {
    let tables = Tables::from([("grid".to_owned(), json!({"tuning": {"nu": 0.5}}))]);
    let grid: Grid = read(&tables, "grid").unwrap();
    assert_eq!((grid.tuning.nu, grid.tuning.offsets[1]), (0.5, 0.1));
    let tables = Tables::from([("grid".to_owned(), json!({"other": {"offsets": [0.1, 0.2]}}))]);
    let grid: Grid = read(&tables, "grid").unwrap();
    assert_eq!((grid.other.nu, grid.other.offsets[1]), (0.7, 0.2));
    let tables = Tables::from([("grid".to_owned(), json!({"tuning": {"mu": 0.5}}))]);
    let error = read::<Grid>(&tables, "grid").unwrap_err().to_string();
    assert!(error.starts_with("navigation.grid.tuning"), "{error}");
    assert!(error.contains("unknown field `mu`"), "{error}");
}

#[test]
fn what_cannot_be_read_is_refused_by_its_key() {
    for (given, said) in [
        (
            json!({"cell": "a"}),
            "cell: invalid type: string \"a\", expected a number",
        ),
        (
            json!({"cells": 0.5}),
            "cells: invalid type: floating point `0.5`, expected a whole number",
        ),
        (json!({"tuning": 3}), "tuning: expected a table, got 3"),
        (
            json!({"tuning": {"offsets": [1, 2, 3]}}),
            "tuning.offsets: invalid length 3, expected an array of length 2",
        ),
        (
            json!({"tuning": {"offsets": [1, "b"]}}),
            "tuning.offsets[1]: invalid type: string \"b\", expected a number",
        ),
    ] {
        let tables = Tables::from([("grid".to_owned(), given)]);
        let error = read::<Grid>(&tables, "grid").unwrap_err().to_string();
        assert_eq!(error, format!("navigation.grid.{said}"));
    }
}

#[test]
fn what_is_written_is_read_back() {
    let grid = Grid {
        headroom: Some(0.6),
        update: Update::PerPoint,
        ..Grid::default()
    };
    assert_eq!(
        Grid::read_as("navigation.grid", &crate::Setting::written(&grid)),
        Ok(grid)
    );
}
