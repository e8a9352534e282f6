//! The log of the Intel lab; the folder with the data is named by `TREADWELL_DATA`, and none is no failure.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use geometry::{PlanarPose, SplitMix64, distance_m, wrap_angle};
use plan_view::{PlanarBeam, PlanarScan};
use scan_matching::{ScanSlam, ScanSlamConfig};

/// Two scans, and how the second lies to the first.
type Pair = (usize, usize, PlanarPose);

/// The scans of the log at its corrected poses, and the pairs that close its loops; none without the data.
fn log() -> Option<(Vec<PlanarScan>, Vec<Pair>)> {
    let Ok(data) = std::env::var("TREADWELL_DATA") else {
        eprintln!("skipped: TREADWELL_DATA is not set");
        return None;
    };
    let log = Path::new(&data).join("laser2d/intel-lab.log.gz");
    let mut gunzip = Command::new("gzip")
        .arg("-dc")
        .arg(log)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut text = String::new();
    let mut output = gunzip.stdout.take().unwrap();
    let _bytes = output.read_to_string(&mut text).unwrap();
    let _status = gunzip.wait().unwrap();
    let (mut pose, mut loops) = (PlanarPose::default(), false);
    let (mut scans, mut pairs) = (Vec::new(), Vec::new());
    for line in text.lines() {
        loops |= line.starts_with("#LOOP EDGES");
        let words: Vec<&str> = line.split(' ').collect();
        let number = |at: usize| words[at].parse::<f64>().unwrap();
        match words[0] {
            "VERTEX2" => pose = PlanarPose::new(number(2), number(3), number(4)),
            "ROBOTLASER1" => {
                let beam = |at: usize| {
                    let range_m = Some(number(9 + at)).filter(|range_m| *range_m < number(5));
                    PlanarBeam::new(number(2) + at as f64 * number(4), range_m)
                };
                scans.push(PlanarScan {
                    map_from_sensor: pose,
                    beams: (0..number(8) as usize).map(beam).collect(),
                });
            }
            "EDGE2" if loops => pairs.push((
                number(1) as usize,
                number(2) as usize,
                PlanarPose::new(number(3), number(4), number(5)),
            )),
            _ => {}
        }
    }
    Some((scans, pairs))
}

/// Odometry: the steps between the corrected poses with noise of 5 % of the way, and of 2 degrees and 5 % of the turn.
fn by_odometry(scans: &[PlanarScan], seed: u64) -> Vec<PlanarScan> {
    let mut numbers = SplitMix64::new(seed);
    let mut made = vec![scans[0].clone()];
    for pair in scans.windows(2) {
        let step = pair[0].map_from_sensor.relative(&pair[1].map_from_sensor);
        let way_m = geometry::hypot(step.x_m, step.y_m);
        let [x, y, turn] = numbers.normals::<3>();
        let turn_noise = 2_f64.to_radians() + 0.05 * step.yaw_rad.abs();
        let noisy = PlanarPose::new(
            step.x_m + 0.05 * way_m * x,
            step.y_m + 0.05 * way_m * y,
            step.yaw_rad + turn_noise * turn,
        );
        made.push(PlanarScan {
            map_from_sensor: made.last().unwrap().map_from_sensor.compose(&noisy),
            beams: pair[1].beams.clone(),
        });
    }
    made
}

/// Mean error over the pairs, m and degrees.
fn error(poses: &[PlanarPose], pairs: &[Pair]) -> (f64, f64) {
    let (mut far, mut turned) = (0.0, 0.0);
    for (one, other, wanted) in pairs {
        let seen = poses[*one].relative(&poses[*other]);
        far += distance_m([seen.x_m, seen.y_m], [wanted.x_m, wanted.y_m]);
        turned += wrap_angle(seen.yaw_rad - wanted.yaw_rad).abs().to_degrees();
    }
    let count = pairs.len() as f64;
    (far / count, turned / count)
}

/// With optimization: `cargo test --release -p scan_matching --test intel -- --ignored --nocapture`.
#[test]
#[ignore = "the whole log: a minute with optimization"]
fn noisy_odometry_of_the_intel_log_is_corrected_by_its_scans() {
    let Some((scans, pairs)) = log() else {
        return;
    };
    for seed in 0..2 {
        let noisy = by_odometry(&scans, seed);
        let started = Instant::now();
        let mut slam = ScanSlam::new(ScanSlamConfig::default()).unwrap();
        for scan in &noisy {
            slam.insert(scan).unwrap();
        }
        slam.finish();
        let seconds = started.elapsed().as_secs_f64();
        let (far_m, far_deg) = error(slam.poses(), &pairs);
        eprintln!(
            "seed {seed}: {far_m:.4} m, {far_deg:.3} degrees; {} of {} loops, {} unmatched, {} maps, {seconds:.1} s",
            slam.closed_loops(),
            slam.graph()
                .links
                .iter()
                .filter(|link| link.is_loop)
                .count(),
            slam.unmatched(),
            slam.local_maps().count(),
        );
        // The pairs themselves are 4 cm and half a degree off from where their scans lie on each other (benches/intel_slam.py).
        assert!(far_m <= 0.045 && far_deg <= 0.6);
    }
}
