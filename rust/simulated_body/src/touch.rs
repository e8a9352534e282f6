//! What the robot truly touches: contacts sorted into soles that stand, parts that lie, and touches of the course's elements.

/// What the geoms of a course are, by their numbers, and how touches are told apart.
#[derive(Debug, Clone)]
pub struct Surfaces {
    /// Of each geom.
    pub geoms: Vec<GeomKind>,
    /// Least z of the normal, from the floor up, with which a sole stands on a walkable top.
    pub sole_on_top: f64,
    /// Least z with which any other part lies on one: to lean on an edge is a collision, to lie on a top is a fall.
    pub lies_on_top: f64,
}

/// What a geom belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GeomKind {
    /// The left (0) or the right (1) sole's link.
    Foot(usize),
    /// Any other part of the robot.
    Part,
    /// The ground, which is walked on.
    Ground,
    /// An element of the course, and whether it is walked on.
    Element {
        /// Whether it is walked on.
        walkable: bool,
    },
}

/// A contact of two geoms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Numbers of the geoms.
    pub geoms: [usize; 2],
    /// Upward part of the normal, which points from the first geom to the second.
    pub up: f64,
}

/// What is touched.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Touches {
    /// Whether the left and the right sole stand on a floor.
    pub standing: [bool; 2],
    /// A geom other than a sole's that lies on a floor.
    pub lying: Option<usize>,
    /// Of each touch of an element its number among the contacts, the robot's geom and the element's.
    pub hits: Vec<[usize; 3]>,
}

impl Surfaces {
    /// Sorts contacts. One of a geom that is not known is left out.
    pub fn sort(&self, contacts: impl Iterator<Item = Contact>) -> Touches {
        let mut touches = Touches::default();
        for (index, contact) in contacts.enumerate() {
            let [first, second] = contact.geoms;
            let (Some(&one), Some(&other)) = (self.geoms.get(first), self.geoms.get(second)) else {
                continue;
            };
            // The simulator's normal points from the first geom to the second; ours points to the robot.
            match (one.is_robot(), other.is_robot()) {
                (true, false) => self.add(
                    &mut touches,
                    [index, first, second],
                    [one, other],
                    -contact.up,
                ),
                (false, true) => self.add(
                    &mut touches,
                    [index, second, first],
                    [other, one],
                    contact.up,
                ),
                (true, true) | (false, false) => {}
            }
        }
        touches
    }

    fn add(&self, touches: &mut Touches, hit: [usize; 3], [ours, theirs]: [GeomKind; 2], up: f64) {
        if theirs.is_walkable() && up > self.sole_on_top {
            if let GeomKind::Foot(side) = ours {
                touches.standing[side.min(1)] = true;
                return;
            }
            if touches.lying.is_none() && (theirs == GeomKind::Ground || up > self.lies_on_top) {
                touches.lying = Some(hit[1]);
            }
        }
        if matches!(theirs, GeomKind::Element { .. }) {
            touches.hits.push(hit);
        }
    }
}

impl GeomKind {
    const fn is_robot(self) -> bool {
        matches!(self, Self::Foot(_) | Self::Part)
    }

    const fn is_walkable(self) -> bool {
        matches!(self, Self::Ground | Self::Element { walkable: true })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GROUND: usize = 0;
    const LEFT: usize = 1;
    const RIGHT: usize = 2;
    const ARM: usize = 3;
    const STEP: usize = 4;
    const BOX: usize = 5;

    fn sort(contacts: &[([usize; 2], f64)]) -> Touches {
        let surfaces = Surfaces {
            geoms: vec![
                GeomKind::Ground,
                GeomKind::Foot(0),
                GeomKind::Foot(1),
                GeomKind::Part,
                GeomKind::Element { walkable: true },
                GeomKind::Element { walkable: false },
            ],
            sole_on_top: 0.7,
            lies_on_top: 0.9,
        };
        let contacts = contacts.iter().map(|&(geoms, up)| Contact { geoms, up });
        surfaces.sort(contacts)
    }

    #[test]
    fn a_sole_on_a_floor_stands_whichever_geom_comes_first() {
        let touches = sort(&[([GROUND, LEFT], 1.0), ([RIGHT, STEP], -1.0)]);
        assert_eq!(touches.standing, [true, true]);
        assert_eq!((touches.lying, touches.hits), (None, vec![]));
    }

    #[test]
    fn a_part_that_lies_has_fallen_and_one_that_leans_on_an_edge_has_hit_it() {
        assert_eq!(sort(&[([GROUND, ARM], 0.8)]).lying, Some(ARM));
        let leaning = sort(&[([STEP, ARM], 0.8)]);
        assert_eq!((leaning.lying, leaning.hits), (None, vec![[0, ARM, STEP]]));
        let lying = sort(&[([STEP, ARM], 0.95)]);
        assert_eq!((lying.lying, lying.hits), (Some(ARM), vec![[0, ARM, STEP]]));
    }

    #[test]
    fn a_riser_and_a_box_are_hit_and_the_robot_does_not_hit_itself() {
        let touches = sort(&[
            ([LEFT, RIGHT], 0.0),
            ([STEP, LEFT], 0.1),
            ([ARM, BOX], -1.0),
            ([BOX, STEP], 1.0),
            ([9, LEFT], 1.0),
        ]);
        assert_eq!(touches.standing, [false, false]);
        assert_eq!(touches.hits, vec![[1, LEFT, STEP], [2, ARM, BOX]]);
    }
}
