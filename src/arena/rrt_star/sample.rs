//! Samples of the floor.

use rand::{RngExt, rngs::ChaCha8Rng};

use super::{super::Arena, RrtStarOptions, space::Space};
use crate::quantity::MapPoint;

/// Draws places: the goal, beside faces, from the whole floor or from the ellipse that holds every better path.
pub(super) struct Sampler<'a> {
    arena: &'a Arena,
    space: &'a Space<'a>,
    options: RrtStarOptions,
    source: ChaCha8Rng,
    /// The lengths of the faces that can be jumped, added up, m.
    face_lengths_m: Vec<f64>,
}

impl<'a> Sampler<'a> {
    pub(super) fn new(arena: &'a Arena, space: &'a Space<'a>, options: &RrtStarOptions, source: ChaCha8Rng) -> Self {
        let lengths = space.jumpable.iter().scan(0.0, |sum_m, face| {
            *sum_m += (face.max - face.min).norm();
            Some(*sum_m)
        });
        Self { arena, space, options: *options, source, face_lengths_m: lengths.collect() }
    }

    fn unit(&mut self) -> f64 {
        self.source.random::<f64>()
    }

    /// The length of the longest path that is better, m.
    fn longest_m(&self, best_s: f64) -> f64 {
        best_s * self.arena.jumper().speed_m_s
    }

    /// A place; `None`: it is of no use.
    pub(super) fn next(&mut self, best_s: Option<f64>) -> Option<MapPoint> {
        let (kind, [width_m, depth_m]) = (self.unit(), self.arena.size_m());
        let goal_share = if best_s.is_some() { 0.0 } else { self.options.goal_share };
        let point = if kind < goal_share {
            self.arena.goal()
        } else if kind < goal_share + self.options.face_share && !self.face_lengths_m.is_empty() {
            self.beside_face()
        } else if let Some(best_s) = best_s {
            self.in_ellipse(self.longest_m(best_s))
        } else {
            MapPoint::new(self.unit() * width_m, self.unit() * depth_m)
        };
        let is_on_floor = (0.0..=width_m).contains(&point.x) && (0.0..=depth_m).contains(&point.y);
        let through_m = (point - self.arena.start()).norm() + (self.arena.goal() - point).norm();
        (is_on_floor && best_s.is_none_or(|best_s| through_m <= self.longest_m(best_s))).then_some(point)
    }

    /// Beside a face that can be jumped, as far from it as a jump begins or ends.
    fn beside_face(&mut self) -> MapPoint {
        let total_m = self.face_lengths_m.last().copied().unwrap_or(0.0);
        let at_m = self.unit() * total_m;
        let number = self.face_lengths_m.partition_point(|sum_m| *sum_m < at_m).min(self.space.jumpable.len() - 1);
        let face = self.space.jumpable[number];
        let along = self.unit();
        let (least_m, most_m) = (self.space.ring_m, (self.space.edge_max_m - self.space.ring_m).max(self.space.ring_m));
        let off_m = (least_m + self.unit() * (most_m - least_m)) * if self.unit() < 0.5 { -1.0 } else { 1.0 };
        let on_face = face.min + (face.max - face.min) * along;
        if face.min.x == face.max.x {
            MapPoint::new(on_face.x + off_m, on_face.y)
        } else {
            MapPoint::new(on_face.x, on_face.y + off_m)
        }
    }

    /// Uniform in the ellipse about start and goal.
    fn in_ellipse(&mut self, longest_m: f64) -> MapPoint {
        let (start, goal) = (self.arena.start(), self.arena.goal());
        let apart = goal - start;
        let least_m = apart.norm();
        let (radius, angle) = (self.unit().sqrt(), self.unit() * std::f64::consts::TAU);
        let along_m = 0.5 * longest_m * radius * libm::cos(angle);
        let across_m = 0.5 * (longest_m * longest_m - least_m * least_m).max(0.0).sqrt() * radius * libm::sin(angle);
        let unit = apart / least_m;
        let middle = start + 0.5 * apart;
        MapPoint::new(middle.x + along_m * unit.x - across_m * unit.y, middle.y + along_m * unit.y + across_m * unit.x)
    }

    /// The radius of neighbours after some nodes, m: as RRT* needs it to converge over the area that samples come from (Karaman and Frazzoli
    /// 2011), and at most that of the options.
    pub(super) fn radius_m(&self, nodes: usize, best_s: Option<f64>) -> f64 {
        let [width_m, depth_m] = self.arena.size_m();
        let apart_m = (self.arena.goal() - self.arena.start()).norm();
        let ellipse_m2 = best_s.map_or(f64::INFINITY, |best_s| {
            let longest_m = self.longest_m(best_s);
            0.25 * std::f64::consts::PI * longest_m * (longest_m * longest_m - apart_m * apart_m).max(0.0).sqrt()
        });
        let area_m2 = ellipse_m2.min(width_m * depth_m);
        #[expect(clippy::cast_precision_loss, reason = "a number of nodes")]
        let count = nodes.max(2) as f64;
        // The factor of the theorem is 2 sqrt(1 + 1/d) in d = 2 dimensions, for the area in units of the unit circle.
        let radius_m = 2.0 * (1.5 * area_m2 / std::f64::consts::PI * libm::log(count) / count).sqrt();
        radius_m.min(self.options.radius_m)
    }
}
