//! What the simulated robot sees.

use mapping::Surface;

use super::Simulation;

const EYE_HEIGHT_M: f64 = 0.46;

impl Simulation {
    pub(super) fn sees_nothing(&self) -> bool {
        let looks_rad = self.pose.yaw_rad + self.gaze.pan_rad;
        let away = |(heading_rad, most_rad): (f64, f64)| {
            geometry::angle_between(heading_rad, looks_rad).abs() > most_rad
        };
        self.blind || self.sees_only.is_some_and(away) || self.pose.x_m > self.sees_before_x_m
    }

    fn truth(&self, [x, y]: [f64; 2]) -> Surface {
        let within = |discs: &[[f64; 3]]| {
            discs
                .iter()
                .any(|d| geometry::hypot(d[0] - x, d[1] - y) < d[2])
        };
        let boxed = self
            .boxes
            .iter()
            .any(|[low, high]| (low[0]..high[0]).contains(&x) && (low[1]..high[1]).contains(&y));
        if within(&self.holes) {
            Surface::Unknown
        } else if boxed || within(&self.obstacles) {
            Surface::Obstacle(0.3)
        } else {
            Surface::Floor(0.0)
        }
    }

    pub(super) fn see(&mut self) {
        let robot_from_map = self.pose.inverse();
        for cell in self.view.cells.area().cells() {
            let center = self.view.lattice.center_of(cell);
            let surface = self.truth(center);
            if self.view.cell(cell) == surface {
                continue;
            }
            let (x, y) = robot_from_map.apply(center[0], center[1]);
            let distance_m = geometry::hypot(x, y);
            let pan_error_rad = geometry::angle_between(self.gaze.pan_rad, libm::atan2(y, x));
            let down_rad = libm::atan2(EYE_HEIGHT_M, (distance_m - 0.05).max(0.01));
            let in_view =
                pan_error_rad.abs() < 0.41 && (down_rad - self.gaze.down_rad).abs() < 0.34;
            if in_view
                && distance_m < 2.0
                && let Some(slot) = self.view.cells.get_mut(cell)
            {
                *slot = surface;
            }
        }
        self.frames += 1;
        self.last_frame_ns = Some(self.time_ns);
    }
}
