//! The independent checker of a robot with legs: its feet, the directions in which they push, and its trunk in flight, each by another road than
//! the planner's.
//!
//! ```text
//!     feet       within reach of their limbs, on the mesh, and faced by their hips
//!     push       v = f_1 + ... + f_h with f_i in K_i: by forces on rays that are added one after another, until nothing of v is left
//!     trunk      Newton's equations in 2000 steps, turned evenly; no box meets a triangle by the separating-axis test
//! ```

use std::fmt;

use nalgebra::{Point3, UnitQuaternion, Vector3};

use super::{Hop, HopPath, pushes_again::left_of};
use crate::{
    ground::{Foothold, Stance, StanceGround},
    quantity::FacetId,
    terrain::Triangles,
    world::{Contact, Robot, tolerant_speed_m_s},
};

/// Steps of a flight at which the trunk is looked at.
const STEPS: u32 = 2_000;

/// What may be left of a direction of length 1 that the feet push in: the sums of forces come this near to one on the edge of its cone.
const LEFT: f64 = 1.0e-6;

/// A landing this share of the size of a flight beside its stance is one beside it by rounding.
const PLACE: f64 = 1.0e-9;

/// A box of the trunk is made smaller by this share of its size before it is tested: an arc on the edge of a window grazes.
const SHRUNK: f64 = 1.0e-6;

/// What a hop of a robot with legs violates.
#[derive(Clone, Debug, PartialEq)]
pub struct StanceViolation {
    /// Which hop, from 1.
    pub hop: usize,
    /// What.
    pub fault: StanceFault,
}

impl StanceViolation {
    /// The name of the limit that is broken.
    pub const fn limit(&self) -> &'static str {
        match self.fault {
            StanceFault::Elsewhere { .. } => "landing-point",
            StanceFault::Foot { .. } => "stance",
            StanceFault::Direction { .. } => "direction",
            StanceFault::Speed { contact: Contact::Takeoff, .. } => "takeoff-speed",
            StanceFault::Speed { contact: Contact::Landing, .. } => "landing-speed",
            StanceFault::Trunk { .. } => "terrain",
            StanceFault::Map { .. } => "map",
        }
    }
}

/// A fault of a hop between two stances.
#[derive(Clone, Debug, PartialEq)]
pub enum StanceFault {
    /// It does not begin or end at the root of its stance.
    Elsewhere {
        /// Take-off or landing.
        contact: Contact,
        /// How far away, m.
        away_m: f64,
    },
    /// A foot is not where its limb reaches, not on the ground, or on the wrong side of it.
    Foot {
        /// Take-off or landing.
        contact: Contact,
        /// The name of the limb.
        limb: String,
    },
    /// The feet do not push in the direction that the hop takes off in, or that stops its landing.
    Direction {
        /// Take-off or landing.
        contact: Contact,
        /// What is left of a unit of the direction.
        left: f64,
    },
    /// A speed above its limit.
    Speed {
        /// Take-off or landing.
        contact: Contact,
        /// The speed, m/s.
        speed_m_s: f64,
    },
    /// The trunk meets the ground in flight.
    Trunk {
        /// After this time, s.
        time_s: f64,
        /// Which box, from 1.
        part: usize,
        /// Which facet.
        facet: FacetId,
    },
    /// It flies over ground that is not known, or where a layer of its map does not hold.
    Map {
        /// After this time, s.
        time_s: f64,
    },
}

/// Flies the hops of a path again, each between its two stances; the violations, hop by hop, empty if it holds.
///
/// A robot that is a point has no feet and no trunk to look at: [`execute_over_mesh`](super::execute_over_mesh) flies it.
pub fn flown_by_stances(ground: &StanceGround, pairs: &[[&Stance; 2]], path: &HopPath) -> Vec<StanceViolation> {
    let hops = path.hops.iter().zip(pairs).enumerate();
    hops.flat_map(|(number, (hop, pair))| {
        let faults = faults(ground, *pair, hop);
        faults.into_iter().map(move |fault| StanceViolation { hop: number + 1, fault })
    })
    .collect()
}

fn faults(ground: &StanceGround, ends: [&Stance; 2], hop: &Hop) -> Vec<StanceFault> {
    let mut faults = Vec::new();
    let limits = ground.mesh().envelope().hopper().limits();
    let g = ground.mesh().envelope().gravity_m_s2();
    let (sine, cosine) = libm::sincos(hop.takeoff_angle.radians());
    let along = (ends[1].pose().root_m - ends[0].pose().root_m).xy().normalize();
    let liftoff = Vector3::new(along.x * cosine, along.y * cosine, sine) * hop.takeoff_speed_m_s;
    let fall = Vector3::new(0.0, 0.0, -g);
    let t = hop.flight_time_s;
    let (landed_m, touchdown) = (hop.takeoff.point_m + liftoff * t + fall * (0.5 * t * t), liftoff + fall * t);
    let size_m = (landed_m - hop.takeoff.point_m).norm().max(0.5 * g * t * t);
    let tolerance_m = PLACE * size_m + 4.0 * ground.mesh().tree().resolution_m();
    let starts = [(Contact::Takeoff, hop.takeoff.point_m, liftoff), (Contact::Landing, landed_m, -touchdown)];
    for ((contact, at_m, push), stance) in starts.into_iter().zip(ends) {
        let away_m = (at_m - stance.pose().root_m).norm();
        if away_m > tolerance_m {
            faults.push(StanceFault::Elsewhere { contact, away_m });
        }
        let feet = stance.footholds();
        let wrong = feet.iter().filter(|foot| !stands(ground, stance, foot));
        faults.extend(wrong.map(|foot| StanceFault::Foot { contact, limb: ground.robot().limbs()[foot.limb].name.clone() }));
        let left = left_of(push.normalize(), feet);
        if left > LEFT {
            faults.push(StanceFault::Direction { contact, left });
        }
        let most_m_s = match contact {
            Contact::Takeoff => limits.takeoff_speed_max_m_s,
            Contact::Landing => limits.arc_landing_speed_max_m_s(),
        };
        if push.norm() > tolerant_speed_m_s(most_m_s) * (1.0 + PLACE) {
            faults.push(StanceFault::Speed { contact, speed_m_s: push.norm() });
        }
    }
    let place = |time_s: f64| hop.takeoff.point_m + liftoff * time_s + fall * (0.5 * time_s * time_s);
    faults.extend(trunk_meets(ground, ends, t, place));
    faults.extend(map_refuses(ground, t, place));
    faults
}

/// The first step at which the root is over ground of a map that is not known, or where a layer asks for what is not there.
fn map_refuses(ground: &StanceGround, time_s: f64, place: impl Fn(f64) -> Point3<f64>) -> Option<StanceFault> {
    let terrain = ground.map()?.terrain();
    let triangles = Triangles::of(terrain.dem());
    let layers = terrain.overlays().layers();
    (0..=STEPS).map(|step| time_s * f64::from(step) / f64::from(STEPS)).find_map(|at_s| {
        let at = place(at_s).xy();
        let holds = layers.iter().filter(|layer| layer.rule().on_flight).all(|layer| layer.holds_at(at));
        let is_known = triangles.at(at, triangles.nominal()).is_some();
        (!holds || !is_known).then_some(StanceFault::Map { time_s: at_s })
    })
}

/// Whether a foot stands where the map of a DEM allows it, with no more friction than its raster has.
fn is_allowed(ground: &StanceGround, foot: &Foothold) -> bool {
    let Some(map) = ground.map() else { return true };
    let (overlays, at) = (map.terrain().overlays(), foot.point_m.xy());
    let is_out = overlays.zones().any(|zones| zones.keeps_out(at));
    let holds = overlays.layers().iter().filter(|layer| layer.rule().on_contact).all(|layer| layer.holds_at(at));
    let friction = overlays.friction_at(at).is_none_or(|most| foot.friction.coefficient() <= most.coefficient());
    !is_out && holds && friction
}

/// Whether a foot is within reach of its limb, on the mesh, and on the side of the ground that its hip faces.
fn stands(ground: &StanceGround, stance: &Stance, foot: &Foothold) -> bool {
    let limb = &ground.robot().limbs()[foot.limb];
    let back = stance.pose().turn.inverse();
    let in_trunk = Point3::from(back * (foot.point_m - stance.pose().root_m));
    // A point on the border of the workspace is within it but for rounding.
    let near_m = 1.0e-9 * (1.0 + ground.robot().reach_m());
    let inwards = Point3::from(in_trunk.coords + (limb.hip_m - in_trunk).normalize() * near_m);
    let reaches = limb.reaches(&in_trunk) || limb.reaches(&inwards);
    let tree = ground.mesh().tree();
    let is_on = tree.nearest(foot.point_m).distance_m <= 16.0 * tree.resolution_m();
    let [a, b, c] = tree.corners(foot.facet);
    let facet = (b - a).cross(&(c - a));
    let hip = stance.pose().root_m + stance.pose().turn * limb.hip_m.coords;
    let is_faced = facet.dot(&(hip - foot.point_m)) > 0.0 && foot.normal.dot(&facet) > 0.0;
    reaches && is_on && is_faced && is_allowed(ground, foot)
}

/// The first step at which a box of the trunk meets the ground.
fn trunk_meets(
    ground: &StanceGround,
    [from, to]: [&Stance; 2],
    time_s: f64,
    place: impl Fn(f64) -> Point3<f64>,
) -> Option<StanceFault> {
    let robot: &Robot = ground.robot();
    let shorter = to.pose().turn * from.pose().turn.inverse();
    let axis_angle = shorter.scaled_axis();
    for step in 0..=STEPS {
        let share = f64::from(step) / f64::from(STEPS);
        let at_m = place(time_s * share);
        let turn = UnitQuaternion::from_scaled_axis(axis_angle * share) * from.pose().turn;
        for (number, part) in robot.trunk().iter().enumerate() {
            let middle = at_m + turn * part.centre_m.coords;
            let edges = [0, 1, 2].map(|axis| turn * (part.axes * Vector3::ith(axis, part.half_m[axis] * (1.0 - SHRUNK))));
            let reach = edges.iter().fold(Vector3::zeros(), |sum, edge| sum + edge.abs());
            let (low, high) = (middle - reach, middle + reach);
            let mut met = None;
            ground.mesh().tree().visit(
                |min, max| (0..3).all(|i| min[i] <= high[i] && low[i] <= max[i]),
                |facet, corners| {
                    if met.is_none() && !are_apart(&edges, &corners.map(|corner| corner - middle)) {
                        met = Some(facet);
                    }
                },
            );
            if let Some(facet) = met {
                return Some(StanceFault::Trunk { time_s: time_s * share, part: number + 1, facet });
            }
        }
    }
    None
}

/// Whether a plane separates a box about the origin, by its half edges, and a triangle.
fn are_apart(edges: &[Vector3<f64>; 3], triangle: &[Vector3<f64>; 3]) -> bool {
    let sides = [triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]];
    let crosses = sides.iter().flat_map(|side| edges.iter().map(move |edge| edge.cross(side)));
    // The faces of a box are across its edges.
    let faces = edges.iter().copied().chain([sides[0].cross(&sides[1])]);
    faces.chain(crosses).any(|axis| {
        let reach: f64 = edges.iter().map(|edge| edge.dot(&axis).abs()).sum();
        let at = triangle.map(|corner| corner.dot(&axis));
        at[0].min(at[1]).min(at[2]) > reach || at[0].max(at[1]).max(at[2]) < -reach
    })
}

impl fmt::Display for StanceViolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let end = |contact: Contact| if contact == Contact::Takeoff { "take-off" } else { "landing" };
        write!(f, "hop {}: ", self.hop)?;
        match &self.fault {
            StanceFault::Elsewhere { contact, away_m } => {
                write!(f, "its {} is {away_m} m away from the root of its stance", end(*contact))
            }
            StanceFault::Foot { contact, limb } => {
                write!(f, "at {}, {limb} does not stand: out of reach, off the ground, on its inside, or kept out", end(*contact))
            }
            StanceFault::Direction { contact, left } => {
                write!(f, "the feet do not push in the direction of its {}, {left:.2e} of it is left", end(*contact))
            }
            StanceFault::Speed { contact, speed_m_s } => {
                write!(f, "its {} speed of {speed_m_s} m/s is above the limit", end(*contact))
            }
            StanceFault::Map { time_s } => {
                write!(f, "it flies over ground that is not known, or where a layer does not hold, after {time_s:.3} s")
            }
            StanceFault::Trunk { time_s, part, facet } => {
                write!(f, "box {part} of the trunk meets facet {} after {time_s:.3} s", facet.index() + 1)
            }
        }
    }
}
