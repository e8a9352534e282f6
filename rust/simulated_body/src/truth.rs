//! The true state, as the simulator keeps it.

use crate::SimulatedBodyError;

/// The simulator's own arrays, none of them copied: row by row, SI, the world's frame. The names are MuJoCo's.
#[derive(Debug, Clone, Copy)]
pub struct TrueState<'a> {
    /// Generalised positions: of each joint its angle, rad.
    pub qpos: &'a [f64],
    /// Generalised velocities: of each joint its speed, rad/s.
    pub qvel: &'a [f64],
    /// (bodies, 3) m: origin of each link.
    pub xpos: &'a [f64],
    /// (bodies, 9): axes of each link, `world_from_link`.
    pub xmat: &'a [f64],
    /// (bodies, 6) rad/s and m/s: velocity of each link, at the centre of mass of its tree.
    pub cvel: &'a [f64],
    /// (bodies, 3) m: centre of mass of what hangs on each link.
    pub subtree_com: &'a [f64],
    /// (sites, 3) m: each site.
    pub site_xpos: &'a [f64],
    /// (sites, 9): axes of each site, `world_from_site`.
    pub site_xmat: &'a [f64],
    /// What MuJoCo's sensors say.
    pub sensordata: &'a [f64],
}

impl TrueState<'_> {
    /// A state of a world without anything, for those who read a few arrays only.
    pub const NOTHING: Self = Self {
        qpos: &[],
        qvel: &[],
        xpos: &[],
        xmat: &[],
        cvel: &[],
        subtree_com: &[],
        site_xpos: &[],
        site_xmat: &[],
        sensordata: &[],
    };
}

/// Row `row` of an array of rows of `N` numbers. [`needs`] has looked that it is there.
pub(crate) fn row<const N: usize>(array: &[f64], row: usize) -> [f64; N] {
    let from = row * N;
    let mut found = [0.0; N];
    if let Some(slice) = array.get(from..from + N) {
        found.copy_from_slice(slice);
    }
    found
}

/// Whether an array has at least `end` numbers.
pub(crate) const fn needs(
    array: &'static str,
    values: &[f64],
    end: usize,
) -> Result<(), SimulatedBodyError> {
    if values.len() >= end {
        return Ok(());
    }
    Err(SimulatedBodyError::OutOfModel {
        array,
        length: values.len(),
        end,
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A state of a free body with two joints, a site, and a contact sensor, to be changed.
    pub(crate) struct Arrays {
        pub(crate) qpos: Vec<f64>,
        pub(crate) qvel: Vec<f64>,
        pub(crate) xpos: Vec<f64>,
        pub(crate) xmat: Vec<f64>,
        pub(crate) cvel: Vec<f64>,
        pub(crate) subtree_com: Vec<f64>,
        pub(crate) site_xpos: Vec<f64>,
        pub(crate) site_xmat: Vec<f64>,
        pub(crate) sensordata: Vec<f64>,
    }

    const LEVEL: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

    pub(crate) fn arrays() -> Arrays {
        Arrays {
            qpos: vec![0.0; 9],
            qvel: vec![0.0; 8],
            xpos: vec![0.0; 6],
            xmat: LEVEL.repeat(2),
            cvel: vec![0.0; 12],
            subtree_com: vec![0.0; 6],
            site_xpos: vec![0.0; 3],
            site_xmat: LEVEL.to_vec(),
            sensordata: vec![0.0; 6],
        }
    }

    impl Arrays {
        pub(crate) fn state(&self) -> TrueState<'_> {
            TrueState {
                qpos: &self.qpos,
                qvel: &self.qvel,
                xpos: &self.xpos,
                xmat: &self.xmat,
                cvel: &self.cvel,
                subtree_com: &self.subtree_com,
                site_xpos: &self.site_xpos,
                site_xmat: &self.site_xmat,
                sensordata: &self.sensordata,
            }
        }
    }

    #[test]
    fn a_row_is_taken_out_of_an_array_of_rows() {
        assert_eq!(row::<2>(&[1.0, 2.0, 3.0, 4.0], 1), [3.0, 4.0]);
        assert!(needs("x", &[1.0], 2).is_err());
    }
}
