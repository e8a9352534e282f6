//! All tables of settings: the parts', and those of the stages that are not chosen by name.

use settings::TableDescription;

use crate::parts::components;

/// The tables of the stages that every pilot has.
const STAGES: &[TableDescription] = &[
    TableDescription::of::<proprioception::ProprioceptionConfig>(),
    TableDescription::of::<proprioception::SenseWatchConfig>(),
    TableDescription::of::<sensing::FrameWatchConfig>(),
    TableDescription::of::<sensing::ScanConfig>(),
    TableDescription::of::<sensing::SelfFilterConfig>(),
    TableDescription::of::<crate::PerceptionConfig>(),
    TableDescription::of::<segmentation::GroundConfig>(),
    TableDescription::of::<stairs::StairsConfig>(),
    TableDescription::of::<stairs::ClimbingConfig>(),
    TableDescription::of::<mapping::FeltConfig>(),
    TableDescription::of::<dynamic_scenes::MovingConfig>(),
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

#[cfg(test)]
mod tests {
    use super::*;

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
