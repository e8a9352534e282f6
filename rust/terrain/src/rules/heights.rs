//! Rule: floor that was seen often enough and is not in doubt has the height that it was seen at; nothing else has one.

use mapping::Surface;

use crate::{Sight, Terrain};

pub(super) fn apply(terrain: &mut Terrain, sight: &Sight<'_>) {
    let least = terrain.settings.step_sightings;
    terrain.height_m.clear();
    let view = sight.view;
    terrain.sigma_m.clear();
    (terrain.sigma_m).extend_from_slice(view.sigmas_m.values());
    let cells = view.cells.values().iter().zip(view.sightings.values());
    let cells = cells.zip(&terrain.unknown);
    terrain
        .height_m
        .extend(cells.map(|((surface, &sightings), &unknown)| {
            if let Surface::Floor(height) = surface
                && !unknown
                && sightings >= least
            {
                *height
            } else {
                f32::NAN
            }
        }));
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell};

    #[test]
    fn floor_has_a_height_once_it_was_seen_often_enough() {
        let mut floor = Floor::new();
        floor.paint([0.5, -0.5], [0.6, 0.5], Surface::Floor(0.02));
        floor.paint([0.7, -0.5], [0.8, 0.5], Surface::Obstacle(0.3));
        floor.paint([0.9, -0.5], [1.0, 0.5], Surface::Unknown);
        let seen = floor.after("heights");
        let level_m = |x_m: f64| seen.level_m(cell(&seen, x_m, 0.025));
        assert_eq!(level_m(0.525), Some(f64::from(0.02_f32)));
        assert_eq!((level_m(0.725), level_m(0.925)), (None, None));
        floor.view.sightings.values_mut().fill(2);
        let rarely = floor.after("heights");
        assert!(rarely.height_m.iter().all(|height| height.is_nan()));
    }
}
