//! All tables of settings: the parts', and those of the stages that are not chosen by name.

use settings::{Scale, TableDescription, Tables, overlay};

use crate::parts::components;

/// The tables of the stages that every pilot has.
const STAGES: &[TableDescription] = &[
    TableDescription::of::<proprioception::ProprioceptionConfig>(),
    TableDescription::of::<proprioception::SenseWatchConfig>(),
    TableDescription::of::<sensing::FrameWatchConfig>(),
    TableDescription::of::<sensing::SceneWatchConfig>(),
    TableDescription::of::<sensing::ScanConfig>(),
    TableDescription::of::<sensing::SelfFilterConfig>(),
    TableDescription::of::<crate::PerceptionConfig>(),
    TableDescription::of::<segmentation::GroundConfig>(),
    TableDescription::of::<stairs::StairsConfig>(),
    TableDescription::of::<stairs::ClimbingConfig>(),
    TableDescription::of::<mapping::FeltConfig>(),
    TableDescription::of::<mapping::ChangingConfig>(),
    TableDescription::of::<dynamic_scenes::MovingConfig>(),
    TableDescription::of::<behaviour::GivingWayConfig>(),
    TableDescription::of::<planning::TerrainConfig>(),
    TableDescription::of::<known_map::KnownMapConfig>(),
    TableDescription::of::<walking::GaitConfig>(),
];

/// Every table once, those of the stages first.
pub fn tables() -> Vec<TableDescription> {
    let mut all = STAGES.to_vec();
    for table in components().iter().flat_map(|(_, part)| part.tables) {
        if !all.iter().any(|other| other.key == table.key) {
            all.push(*table);
        }
    }
    all
}

/// The tables that were given, for a robot of that size: what they do not say has the default of such a robot.
pub fn sized(given: &Tables, scale: &Scale) -> Tables {
    let mut all = given.clone();
    if *scale == Scale::ONE {
        return all;
    }
    for table in tables() {
        let Some(name) = table.key.strip_prefix("navigation.") else {
            continue;
        };
        let mut settings = table.defaults_at(scale);
        if let Some(given) = given.get(name) {
            overlay(&mut settings, given);
        }
        drop(all.insert(name.to_owned(), settings));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Components, Pilot, Settings};
    use proptest::prelude::*;
    use serde_json::{Value, json};
    use std::sync::Arc;
    use volume::octree::{Octree, OctreeConfig};

    /// Settings of a pilot with the usual components but for one.
    fn with_component(slot: &str, name: &str) -> Value {
        let mut settings = json!({
            "robot": testkit::biped().description(),
            "start": {"position": [0.0, 0.0], "height": 0.0, "yaw": 0.0},
            "goals": [{"position": [1.0, 0.0], "radius": 0.1}],
            "navigation": {
                "world_model": "fog", "segmenter": "scan_line", "localizer": "odometry",
                "planner": "a_star", "behaviour": "stair_climbing", "walker": "dcm",
            },
        });
        settings["navigation"][slot] = json!(name);
        settings
    }

    #[test]
    fn a_part_reads_no_table_that_it_does_not_list() {
        let mut map = Octree::new(OctreeConfig::default()).unwrap();
        let _beyond = map.occupy(&[[0.1, 0.0, -0.1]]).unwrap();
        let map = Arc::new(map);
        let all = components();
        for &(slot, part) in &all {
            let mut settings = with_component(slot, part.name);
            let navigation = &settings["navigation"];
            let chosen = |of: &str, name: &str| navigation[of] == json!(name);
            let listed: Vec<_> = (all.iter())
                .filter(|(of, one)| chosen(of, one.name))
                .flat_map(|(_, one)| one.tables)
                .chain(STAGES)
                .map(|table| table.key)
                .collect();
            for table in tables().iter().filter(|table| !listed.contains(&table.key)) {
                let name = table.key.trim_start_matches("navigation.");
                settings["navigation"][name] = json!("what no table can be");
            }
            let settings: Settings = serde_json::from_value(settings).unwrap();
            let made = Pilot::new(&settings, Some(&map), Components::default());
            assert!(
                made.is_ok(),
                "{} {}: {}",
                slot,
                part.name,
                made.err().unwrap()
            );
        }
    }

    #[test]
    fn every_unit_is_known_and_at_the_size_of_the_defaults_nothing_changes() {
        let ten = Scale {
            length: 10.0,
            mass: 1000.0,
            disparity: 10.0,
            period: 1.0,
        };
        for table in tables() {
            for one in table.parameters() {
                let known = one.unit.split(", ").all(|unit| ten.factor(unit).is_some());
                assert!(known, "{}: {}", one.key, one.unit);
                assert_eq!(Scale::ONE.default_of(&one), None, "{}", one.key);
            }
            assert_eq!(table.defaults_at(&Scale::ONE), json!({}));
        }
        let given = Tables::from([("fog".to_owned(), json!({"cell": 0.05}))]);
        assert_eq!(sized(&given, &Scale::ONE), given);
    }

    #[test]
    fn what_was_given_lies_over_what_follows_from_the_size() {
        let two = Scale {
            length: 2.0,
            mass: 8.0,
            disparity: 2.0,
            period: 1.0,
        };
        let given = Tables::from([
            ("fog".to_owned(), json!({"cell": 0.05})),
            ("elsewhere".to_owned(), json!({"cell": 0.05})),
        ]);
        let sized = sized(&given, &two);
        assert_eq!(sized["fog"]["cell"], json!(0.05));
        assert_eq!(sized["fog"]["layer"], json!(0.08));
        assert_eq!(sized["fog"].get("max_range"), None);
        let of_view = &sized["stairs"]["tuning"]["view"];
        assert_eq!(of_view["height_noise"], json!(0.0125));
        assert_eq!(
            sized["walking"]["forward_speed"],
            json!(0.1 * 2.0_f64.sqrt())
        );
        assert_eq!(sized["elsewhere"], given["elsewhere"]);
    }

    proptest! {
        #[test]
        fn the_defaults_of_every_size_hold_their_bounds_and_each_other(length in 0.5..5.0, density in 0.3..3.0) {
            let scale = Scale { length, mass: density * length.powi(3), disparity: density, period: density };
            for table in tables() {
                let defaults = table.defaults_at(&scale);
                let usable = table.check(&defaults);
                let unset = table.key == "gait"; // Width and height of the stance are the body's.
                let said = usable.err().map(|error| error.to_string()).unwrap_or_default();
                prop_assert!(said.is_empty() || unset && said.contains("stance_width"), "{} at {}: {}", table.key, length, said);
            }
        }
    }

    #[test]
    fn every_setting_has_a_meaning_that_is_a_sentence_and_one_key() {
        let all: Vec<_> = tables()
            .iter()
            .flat_map(settings::TableDescription::parameters)
            .collect();
        for one in &all {
            let begins = one
                .meaning
                .starts_with(|c: char| c.is_uppercase() || "`0123456789".contains(c));
            assert!(
                begins && one.meaning.ends_with('.'),
                "{}: {}",
                one.key,
                one.meaning
            );
            assert!(
                !one.unit.is_empty() && !one.bounds.is_empty(),
                "{}",
                one.key
            );
        }
        let mut keys: Vec<_> = all.iter().map(|one| one.key.as_str()).collect();
        keys.sort_unstable();
        let before = keys.len();
        keys.dedup();
        assert_eq!(keys.len(), before);
    }
}
