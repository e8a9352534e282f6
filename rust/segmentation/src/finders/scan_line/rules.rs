//! What the scan lines are cut and grouped by, as the settings have it.

use super::config::ScanLineConfig;

/// What the cutting needs to know.
#[derive(Debug, Clone, Copy)]
pub(super) struct StripRules {
    /// Columns of a strip.
    pub(super) strip: usize,
    /// Price of one more segment, in squared noise.
    pub(super) price: f32,
    /// Shortest segment, rows.
    pub(super) min_segment: usize,
    /// Least `g` of a pixel that counts, m px.
    pub(super) least_fall: f32,
    /// Farthest that a pixel may be from the middle one of its row, in noise.
    pub(super) agree: f32,
    /// Share of a row's pixels that must agree.
    pub(super) agreeing: f64,
    /// Rows without a measurement that a line may bridge.
    pub(super) max_gap: usize,
    /// Price of a steep line, in squared noise.
    pub(super) steep_price: f64,
    /// Change of a steep line's disparity, as a share of a horizontal one's.
    pub(super) steep: f64,
}

impl StripRules {
    /// For a camera of which focal length times baseline is `scale`, m px.
    pub(super) fn new(config: &ScanLineConfig, scale: f32) -> Self {
        let tuning = &config.tuning;
        Self {
            strip: config.strip,
            price: config.segment_price as f32,
            min_segment: config.min_segment,
            least_fall: tuning.min_fall * scale,
            agree: tuning.agree,
            agreeing: tuning.agreeing,
            max_gap: tuning.max_gap,
            steep_price: tuning.steep_price,
            steep: tuning.steep,
        }
    }
}

/// Thresholds of the growth, in noise, and sizes.
#[derive(Debug, Clone, Copy)]
pub(super) struct GrowthRules {
    /// Columns of a strip.
    pub(super) strip: usize,
    /// Surfaces closer than this are one.
    pub(super) join: f32,
    /// Surfaces of which one is small are one when closer than this.
    pub(super) join_small: f32,
    /// A pixel closer than this belongs to the surface.
    pub(super) accept: f32,
    /// Smallest region, pixels.
    pub(super) min_region: usize,
    /// Share of the shorter one of two segments that must lie beside the other one.
    pub(super) overlap: f64,
    /// Columns or rows between pixels that touch.
    pub(super) contact_reach: usize,
    /// Fewest places where regions that are joined touch.
    pub(super) min_contacts: u32,
    /// A region with fewer pixels is small.
    pub(super) small_region: usize,
}

impl GrowthRules {
    /// For regions of `min_region` pixels or more.
    pub(super) fn new(config: &ScanLineConfig, min_region: usize) -> Self {
        let tuning = &config.tuning;
        Self {
            strip: config.strip,
            join: config.join as f32,
            join_small: (tuning.small_join * config.join) as f32,
            accept: config.accept as f32,
            min_region,
            overlap: tuning.overlap,
            contact_reach: tuning.contact_reach,
            min_contacts: tuning.min_contacts,
            small_region: tuning.small_region,
        }
    }
}
