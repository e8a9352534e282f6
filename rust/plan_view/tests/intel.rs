//! The log of the Intel lab as lines (004, Fig. 36.5); the folder with the data is named by `TREADWELL_DATA`, and none is no failure.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use geometry::PlanarPose;
use plan_view::{
    AlignmentConfig, LineAlignment, LineFinder, LineFinderConfig, PlanarBeam, PlanarScan,
};

/// The scans of the log with their valid points; none without the data.
fn scans() -> Option<Vec<PlanarScan>> {
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
    let _bytes = gunzip
        .stdout
        .as_mut()
        .unwrap()
        .read_to_string(&mut text)
        .unwrap();
    let _status = gunzip.wait().unwrap();
    let (mut pose, mut scans) = (PlanarPose::default(), Vec::new());
    for line in text.lines() {
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
            _ => {}
        }
    }
    Some(scans)
}

/// H17. Some 470,000 points take long without optimization: `cargo test --release -p plan_view --test intel -- --ignored --nocapture`.
#[test]
#[ignore = "the whole log: ten seconds with optimization"]
fn ninety_percent_of_the_intel_logs_points_lie_on_few_lines() {
    let Some(scans) = scans() else {
        return;
    };
    let points: Vec<_> = scans.iter().flat_map(PlanarScan::ends_m).collect();
    for (held, most_lines) in [(0.9, 400), (1.0, 94)] {
        let started = Instant::now();
        let config = LineFinderConfig {
            held: Some(held),
            most_lines,
            ..LineFinderConfig::default()
        };
        let within_m = config.hold * config.sigma;
        let finder = LineFinder::new(config).unwrap();
        let found = finder.find(&points).unwrap();
        let lines = found.mixture.lines();
        let off = |at: &[f64; 2]| {
            lines
                .iter()
                .map(|line| line.signed_distance_m(*at).abs())
                .fold(f64::INFINITY, f64::min)
        };
        let mean_m = points.iter().map(off).sum::<f64>() / points.len() as f64;
        let drawn = finder.stretches(&found, &points);
        eprintln!(
            "{} points, held {held}, at most {most_lines}: {} lines hold {:.4} within 2 sigma, mean distance {mean_m:.4} m; {} stretches, \
             {:.0} times smaller than the points; {:.1} s",
            points.len(),
            lines.len(),
            found.held,
            drawn.len(),
            (2 * points.len()) as f64 / (2 * lines.len() + 2 * drawn.len()) as f64,
            started.elapsed().as_secs_f64(),
        );
        assert!(held == 1.0 || found.held >= held && lines.len() <= 120 && mean_m <= within_m);
    }
}

/// H17 with the scans laid onto the lines: the poses of the log are right to a centimetre or two.
#[test]
#[ignore = "the whole log, a dozen times: two minutes"]
fn fewer_lines_hold_as_much_of_the_intel_log_with_its_scans_laid_onto_them() {
    let Some(scans) = scans() else {
        return;
    };
    let started = Instant::now();
    let config = LineFinderConfig {
        held: Some(0.9),
        cell: 0.5,
        rounds: 12,
        ..LineFinderConfig::default()
    };
    let finder = LineFinder::new(config).unwrap();
    let alignment = LineAlignment::new(AlignmentConfig::default()).unwrap();
    let (found, poses) = alignment.find(&finder, &scans).unwrap();
    let moved = poses
        .iter()
        .zip(&scans)
        .map(|(pose, scan)| pose.distance_m(&scan.map_from_sensor));
    eprintln!(
        "{} lines hold {:.4} within 2 sigma, poses moved by {:.4} m on average; {:.1} s",
        found.mixture.lines().len(),
        found.held,
        moved.sum::<f64>() / scans.len() as f64,
        started.elapsed().as_secs_f64(),
    );
    assert!(found.held >= 0.9 && found.mixture.lines().len() <= 98);
}
