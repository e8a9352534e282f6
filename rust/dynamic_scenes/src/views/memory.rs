//! The views of a time, and what they say of a point.

use std::collections::VecDeque;

use settings::{ConfigError, Table};

use super::{RangeView, ViewsConfig};

impl ViewsConfig {
    /// Whether a sensor that saw as far as `seen_m` saw through something at a range.
    fn is_beyond(&self, seen_m: f64, range_m: f64) -> bool {
        seen_m - range_m > self.margin && 1.0 / range_m - 1.0 / seen_m > self.inverse_margin
    }

    /// Whether a range is another one, as well as that can be told: what is between this and beyond says nothing.
    fn is_same(&self, one_m: f64, other_m: f64) -> bool {
        (one_m - other_m).abs() < self.same * self.margin
            || (1.0 / one_m - 1.0 / other_m).abs() < self.same * self.inverse_margin
    }

    /// Whether a point of a look's own is of something, and no error of the sensor.
    pub(crate) fn has_company(&self, view: &RangeView, point_m: [f64; 3]) -> bool {
        let same = |a: f64, b: f64| a > 0.0 && !self.is_beyond(a, b) && !self.is_beyond(b, a);
        let beside = view.beside(point_m, same);
        beside.is_none_or(|count| count >= self.company)
    }
}

/// How many looks said what of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PointLooks {
    /// Saw something behind it, and nothing where it is.
    pub through: u32,
    /// Saw something there.
    pub there: u32,
}

impl PointLooks {
    /// Whether what is there moves: enough looks saw through it.
    pub fn moves(&self, config: &ViewsConfig) -> bool {
        let all = f64::from(self.through + self.there);
        self.through >= config.looks && f64::from(self.through) >= config.share * all
    }

    /// Whether what is there was seen there, at least as often as not.
    pub const fn stays(&self) -> bool {
        self.there > 0 && self.there >= self.through
    }

    /// Adds what a look says of a point of the map frame, m.
    pub fn add(&mut self, view: &RangeView, point_m: [f64; 3], config: &ViewsConfig) {
        let Some([range_m, nearest_m, own_m]) = view.towards(point_m) else {
            return;
        };
        if config.is_beyond(nearest_m, range_m) {
            self.through += 1;
        } else if config.is_same(own_m, range_m) {
            self.there += 1;
        }
    }
}

/// The looks of the last seconds.
#[derive(Debug, Clone)]
pub struct ViewMemory {
    config: ViewsConfig,
    views: VecDeque<RangeView>,
}

impl ViewMemory {
    /// Without a look.
    pub fn new(config: ViewsConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            config,
            views: VecDeque::new(),
        })
    }

    /// The settings.
    pub const fn config(&self) -> &ViewsConfig {
        &self.config
    }

    /// Forgets all looks.
    pub fn clear(&mut self) {
        self.views.clear();
    }

    /// Takes in a look, unless the last is too near in time; old ones are forgotten. Looks come in the order of time.
    pub fn insert(&mut self, view: RangeView) {
        let now_s = view.time_s();
        self.views
            .retain(|old| now_s - old.time_s() <= self.config.memory);
        let last_s = self.views.back().map(RangeView::time_s);
        if last_s.is_none_or(|last_s| now_s - last_s >= self.config.spacing) {
            self.views.push_back(view.prepared(&self.config));
        }
    }

    /// What the looks say of a point of the map frame, m.
    pub fn looks(&self, point_m: [f64; 3]) -> PointLooks {
        let mut looks = PointLooks::default();
        for view in &self.views {
            looks.add(view, point_m, &self.config);
        }
        looks
    }
}
