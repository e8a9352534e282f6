//! H68 and H72: what moves is followed, predicted, and kept out of maps; with the noise of the project's stereo camera.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Person, Stereo, Wall, room, scan};
use dynamic_scenes::{
    ClustersConfig, GoneConfig, MovingConfig, MovingThings, RangeView, StaticPoints, ViewsConfig,
};
use geometry::SplitMix64;

const FRAME_S: f64 = 0.16;

fn things() -> MovingThings {
    MovingThings::new(MovingConfig::default()).unwrap()
}

/// A robot that walks slowly towards the middle of a room and sways, and somebody on a way of their own.
fn robot(time_s: f64, seed: u64) -> [f64; 3] {
    let phase = seed as f64;
    let sway = 0.01 * libm::sin(9.0 * time_s + phase);
    [0.02 * time_s, sway, 0.02 * libm::sin(1.1 * time_s + phase)]
}

fn walls() -> Vec<Wall> {
    room([-0.5, -1.8], [3.4, 1.8])
}

#[test]
fn a_walker_is_predicted_a_second_ahead_within_twenty_centimetres() {
    let mut errors = Vec::new();
    for seed in 0..6 {
        let mut numbers = SplitMix64::new(seed);
        let speed_mps = 0.2 + 0.02 * seed as f64;
        let near_m = 1.4 + 0.15 * seed as f64;
        let slant = 0.03 * (seed as f64 - 2.5);
        let walker = |time_s: f64| [near_m + slant * time_s, -1.1 + speed_mps * time_s];
        let (mut camera, mut things) = (Stereo::new(), things());
        let mut lost = 0;
        for frame in 0..56 {
            let time_s = FRAME_S * f64::from(frame);
            let at_m = walker((time_s - 1.5).max(0.0));
            let people = [Person::at(at_m[0], at_m[1])];
            let (view, points, _) = camera.see(
                time_s,
                robot(time_s, seed),
                (&walls(), &people),
                &mut numbers,
            );
            let _of_points = things.see(view, points);
            if time_s < 4.0 || at_m[1].abs() > 0.4 * at_m[0] {
                continue; // it must have been seen to walk, and wholly
            }
            let Some(track) = things.tracks().iter().find(|track| track.moves) else {
                lost += 1;
                continue;
            };
            let then_m = walker(time_s - 1.5 + 1.0);
            let predicted = track.predicted(1.0);
            errors.push(geometry::distance_m(predicted.at_m, then_m));
            assert!(predicted.covariance_m2.determinant() > 0.0);
            assert!(track.history.len() > 3);
        }
        assert!(lost <= 2, "seed {seed}: {lost} frames without a track");
    }
    errors.sort_by(f64::total_cmp);
    let [mean, worst] = [
        errors.iter().sum::<f64>() / errors.len() as f64,
        errors[errors.len() * 95 / 100],
    ];
    assert!(
        errors.len() > 80 && worst <= 0.2,
        "{mean} {worst} of {}",
        errors.len()
    );
}

#[test]
fn two_that_cross_keep_their_tracks_and_a_still_room_has_none() {
    let mut numbers = SplitMix64::new(3);
    let (mut busy, mut still) = (things(), things());
    let config = ViewsConfig::default();
    let mut crossed = Vec::new();
    for frame in 0..100 {
        let time_s = 0.1 * f64::from(frame);
        let ways = [[2.0, -1.2 + 0.25 * time_s], [2.6, 1.2 - 0.25 * time_s]];
        let people = ways.map(|[x, y]| Person::at(x, y));
        for (things, people) in [(&mut busy, &people[..]), (&mut still, &[])] {
            let (scan, _) = scan(
                [0.0; 3],
                [1.4, 0.01],
                (&walls(), people),
                (0.02, 8.0),
                &mut numbers,
            );
            let view = RangeView::of_scan(time_s, &scan, &config);
            let points: Vec<_> = scan.ends_m().map(|[x, y]| ([x, y, 0.5], 0.5)).collect();
            let _of_points = things.see(view, points);
        }
        assert!(!still.tracks().iter().any(|track| track.moves), "{time_s}");
        if frame == 30 {
            crossed = busy
                .tracks()
                .iter()
                .filter(|track| track.moves)
                .map(|track| track.id)
                .collect();
        }
    }
    let end: Vec<u32> = busy
        .tracks()
        .iter()
        .filter(|track| track.moves)
        .map(|track| track.id)
        .collect();
    assert_eq!(crossed.len(), 2);
    assert_eq!(crossed, end);
    for track in busy.tracks() {
        assert!((track.velocity_mps()[1].abs() - 0.25).abs() < 0.1);
    }
}

/// What became of the points of people and of what is static in a recording of 20 s: shares of the points.
fn filtered(seed: u64, way: impl Fn(f64) -> [f64; 2]) -> (f64, f64) {
    let mut numbers = SplitMix64::new(100 + seed);
    let mut camera = Stereo::new();
    let mut kept = StaticPoints::new(
        ViewsConfig::default(),
        ClustersConfig::default(),
        GoneConfig::default(),
    )
    .unwrap();
    let mut labels = Vec::new();
    for frame in 0..80 {
        let time_s = 0.25 * f64::from(frame);
        let at_m = way(time_s);
        let people = [Person::at(at_m[0], at_m[1])];
        let (view, points, of_people) = camera.see(
            time_s,
            robot(time_s, seed),
            (&walls(), &people),
            &mut numbers,
        );
        labels.push(
            of_people
                .iter()
                .zip(&points)
                .map(|(of, (_, z))| (*of, *z))
                .collect::<Vec<_>>(),
        );
        kept.insert(view, points);
    }
    let (mut ghosts, mut people, mut lost, mut still) = (0, 0, 0, 0);
    for (frame, labels) in kept.are_static().iter().zip(&labels) {
        for (&kept, &(person, _)) in frame.iter().zip(labels) {
            if person {
                people += 1;
                ghosts += i32::from(kept);
            } else {
                still += 1;
                lost += i32::from(!kept);
            }
        }
    }
    let [ghosts, people, lost, still] = [ghosts, people, lost, still].map(f64::from);
    (ghosts / people, lost / still)
}

#[test]
fn who_walks_through_leaves_no_ghosts_and_walls_are_kept() {
    for seed in 0..3 {
        let way = |time_s: f64| [1.3 + 0.1 * seed as f64, -1.4 + 0.14 * time_s];
        let (ghosts, lost) = filtered(seed, way);
        assert!(
            ghosts <= 0.01 && lost <= 0.02,
            "seed {seed}: {ghosts} {lost}"
        );
    }
}

#[test]
fn who_stood_and_walks_off_leaves_no_ghosts() {
    for seed in 0..3 {
        let way = |time_s: f64| [1.5, -0.1 + 0.2 * (time_s - 12.0).max(0.0)];
        let (ghosts, lost) = filtered(10 + seed, way);
        assert!(
            ghosts <= 0.01 && lost <= 0.02,
            "seed {seed}: {ghosts} {lost}"
        );
    }
}

/// The map is of what is there at the end: somebody who came and stayed is part of it once they have stood as long as looks are kept, as a parked thing
/// would be, and what they walked through is not.
#[test]
fn who_comes_and_stays_is_static_where_they_stay_and_nowhere_else() {
    let (ghosts, lost) = filtered(20, |time_s: f64| [1.5, (-1.2 + 0.3 * time_s).min(0.0)]);
    // 4 s of walking, 6 s until the looks from before are forgotten, 10 s more.
    assert!(
        (0.3..0.8).contains(&ghosts) && lost <= 0.02,
        "{ghosts} {lost}"
    );
}
