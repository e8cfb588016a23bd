//! Shared by several test files: a seeded generator biased to extreme cases, and short constructors of chains.
#![allow(clippy::unwrap_used, reason = "test helpers: a chain that cannot be built fails its test")]

use chta::{
    chain::{ConstrainedChain, ContactRule, GroundForm, LineConstraints, PolygonalChain, SegmentGround},
    quantity::{AngleInterval, ChainPoint},
    world::{ClearanceRule, Gravity, Hopper, HopperLimits, RestSlope, SpeedLevels, SurfaceProperties},
};

mod draw;
pub(crate) use draw::Draw;

impl Draw {
    /// A gravity between that of a small asteroid and more than Jupiter's, m/s^2.
    pub(crate) fn gravity(&mut self) -> f64 {
        self.log_uniform(1e-5, 25.0)
    }

    /// Where the clearance is kept: by the paper's rule, or with a taper from nearly none to nearly upright.
    pub(crate) fn clearance_rule(&mut self) -> ClearanceRule {
        match self.below(4) {
            0 => ClearanceRule::Vertex,
            1 => ClearanceRule::TAPERED,
            _ => ClearanceRule::Tapered(self.log_uniform(0.05, 20.0)),
        }
    }

    /// Now and then a least take-off speed or speed levels of the machine, up to a greatest speed.
    pub(crate) fn commands(&mut self, limits: &mut HopperLimits, speed_max_m_s: f64) {
        match self.below(5) {
            0 => limits.takeoff_speed_min_m_s = Some(speed_max_m_s * self.uniform(0.3, 1.0)),
            1 => {
                let mut levels: Vec<f64> = (0..=self.below(4)).map(|_| speed_max_m_s * self.uniform(0.3, 1.0)).collect();
                levels.sort_by(f64::total_cmp);
                limits.takeoff_speed_levels = SpeedLevels::new(&levels).ok();
            }
            _ => {}
        }
    }

    /// A rough profile: flats, slopes, steps, walls and needles, with a few extremely short segments.
    pub(crate) fn profile(&mut self, segments: usize, size_m: f64) -> Vec<ChainPoint> {
        let mut points = vec![ChainPoint::new(self.uniform(-1.0, 1.0) * size_m, self.uniform(-1.0, 1.0) * size_m)];
        for i in 0..segments {
            let run = size_m * if self.chance(0.1) { self.log_uniform(1e-6, 1e-2) } else { self.uniform(0.05, 1.0) };
            let rise = match self.below(6) {
                0 => 0.0,
                1 => self.sign() * self.log_uniform(1e-6, 1e-1) * size_m,
                2 => self.sign() * run * self.log_uniform(1.0, 30.0).min(2.0 * size_m / run),
                _ => self.uniform(-0.6, 0.6) * run,
            };
            points.push(ChainPoint::new(points[i].x_m + run, points[i].z_m + rise));
        }
        points
    }

    /// Line constraints: cones from wide open to nearly closed about the vertical, speeds around `speed_m_s`.
    pub(crate) fn line(&mut self, speed_m_s: f64) -> LineConstraints {
        let takeoff = match self.below(4) {
            0 => (-90.0, 90.0),
            1 => (self.uniform(-60.0, 60.0), 120.0),
            2 => (self.uniform(-60.0, 40.0), self.uniform(40.0, 89.9)),
            _ => (self.uniform(20.0, 70.0), self.uniform(70.0, 95.0)),
        };
        let landing = match self.below(4) {
            0 => (-90.0, 90.0),
            1 => (-120.0, self.uniform(-60.0, 60.0)),
            2 => (self.uniform(-89.9, -40.0), self.uniform(-40.0, 60.0)),
            _ => (self.uniform(-95.0, -70.0), self.uniform(-70.0, -20.0)),
        };
        line(takeoff, speed_m_s * self.log_uniform(0.5, 2.0), landing, speed_m_s * self.log_uniform(0.5, 2.0))
    }
}

/// Line constraints from degrees and m/s.
pub(crate) fn line(takeoff_deg: (f64, f64), takeoff_m_s: f64, landing_deg: (f64, f64), landing_m_s: f64) -> LineConstraints {
    LineConstraints {
        takeoff: ContactRule::new(AngleInterval::from_degrees(takeoff_deg.0, takeoff_deg.1), takeoff_m_s),
        landing: ContactRule::new(AngleInterval::from_degrees(landing_deg.0, landing_deg.1), landing_m_s),
    }
}

/// A surface without constraints of its own, for explicit constraints.
pub(crate) const NO_SURFACE: SurfaceProperties = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };

/// A chain with explicit constraints per segment, (forward, reverse).
pub(crate) fn explicit(points: &[ChainPoint], lines: &[(LineConstraints, LineConstraints)], rest: RestSlope) -> ConstrainedChain {
    let grounds = lines
        .iter()
        .map(|&(forward, reverse)| SegmentGround {
            form: GroundForm::Explicit { forward: Some(forward), reverse: Some(reverse) },
            keep_out: false,
        })
        .collect();
    let chain = PolygonalChain::new(points.to_vec(), grounds, None).unwrap();
    ConstrainedChain::new(chain, &Hopper::UNLIMITED, Gravity::new(1.0).unwrap(), &SurfaceProperties { rest, ..NO_SURFACE }).unwrap()
}

/// A chain with the same explicit constraints everywhere and in both directions.
pub(crate) fn uniform(points: &[ChainPoint], line: LineConstraints) -> ConstrainedChain {
    explicit(points, &vec![(line, line); points.len() - 1], RestSlope::Unlimited)
}

/// The quantile of the values at a fraction.
#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index from a share")]
pub(crate) fn quantile(values: &mut [f64], share: f64) -> f64 {
    assert!(!values.is_empty(), "a quantile of nothing");
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share).round() as usize]
}
