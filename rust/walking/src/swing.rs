//! The path of the swing foot: minimum jerk over the ground, up and down once.

/// Minimum-jerk rise from 0 to 1 for a share of time in [0, 1]: 10 s^3 - 15 s^4 + 6 s^5 (Flash and Hogan, 1985). At rest at both ends.
pub fn minimum_jerk(share: f64) -> f64 {
    let s = share.clamp(0.0, 1.0);
    s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

/// When the foot moves over the ground, as shares of the swing time.
const TRAVEL: [f64; 2] = [0.1, 0.9];

/// Share of the way over the ground after a share of the time.
pub fn travel(share: f64) -> f64 {
    minimum_jerk((share - TRAVEL[0]) / (TRAVEL[1] - TRAVEL[0]))
}

/// Height of the sole after a share of the time: from `from_m` up to `top_m` in the middle and down to `to_m`.
pub fn height_m(share: f64, from_m: f64, top_m: f64, to_m: f64) -> f64 {
    if share < 0.5 {
        from_m + (top_m - from_m) * minimum_jerk(2.0 * share)
    } else {
        top_m + (to_m - top_m) * minimum_jerk(2.0 * share - 1.0)
    }
}
