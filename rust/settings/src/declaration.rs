//! The macro that declares a table of settings: struct, defaults, bounds and meaning in one place.

/// Declares a struct of settings: one doc comment, and one line `name: type = default, unit, bounds, source;` a setting.
///
/// The doc comment is the meaning that users read. The unit is SI (`"m"`, `"rad"`, `"s"`), `"1"` for a number without one, `"-"` for
/// what is no number. Bounds are constants and functions of this crate ([`crate::POSITIVE`], [`crate::within`]). The source is paper
/// and equation and may be left out. What follows the robot's size by its unit ([`crate::Scale`]) says nothing of it; what is the
/// camera's, a sensor's, the world's or the computation's says that behind the unit: `"m" of camera`. A line `name: type;` holds a table within the table; `name: type = value, "-", ANY;` holds one
/// whose defaults are those of the value. A line `require (name) < (other);` behind the struct holds two settings against each other,
/// also parts of one or of a table within (`require (gaze.steep) >= (range[0]);`); what takes more to tell is checked by the function behind `check`.
///
/// ```
/// use settings::{POSITIVE, Table, settings, within};
///
/// settings! {
///     /// How the robot walks.
///     pub struct Walking("navigation.walking") {
///         /// Speed straight ahead.
///         forward_speed: f64 = 0.08, "m/s", POSITIVE;
///         /// A turn on the spot begins above this bearing.
///         turn_above: f64 = 0.5, "rad", within(0.0, 3.2), "005, equation (3)";
///         /// A turn on the spot ends below this bearing.
///         turn_until: f64 = 0.2, "rad", within(0.0, 3.2);
///     }
///     require (turn_until) < (turn_above);
/// }
///
/// assert_eq!(Walking::default().check(), Ok(()));
/// let slow = Walking { forward_speed: 0.0, ..Walking::default() };
/// let said = slow.check().unwrap_err().to_string();
/// assert_eq!(said, "navigation.walking.forward_speed must be > 0, got 0");
/// let never = Walking { turn_until: 0.7, ..Walking::default() };
/// let said = never.check().unwrap_err().to_string();
/// assert_eq!(said, "navigation.walking.turn_until must be < turn_above (0.5), got 0.7");
/// ```
#[macro_export]
macro_rules! settings {
    (
        $(#[doc = $about:literal])*
        $vis:vis struct $name:ident($key:literal) {
            $(
                $(#[doc = $meaning:literal])*
                $field:ident: $type:ty
                    $(= $default:expr, $unit:literal $(of $owner:ident)?, $bounds:expr $(, $source:literal)?)?;
            )*
        }
        $(require ($($one:tt)+) $than:tt ($($other:tt)+);)*
        $(check $relations:path;)?
    ) => {
        $(#[doc = $about])*
        #[derive(Debug, Clone, PartialEq, $crate::serde::Serialize, $crate::serde::Deserialize)]
        #[serde(crate = "settings::serde", deny_unknown_fields, default)]
        $vis struct $name {
            $(
                $(#[doc = $meaning])*
                pub $field: $type,
            )*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $crate::default_of!($($default)?),)* }
            }
        }

        impl $crate::Table for $name {
            const KEY: &'static str = $key;
            const ABOUT: &'static str = concat!($($about),*);

            fn check_as(&self, key: &str) -> Result<(), $crate::ConfigError> {
                $(
                    $crate::Setting::check(
                        &self.$field,
                        &$crate::key_of(key, stringify!($field)),
                        &$crate::bounds_of!($($bounds)?),
                    )?;
                )*
                $(
                    $crate::require_fit(
                        self.$($one)+ $than self.$($other)+,
                        key,
                        [stringify!($($one)+), stringify!($than), stringify!($($other)+)],
                        [&self.$($one)+, &self.$($other)+],
                    )?;
                )*
                $($relations(self, key)?;)?
                Ok(())
            }

            fn parameters_as(&self, key: &str) -> Vec<$crate::Parameter> {
                let mut all = Vec::new();
                $(
                    $crate::describe(
                        &mut all,
                        &self.$field,
                        $crate::Declared {
                            key: $crate::key_of(key, stringify!($field)),
                            unit: $crate::unit_of!($($unit)?),
                            bounds: $crate::bounds_of!($($bounds)?),
                            meaning: concat!($($meaning),*),
                            source: $crate::source_of!($($($source)?)?),
                            owner: $crate::owner_of!($($($owner)?)?),
                        },
                    );
                )*
                all
            }
        }

        impl $crate::Setting for $name {
            fn check(&self, key: &str, _: &$crate::Bounds) -> Result<(), $crate::ConfigError> {
                $crate::Table::check_as(self, key)
            }

            fn schema(_: &$crate::Bounds) -> $crate::serde_json::Value {
                $crate::TableDescription::of::<Self>().schema()
            }

            fn parameters(&self, key: &str) -> Option<Vec<$crate::Parameter>> {
                Some($crate::Table::parameters_as(self, key))
            }
        }
    };
}

/// The default of a setting: that of its type, where it is a table.
#[doc(hidden)]
#[macro_export]
macro_rules! default_of {
    () => {
        Default::default()
    };
    ($default:expr) => {
        $default
    };
}

/// The bounds of a setting.
#[doc(hidden)]
#[macro_export]
macro_rules! bounds_of {
    () => {
        $crate::ANY
    };
    ($bounds:expr) => {
        $bounds
    };
}

/// The unit of a setting.
#[doc(hidden)]
#[macro_export]
macro_rules! unit_of {
    () => {
        "-"
    };
    ($unit:literal) => {
        $unit
    };
}

/// Whose a setting is that does not follow the robot's size.
#[doc(hidden)]
#[macro_export]
macro_rules! owner_of {
    () => {
        None
    };
    (camera) => {
        Some($crate::Owner::Camera)
    };
    (sensor) => {
        Some($crate::Owner::Sensor)
    };
    (world) => {
        Some($crate::Owner::World)
    };
    (numerics) => {
        Some($crate::Owner::Numerics)
    };
}

/// The paper and equation of a setting.
#[doc(hidden)]
#[macro_export]
macro_rules! source_of {
    () => {
        None
    };
    ($source:literal) => {
        Some($source)
    };
}

#[cfg(test)]
mod tests {
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
}
