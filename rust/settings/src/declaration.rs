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
        #[derive(Debug, Clone, PartialEq)]
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

        impl<'de> $crate::serde::Deserialize<'de> for $name {
            fn deserialize<D: $crate::serde::Deserializer<'de>>(given: D) -> Result<Self, D::Error> {
                $crate::table_within(given)
            }
        }

        impl $crate::Setting for $name {
            fn check(&self, key: &str, _: &$crate::Bounds) -> Result<(), $crate::ConfigError> {
                $crate::Table::check_as(self, key)
            }

            fn schema(_: &$crate::Bounds) -> $crate::serde_json::Value {
                $crate::TableDescription::of::<Self>().schema()
            }

            fn over(
                default: Option<&Self>,
                given: &$crate::serde_json::Value,
                key: &str,
            ) -> Result<Self, $crate::MakeError> {
                let mut table = default.cloned().unwrap_or_default();
                for (name, given) in $crate::entries(given, key)? {
                    let key = &$crate::key_of(key, name);
                    match name.as_str() {
                        $(stringify!($field) => {
                            table.$field = $crate::Setting::over(Some(&table.$field), given, key)?;
                        })*
                        _ => return Err($crate::unknown(key, name, &[$(stringify!($field)),*])),
                    }
                }
                Ok(table)
            }

            fn written(&self) -> $crate::serde_json::Value {
                let settings = [$((stringify!($field), $crate::Setting::written(&self.$field))),*];
                settings.into_iter().collect()
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
mod tests;
