//! Rooms, and the doorways between them: where the diagram passes the narrowest places, as of Thrun's critical points (1998).

use geometry::Grid;

use super::VoronoiGraph;
use super::ring::AROUND;

/// A narrow place between two rooms.
#[derive(Debug, Clone, PartialEq)]
pub struct Doorway {
    /// In its middle, metres.
    pub position_m: [f64; 2],
    /// Between the cells on both sides of it that are not free, centre to centre, metres.
    pub width_m: f64,
    /// Numbers of the rooms that it joins.
    pub rooms: [u32; 2],
}

/// Which room each cell lies in.
#[derive(Debug, Clone)]
pub struct Rooms {
    /// Number of the room of each cell, from 1 on; 0 where it is in none.
    pub room_of: Grid<u32>,
    /// How many rooms there are.
    pub count: u32,
    /// Doorways between two different rooms.
    pub doorways: Vec<Doorway>,
}

/// A place to cut at: the cell of the diagram, the cells beside it on the way, and what it is cut to on both sides.
struct DoorCut {
    at: usize,
    sides: [usize; 2],
    walls: [usize; 2],
}

impl VoronoiGraph {
    /// Divides the free cells into rooms.
    pub fn rooms(&self) -> Rooms {
        let cuts: Vec<DoorCut> = self
            .ways
            .iter()
            .flat_map(|way| self.cuts(&way.path_m))
            .collect();
        let mut labels = self.flooded(&cuts);
        let count = labels.iter().copied().max().unwrap_or(0);
        let mut doorways: Vec<Doorway> =
            cuts.iter().map(|cut| self.doorway(cut, &labels)).collect();
        let into = self.merged(&labels, count, &doorways);
        for label in &mut labels {
            *label = into[*label as usize];
        }
        for doorway in &mut doorways {
            doorway.rooms = doorway.rooms.map(|room| into[room as usize]);
        }
        doorways
            .retain(|doorway| doorway.rooms[0] != doorway.rooms[1] && !doorway.rooms.contains(&0));
        let mut room_of = Grid::filled(self.size[0], self.size[1], 0);
        for (row, values) in room_of
            .values_mut()
            .chunks_exact_mut(self.size[0].max(1))
            .enumerate()
        {
            let first = (row + 1) * self.skeleton.cols + 1;
            values.copy_from_slice(&labels[first..][..self.size[0]]);
        }
        Rooms {
            room_of,
            count: into.iter().copied().max().unwrap_or(0),
            doorways,
        }
    }

    /// Narrowest places of a way: not wider than a doorway, and wider on both sides.
    fn cuts(&self, path_m: &[[f64; 2]]) -> Vec<DoorCut> {
        let cells: Vec<usize> = path_m
            .iter()
            .filter_map(|&point| self.index_at(point))
            .collect();
        let squared: Vec<f64> = cells
            .iter()
            .map(|&at| f64::from(self.skeleton.nearest.squared[at]))
            .collect();
        let most = self.config.doorway / (2.0 * self.lattice.cell_m);
        let grows = self.config.widens * self.config.widens;
        let mut found = Vec::new();
        let mut first = 0;
        while first < cells.len() {
            let own = squared[first];
            let last = (first..cells.len())
                .take_while(|&at| squared[at] == own)
                .last()
                .unwrap_or(first);
            let widest = |values: &mut dyn Iterator<Item = &f64>| {
                values
                    .take_while(|&&value| value >= own)
                    .fold(own, |most, &value| most.max(value))
            };
            let before = widest(&mut squared[..first].iter().rev());
            let after = widest(&mut squared[last + 1..].iter());
            let middle = usize::midpoint(first, last);
            if own <= most * most && before >= grows * own && after >= grows * own && middle > 0 {
                let sides = [cells[middle - 1], cells[(middle + 1).min(cells.len() - 1)]];
                found.push(self.cut(cells[middle], sides));
            }
            first = last + 1;
        }
        found
    }

    /// From a cell to the nearest obstacle, and to the one as near that lies most on its other side.
    fn cut(&self, at: usize, sides: [usize; 2]) -> DoorCut {
        let nearest = &self.skeleton.nearest.blocked;
        let cols = self.skeleton.cols as f64;
        let towards = |other: u32| {
            let (from, to) = (at as f64, f64::from(other));
            let down = (to / cols).floor() - (from / cols).floor();
            [to % cols - from % cols, down]
        };
        let own = towards(nearest[at]);
        let cosine = |other: u32| {
            let there = towards(other);
            (own[0] * there[0] + own[1] * there[1]) / libm::hypot(there[0], there[1]).max(1e-9)
        };
        let opposite = AROUND
            .iter()
            .map(|&around| nearest[self.skeleton.beside(at, around)])
            .min_by(|&a, &b| cosine(a).total_cmp(&cosine(b)))
            .unwrap_or(nearest[at]);
        DoorCut {
            at,
            sides,
            walls: [nearest[at] as usize, opposite as usize],
        }
    }

    /// Numbers of the pieces into which the cuts part the free cells; those of the cuts belong to a piece beside them.
    fn flooded(&self, cuts: &[DoorCut]) -> Vec<u32> {
        const CUT: u32 = u32::MAX;
        let cols = self.skeleton.cols;
        let free = |at: usize| self.skeleton.nearest.squared[at] > 0;
        let mut labels = vec![0; self.skeleton.kept.len()];
        for cut in cuts {
            for wall in cut.walls {
                for at in line(cut.at, wall, cols).filter(|&at| free(at)) {
                    labels[at] = CUT;
                }
            }
        }
        let beside = |at: usize| [at - 1, at + 1, at - cols, at + cols];
        let mut count = 0;
        for first in 0..labels.len() {
            if labels[first] != 0 || !free(first) {
                continue;
            }
            count += 1;
            labels[first] = count;
            let mut stack = vec![first];
            while let Some(at) = stack.pop() {
                for next in beside(at) {
                    if labels[next] == 0 && free(next) {
                        labels[next] = count;
                        stack.push(next);
                    }
                }
            }
        }
        let mut left: Vec<usize> = (0..labels.len()).filter(|&at| labels[at] == CUT).collect();
        while !left.is_empty() {
            let before = left.len();
            left.retain(|&at| {
                let known = beside(at)
                    .into_iter()
                    .map(|next| labels[next])
                    .find(|&l| l != 0 && l != CUT);
                labels[at] = known.unwrap_or(CUT);
                known.is_none()
            });
            if left.len() == before {
                for at in left.drain(..) {
                    labels[at] = 0;
                }
            }
        }
        labels
    }

    fn doorway(&self, cut: &DoorCut, labels: &[u32]) -> Doorway {
        let [one, other] = cut.walls.map(|at| self.center_of(at));
        Doorway {
            position_m: self.center_of(cut.at),
            width_m: libm::hypot(other[0] - one[0], other[1] - one[1]),
            rooms: cut.sides.map(|at| labels[at]),
        }
    }

    /// What number each piece gets once those that are too small for a room have gone to the neighbour behind their widest doorway; 0 for
    /// those without one.
    fn merged(&self, labels: &[u32], count: u32, doorways: &[Doorway]) -> Vec<u32> {
        let mut areas = vec![0_u32; count as usize + 1];
        for &label in labels {
            areas[label as usize] += 1;
        }
        let least = self.config.room / (self.lattice.cell_m * self.lattice.cell_m);
        let mut into: Vec<u32> = (0..=count).collect();
        loop {
            let small = (1..=count)
                .filter(|&piece| {
                    into[piece as usize] == piece && f64::from(areas[piece as usize]) < least
                })
                .min_by_key(|&piece| areas[piece as usize]);
            let Some(small) = small else { break };
            let neighbour = doorways
                .iter()
                .filter_map(|doorway| {
                    let [one, other] = doorway.rooms.map(|room| into[room as usize]);
                    let beyond = if one == small { other } else { one };
                    let joins = (one == small || other == small) && beyond != small && beyond != 0;
                    joins.then_some((doorway.width_m, beyond))
                })
                .max_by(|a, b| a.0.total_cmp(&b.0))
                .map_or(0, |(_, beyond)| beyond);
            areas[neighbour as usize] += areas[small as usize];
            for piece in &mut into {
                if *piece == small {
                    *piece = neighbour;
                }
            }
        }
        let mut kept: Vec<u32> = into[1..]
            .iter()
            .copied()
            .filter(|&piece| piece != 0)
            .collect();
        kept.sort_unstable();
        kept.dedup();
        into.iter()
            .map(|piece| kept.binary_search(piece).map_or(0, |at| at as u32 + 1))
            .collect()
    }
}

/// Cells from one to another, each sharing a side with the next.
fn line(from: usize, to: usize, cols: usize) -> impl Iterator<Item = usize> {
    let place = |at: usize| [(at % cols) as i64, (at / cols) as i64];
    let (start, end) = (place(from), place(to));
    let (across, along) = (end[0] - start[0], end[1] - start[1]);
    let (mut done, mut left) = ([0_i64; 2], across.abs() + along.abs() + 1);
    std::iter::from_fn(move || {
        left -= 1;
        if left < 0 {
            return None;
        }
        let at = (start[1] + done[1]) * cols as i64 + start[0] + done[0];
        // The side that is behind on the way goes next.
        let ahead = (2 * done[0].abs() + 1) * along.abs() - (2 * done[1].abs() + 1) * across.abs();
        if (ahead < 0 || along == done[1]) && across != done[0] {
            done[0] += across.signum();
        } else {
            done[1] += along.signum();
        }
        Some(at as usize)
    })
}
