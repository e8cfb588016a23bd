//! Bounds of the distance that one hop can cover from or to a station: the parabolas of safety of take-off and landing
//! combined.

use std::ops::Range;

use super::HopTest;
use crate::{
    chain::{ConstrainedChain, ContactRule, Site, Station},
    world::{Contact, Direction, tolerant_speed_m_s},
};

/// The extremes of height and speed over part of a chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extremes {
    lowest_m: f64,
    highest_m: f64,
    /// The greatest take-off and landing speed that any segment allows, m/s.
    takeoff_m_s: f64,
    landing_m_s: f64,
}

impl Extremes {
    const NONE: Self = Self { lowest_m: f64::INFINITY, highest_m: f64::NEG_INFINITY, takeoff_m_s: 0.0, landing_m_s: 0.0 };

    fn and(self, other: Self) -> Self {
        Self {
            lowest_m: self.lowest_m.min(other.lowest_m),
            highest_m: self.highest_m.max(other.highest_m),
            takeoff_m_s: self.takeoff_m_s.max(other.takeoff_m_s),
            landing_m_s: self.landing_m_s.max(other.landing_m_s),
        }
    }

    /// How far the ground extends below and above a height, m, plus the possible rounding of points inside segments.
    fn about_m(&self, z_m: f64) -> (f64, f64) {
        let blur_m = 8.0 * f64::EPSILON * self.lowest_m.abs().max(self.highest_m.abs());
        (z_m - self.lowest_m + blur_m, self.highest_m - z_m + blur_m)
    }

    /// The extremes of one vertex and the segment after it.
    fn at(chain: &ConstrainedChain, vertex: usize) -> Self {
        let z_m = chain.geometry().vertices()[vertex].z_m;
        let greatest = |contact| {
            let rules = chain.segments().get(vertex).into_iter().flat_map(|s| Direction::BOTH.map(|d| s.allowed(contact, d)));
            rules.flatten().map(ContactRule::speed_max_m_s).fold(0.0, f64::max)
        };
        Self { lowest_m: z_m, highest_m: z_m, takeoff_m_s: greatest(Contact::Takeoff), landing_m_s: greatest(Contact::Landing) }
    }
}

/// The extremes over any part of a chain, from a tree over blocks of vertices.
#[derive(Clone, Debug)]
pub(super) struct Relief {
    /// A complete binary tree in heap order: node i covers nodes 2 i and 2 i + 1, the leaves are the second half.
    tree: Vec<Extremes>,
}

impl Relief {
    /// Number of vertices that one leaf covers.
    const BLOCK: usize = 16;

    pub(super) fn of(chain: &ConstrainedChain) -> Self {
        let vertices = chain.geometry().vertices().len();
        let leaves = vertices.div_ceil(Self::BLOCK);
        let mut tree = vec![Extremes::NONE; 2 * leaves];
        for vertex in 0..vertices {
            let leaf = &mut tree[leaves + vertex / Self::BLOCK];
            *leaf = leaf.and(Extremes::at(chain, vertex));
        }
        for node in (1..leaves).rev() {
            tree[node] = tree[2 * node].and(tree[2 * node + 1]);
        }
        Self { tree }
    }

    /// The extremes over vertices and the segments after them, extended to whole blocks.
    fn over(&self, vertices: Range<usize>) -> Extremes {
        let leaves = self.tree.len() / 2;
        let (mut low, mut high) = (leaves + vertices.start / Self::BLOCK, leaves + vertices.end.div_ceil(Self::BLOCK).min(leaves));
        let mut found = Extremes::NONE;
        while low < high {
            if low % 2 == 1 {
                found = found.and(self.tree[low]);
                low += 1;
            }
            if high % 2 == 1 {
                high -= 1;
                found = found.and(self.tree[high]);
            }
            low /= 2;
            high /= 2;
        }
        found
    }
}

/// A margin for the rounding of the bounds: much larger than rounding, and small enough to keep the bounds sharp.
const SLACK: f64 = 1.0 + 1e-9;

/// The greatest horizontal distance of any hop with given greatest speeds, drop and climb.
///
/// ```text
///     take-off:  g (Z + hypot(X, Z)) <= v_t^2      landing:  g (hypot(X, Z) - Z) <= v_l^2
///     X <= (v_t / g) sqrt(v_t^2 + 2 g drop),       X <= (v_l / g) sqrt(v_l^2 + 2 g climb),      X <= v_t v_l / g
/// ```
///
/// The first two are the parabolas of safety at the lowest and at the highest landing. The third is where the two parabolas
/// intersect, at `Z = (v_t^2 - v_l^2) / (2 g)`, and holds for any ground.
///
/// # Units
/// Speeds in m/s (their tolerance is added here), heights in m, gravity in m/s^2.
pub(super) fn farthest_m(takeoff_m_s: f64, landing_m_s: f64, drop_m: f64, climb_m: f64, gravity_m_s2: f64) -> f64 {
    let (takeoff, landing) = (tolerant_speed_m_s(takeoff_m_s), tolerant_speed_m_s(landing_m_s));
    let meeting = takeoff / gravity_m_s2 * landing;
    safe_m(takeoff, drop_m, gravity_m_s2).min(safe_m(landing, climb_m, gravity_m_s2)).min(meeting) * SLACK
}

/// The range of the parabola of safety at a given height below its origin.
fn safe_m(speed_m_s: f64, height_m: f64, gravity_m_s2: f64) -> f64 {
    speed_m_s / gravity_m_s2 * (speed_m_s * speed_m_s + 2.0 * gravity_m_s2 * height_m.max(0.0)).sqrt()
}

impl HopTest {
    /// A horizontal distance beyond which no hop from this station lands, in either direction, m.
    ///
    /// The greater [`landing_reach_m`](Self::landing_reach_m) of both directions.
    pub fn reach_bound_m(&self, takeoff: &Station) -> f64 {
        Direction::BOTH.map(|direction| self.landing_reach_m(takeoff, direction)).into_iter().fold(0.0, f64::max)
    }

    /// A horizontal distance beyond which no hop from this station lands, in one direction, m.
    ///
    /// ```text
    ///     X <= min( v_t v_l / g,  (v_t / g) sqrt(v_t^2 + 2 g drop),  (v_l / g) sqrt(v_l^2 + 2 g climb) )
    /// ```
    ///
    /// from the parabolas of safety of take-off and landing, with the speed allowed here and the greatest landing speed, drop
    /// and climb within the bound itself. The iteration starts with those of the whole chain and shrinks the bound until it
    /// no longer changes much. The bound holds for any terrain. If the ground here refuses take-offs, the chain's greatest
    /// speed is used.
    pub fn landing_reach_m(&self, takeoff: &Station, direction: Direction) -> f64 {
        let allowed = self.allowed(takeoff, Contact::Takeoff, direction).map(ContactRule::speed_max_m_s);
        let speed = allowed.unwrap_or(self.chain().speed_bounds_m_s().0);
        let z_m = takeoff.point.z_m;
        self.shrunk_m(takeoff, direction, |ground| {
            let (drop_m, climb_m) = ground.about_m(z_m);
            farthest_m(speed, ground.landing_m_s, drop_m, climb_m, self.gravity_m_s2())
        })
    }

    /// A horizontal distance beyond which no hop that lands on this station in a direction of travel takes off, m. It is
    /// [`landing_reach_m`](Self::landing_reach_m) of the reversed hop.
    pub fn takeoff_reach_m(&self, landing: &Station, direction: Direction) -> f64 {
        let allowed = self.allowed(landing, Contact::Landing, direction).map(ContactRule::speed_max_m_s);
        let speed = allowed.unwrap_or(self.chain().speed_bounds_m_s().1);
        let z_m = landing.point.z_m;
        let back = if direction == Direction::Forward { Direction::Reverse } else { Direction::Forward };
        self.shrunk_m(landing, back, |ground| {
            let (climb_m, drop_m) = ground.about_m(z_m);
            farthest_m(ground.takeoff_m_s, speed, drop_m, climb_m, self.gravity_m_s2())
        })
    }

    /// A horizontal distance that no hop of this chain exceeds, m.
    pub fn greatest_reach_m(&self) -> f64 {
        let ground = self.relief().over(0..self.chain().geometry().vertices().len());
        self.reach_over_relief_m(ground.about_m(ground.lowest_m).1)
    }

    /// A horizontal distance that no hop exceeds over ground with a given difference between highest and lowest point, m.
    pub(crate) fn reach_over_relief_m(&self, relief_m: f64) -> f64 {
        let (takeoff_m_s, landing_m_s) = self.chain().speed_bounds_m_s();
        farthest_m(takeoff_m_s, landing_m_s, relief_m, relief_m, self.gravity_m_s2())
    }

    /// The distance within which refused hops from a station are counted, m: the bound from the greatest speeds, drop and
    /// climb of the whole chain.
    ///
    /// Not the sharpest bound: it keeps the counts independent of improvements of the bounds that the search uses.
    pub(crate) fn counted_reach_m(&self, takeoff: &Station) -> f64 {
        let ground = self.relief().over(0..self.chain().geometry().vertices().len());
        let (drop_m, climb_m) = (takeoff.point.z_m - ground.lowest_m, ground.highest_m - takeoff.point.z_m);
        let [takeoff_m_s, landing_m_s] = [ground.takeoff_m_s, ground.landing_m_s].map(tolerant_speed_m_s);
        let g = self.gravity_m_s2();
        safe_m(takeoff_m_s, drop_m, g).min(safe_m(landing_m_s, climb_m, g)) * (1.0 + 1e-12)
    }

    /// A bound that shrinks with the ground inside it: starts with that of the whole chain and stops when it no longer
    /// changes much.
    fn shrunk_m(&self, from: &Station, towards: Direction, bound_m: impl Fn(Extremes) -> f64) -> f64 {
        /// A bound that shrinks by less than this factor is not worth another pass.
        const WORTH: f64 = 0.9;
        let vertices = self.chain().geometry().vertices().len();
        let mut reach_m = bound_m(self.relief().over(0..vertices));
        loop {
            let within_m = bound_m(self.relief().over(self.vertices_within(from, towards, reach_m))).min(reach_m);
            if within_m >= WORTH * reach_m {
                return within_m;
            }
            reach_m = within_m;
        }
    }

    /// The vertices whose segments contain the part of the chain from a station to a distance in a direction.
    fn vertices_within(&self, from: &Station, towards: Direction, distance_m: f64) -> Range<usize> {
        let vertices = self.chain().geometry().vertices();
        let here = match from.site {
            Site::Vertex(vertex) => vertex.index(),
            Site::Inside(segment) => segment.index(),
        };
        let away = |i: usize| (vertices[i].x_m - from.point.x_m).abs();
        // Doubling steps until one is beyond, then bisection: the part is short compared with the chain.
        let mut step = 1;
        match towards {
            Direction::Forward => {
                while here + step < vertices.len() && away(here + step) <= distance_m {
                    step *= 2;
                }
                let (near, far) = (here + step / 2, (here + step).min(vertices.len()));
                let beyond = near + vertices[near..far].partition_point(|v| (v.x_m - from.point.x_m).abs() <= distance_m);
                here..(beyond + 1).max(here + 2).min(vertices.len())
            }
            Direction::Reverse => {
                while step <= here && away(here - step) <= distance_m {
                    step *= 2;
                }
                let (far, near) = (here.saturating_sub(step), here - step / 2);
                let first = far + vertices[far..near].partition_point(|v| (v.x_m - from.point.x_m).abs() > distance_m);
                first.saturating_sub(1)..(here + 2).min(vertices.len())
            }
        }
    }
}
