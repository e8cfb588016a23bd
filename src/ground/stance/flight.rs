//! The windows of a hop from one stance to another.
//!
//! ```text
//!     a piece from share a to share b: the root between a X and b X from the take-off, the trunk turned to the middle of the piece, its
//!     boxes grown on every side by r theta (b - a) / 2: r the distance of the farthest corner from the root, theta the whole turn
//! ```

use std::ops::ControlFlow;

use nalgebra::Vector3;

use super::{Pose, Stance, StanceBuffers, StanceGround};
use crate::{
    ballistics::{
        Arc, LineOfSight,
        limits::{BoxBorder, FlownBox, blocked_lofts_of_box, border_of_box},
    },
    ground::{
        MeshCourse, MeshTakeoffSet,
        mesh::{BlockedLofts, LeastRoom},
    },
    hop::envelope_limits,
    quantity::{ChainPoint, SlopeInterval, part_between},
    terrain::VerticalPlane,
    world::{Contact, Limit, TrunkBox},
};

/// The greatest turn of the trunk within a piece of an arc, rad: ten degrees.
const TURN_OF_PIECE: f64 = 0.174_532_925_199_432_95;

/// How often the pieces are halved towards take-off and landing.
const HALVED: i32 = 7;

/// A trunk over a piece of an arc.
#[derive(Clone, Debug)]
struct FlownTrunk {
    /// Where the root is, m from the take-off.
    between_m: [f64; 2],
    boxes: Vec<FlownBox>,
    /// The least and the greatest coordinates of the corners of its boxes, m from the root.
    bounds_m: [Vector3<f64>; 2],
}

impl StanceGround {
    /// The course of a hop; `None` where one root is right over the other.
    pub fn course(&self, takeoff: &Stance, landing: &Stance) -> Option<MeshCourse> {
        if let (Some(from), Some(to)) = (takeoff.point(), landing.point()) {
            return self.mesh().course(from, to);
        }
        let origin = takeoff.pose().root_m;
        let away = landing.pose().root_m - origin;
        let run_m = (away.x * away.x + away.y * away.y).sqrt();
        if run_m <= self.mesh().tree().resolution_m() {
            return None;
        }
        let heading = away.xy() / run_m;
        Some(MeshCourse { plane: VerticalPlane { origin, heading }, sight: LineOfSight::new(run_m, away.z) })
    }

    /// The feasible windows of a hop, as lofts over its line of sight, ascending and disjoint; none if no arc is feasible, and `None` for
    /// a vertical hop.
    pub fn windows<'b>(
        &self,
        takeoff: &Stance,
        landing: &Stance,
        buffers: &'b mut StanceBuffers,
    ) -> Option<(LineOfSight, &'b [SlopeInterval])> {
        if let (Some(from), Some(to)) = (takeoff.point(), landing.point()) {
            if self.refused_by_map([takeoff, landing]).is_some() {
                return Some((self.mesh().course(from, to)?.sight, &[]));
            }
            return self.mesh().windows(from, to, &mut buffers.mesh);
        }
        buffers.mesh.free.clear();
        let course = self.course(takeoff, landing)?;
        let sight = course.sight;
        if !self.mesh().speed_bounds().span(sight.length_m(), sight.rise_m()) {
            return Some((sight, &[]));
        }
        let heading = course.plane.heading;
        let [from, to] =
            [(takeoff, Contact::Takeoff), (landing, Contact::Landing)].map(|(at, kind)| self.allowed(at, heading, kind));
        let envelope = self.mesh().envelope();
        let lofts = envelope.lofts(sight, from, to);
        let within = SlopeInterval { lower: lofts.lower.max(0.0), upper: lofts.upper };
        if lofts.is_empty() || within.upper <= 0.0 || self.refused_by_map([takeoff, landing]).is_some() {
            return Some((sight, &[]));
        }
        self.block(&course, [takeoff.pose(), landing.pose()], within, &mut buffers.mesh.blocked);
        let (speeds, gravity) = (envelope.takeoff_speeds(), envelope.gravity_m_s2());
        for part in buffers.mesh.blocked.free_in(within) {
            buffers.mesh.free.extend(speeds.windows(sight, part.lofts, gravity).map(|window| window.lofts));
        }
        if self.limits_pushes() {
            let ends = [takeoff, landing];
            buffers.mesh.free.retain_mut(|lofts| match self.pushable(ends, (heading, sight), *lofts) {
                Ok((allowed, _)) => {
                    *lofts = allowed;
                    true
                }
                Err(_) => false,
            });
        }
        Some((sight, &buffers.mesh.free))
    }

    /// The feasible take-off set of a hop with each limit by itself; `None` for a vertical hop.
    pub fn takeoff_set(&self, takeoff: &Stance, landing: &Stance) -> Option<MeshTakeoffSet> {
        let set = self.set_over_mesh(takeoff, landing)?;
        match self.refused_by_map([takeoff, landing]) {
            Some(limit) => Some(set.narrowed(|_| Err(limit))),
            None => Some(set),
        }
    }

    /// The limit of the map that refuses a flight, if one does.
    fn refused_by_map(&self, ends: [&Stance; 2]) -> Option<Limit> {
        self.map()?.refuses_flight(ends.map(|stance| stance.pose().root_m.xy()), self.robot().trunk_radius_m())
    }

    /// The feasible take-off set by all limits but those of the map.
    fn set_over_mesh(&self, takeoff: &Stance, landing: &Stance) -> Option<MeshTakeoffSet> {
        if let (Some(from), Some(to)) = (takeoff.point(), landing.point()) {
            return self.mesh().takeoff_set(from, to);
        }
        let course = self.course(takeoff, landing)?;
        let heading = course.plane.heading;
        let [from, to] =
            [(takeoff, Contact::Takeoff), (landing, Contact::Landing)].map(|(at, kind)| self.allowed(at, heading, kind));
        let limits = envelope_limits(self.mesh().envelope(), course.sight, Ok(from), Ok(to));
        let mut blocked = BlockedLofts::default();
        self.block(&course, [takeoff.pose(), landing.pose()], SlopeInterval { lower: 0.0, upper: f64::INFINITY }, &mut blocked);
        let set = self.mesh().set_of(course, limits, &blocked);
        if !self.limits_pushes() {
            return Some(set);
        }
        let ends = [takeoff, landing];
        Some(set.narrowed(|lofts| self.pushable(ends, (heading, course.sight), lofts)))
    }

    /// Which lofts of an interval the ground blocks for the trunk. The search ends where it blocks all.
    fn block(&self, course: &MeshCourse, poses: [&Pose; 2], within: SlopeInterval, blocked: &mut BlockedLofts) {
        blocked.clear();
        let (sight, clearance) = (course.sight, self.mesh().envelope().clearance());
        let (radius_m, trunks) = self.trunks(course, poses);
        let near_m = self.mesh().tree().resolution_m();
        let farthest_m = trunks.iter().flat_map(|trunk| trunk.bounds_m).map(|bound| bound.x.abs()).fold(0.0, f64::max);
        let shared = std::cell::RefCell::new(blocked);
        let enters = |rectangle| self.mesh().may_block(course, rectangle, within, &shared.borrow());
        let _ = self.mesh().tree().beside(&course.plane, radius_m, enters, |facet, corners| {
            let triangle = corners.map(|corner| course.plane.framed(corner));
            let around = [triangle[0].inf(&triangle[1]).inf(&triangle[2]), triangle[0].sup(&triangle[1]).sup(&triangle[2])];
            let mut blocked = shared.borrow_mut();
            let may_block = |bounds_m, between_m, blocked: &BlockedLofts| {
                met_within(around, bounds_m, between_m, near_m)
                    .is_some_and(|rectangle| self.mesh().may_block(course, rectangle, within, blocked))
            };
            // The pieces follow one another along the hop.
            let [first_m, last_m] = [around[0].x - farthest_m - near_m, around[1].x + farthest_m + near_m];
            let first = trunks.partition_point(|trunk| trunk.between_m[1] < first_m);
            for trunk in trunks[first..].iter().take_while(|trunk| trunk.between_m[0] <= last_m) {
                if !may_block(trunk.bounds_m, trunk.between_m, &blocked) {
                    continue;
                }
                for part in &trunk.boxes {
                    if trunk.boxes.len() == 1 || may_block(part.bounds_m(), trunk.between_m, &blocked) {
                        blocked.insert(blocked_lofts_of_box(sight, &triangle, part, trunk.between_m, clearance), facet);
                    }
                }
            }
            if blocked.covers(within) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
    }

    /// How much farther from the ground over and under its trunk a robot flies, vertically, than the clearance asks for, where that is least:
    /// the distance, m, and how far that is from the take-off, m. `None` where no ground is over or under the trunk.
    pub fn least_room(&self, course: &MeshCourse, [takeoff, landing]: [&Stance; 2], arc: &Arc) -> Option<(f64, f64)> {
        if takeoff.point().is_some() {
            return self.mesh().least_room(course, arc);
        }
        let (run_m, near_m) = (course.sight.run_m(), self.mesh().tree().resolution_m());
        let (radius_m, trunks) = self.trunks(course, [takeoff.pose(), landing.pose()]);
        let mut room = LeastRoom::new(arc, self.mesh().envelope().clearance(), near_m);
        let mut buffer: BoxBorder = std::array::from_fn(|_| ChainPoint::new(0.0, 0.0));
        let enters = |[low, high]: [ChainPoint; 2]| high.x_m >= 0.0 && low.x_m <= run_m;
        let _ = self.mesh().tree().beside(&course.plane, radius_m, enters, |_, corners| {
            let triangle = corners.map(|corner| course.plane.framed(corner));
            for trunk in &trunks {
                for part in &trunk.boxes {
                    let border = border_of_box(&triangle, part, &mut buffer);
                    for (i, from) in border.iter().enumerate() {
                        if let Some([from, to]) = part_between(trunk.between_m, [*from, border[(i + 1) % border.len()]]) {
                            room.beside(from, to);
                        }
                    }
                }
            }
            ControlFlow::Continue(())
        });
        room.found()
    }

    /// The trunk over the pieces of a hop, and the distance of its farthest corner from the root.
    fn trunks(&self, course: &MeshCourse, [from, to]: [&Pose; 2]) -> (f64, Vec<FlownTrunk>) {
        let robot = self.robot();
        let corner_m = robot.trunk_radius_m();
        let turn = if corner_m > 0.0 { from.turn.angle_to(&to.turn) } else { 0.0 };
        let shares = shares_of(turn);
        let point = [TrunkBox::upright(nalgebra::Point3::origin(), Vector3::zeros())];
        let parts = if robot.trunk().is_empty() { &point[..] } else { robot.trunk() };
        let run_m = course.sight.run_m();
        let mut most_m: f64 = 0.0;
        let trunks = shares.windows(2).map(|piece| {
            let grown_m = 0.5 * corner_m * turn * (piece[1] - piece[0]);
            most_m = most_m.max(grown_m);
            let turn = from.turned_towards(to, f64::midpoint(piece[0], piece[1]));
            let framed = |direction: Vector3<f64>| course.plane.turned(turn * direction);
            let boxes = parts.iter().map(|part| {
                let half = part.half_m.add_scalar(grown_m);
                let edges = [0, 1, 2].map(|axis| framed(part.axes * Vector3::ith(axis, half[axis])));
                FlownBox::new(framed(part.centre_m.coords), edges)
            });
            let boxes: Vec<FlownBox> = boxes.collect();
            let bounds_m = boxes.iter().map(FlownBox::bounds_m).reduce(|a, b| [a[0].inf(&b[0]), a[1].sup(&b[1])]);
            let end_m = if piece[1] == 1.0 { run_m } else { run_m * piece[1] };
            // A trunk has a box, or is a point.
            let bounds_m = bounds_m.unwrap_or([Vector3::zeros(); 2]);
            FlownTrunk { between_m: [run_m * piece[0], end_m], boxes, bounds_m }
        });
        let trunks = trunks.collect();
        // A corner of a grown box is farther out by at most the diagonal of what it grew by.
        (corner_m + 3.0_f64.sqrt() * most_m, trunks)
    }
}

/// A rectangle of the plane of travel that holds the places of the root, between two distances from the take-off, at which what has some bounds
/// about the root meets what is within others; `None` if it never does. It is larger by the resolution of the mesh, so that neither rounding nor
/// what only touches is lost.
fn met_within(
    [low, high]: [Vector3<f64>; 2],
    [from_root, to_root]: [Vector3<f64>; 2],
    [begin_m, end_m]: [f64; 2],
    near_m: f64,
) -> Option<[ChainPoint; 2]> {
    let [low, high] = [(low - to_root).add_scalar(-near_m), (high - from_root).add_scalar(near_m)];
    let [first_m, last_m] = [low.x.max(begin_m), high.x.min(end_m)];
    let meets = low.y <= 0.0 && high.y >= 0.0 && first_m <= last_m;
    meets.then(|| [ChainPoint::new(first_m, low.z), ChainPoint::new(last_m, high.z)])
}

/// The shares of a flight at which its pieces begin and end: halved towards take-off and landing, where the trunk is near to the ground, and such
/// that it turns by at most [`TURN_OF_PIECE`] in any.
fn shares_of(turn: f64) -> Vec<f64> {
    if turn == 0.0 {
        return vec![0.0, 1.0];
    }
    let halved = (1..=HALVED).rev().map(|power| 0.5_f64.powi(power));
    let first: Vec<f64> = std::iter::once(0.0).chain(halved).collect();
    let ends = first.iter().copied().chain(first.iter().rev().skip(1).map(|share| 1.0 - share));
    let ends: Vec<f64> = ends.collect();
    let mut shares = vec![0.0];
    for pair in ends.windows(2) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 9 pieces of a quarter of a turn")]
        let pieces = (turn * (pair[1] - pair[0]) / TURN_OF_PIECE).ceil().max(1.0) as u32;
        shares.extend((1..pieces).map(|piece| pair[0] + (pair[1] - pair[0]) * f64::from(piece) / f64::from(pieces)));
        shares.push(pair[1]);
    }
    shares
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot prepare its mesh should stop")]

    use nalgebra::{Point3, Vector2};

    use super::*;
    use crate::{
        ballistics::stance::ConeKind,
        draw::Draw,
        ground::{MeshGround, StandsUp},
        quantity::FacetId,
        terrain::{Mesh, MeshTree},
        world::{
            FrictionCone, Gravity, Grip, Hopper, Limb, RestSlope, Robot, RobotDescription, Shell, SurfaceProperties, Workspace,
        },
    };

    /// A robot with one limb and a trunk of so many boxes, over triangles that lie anyhow.
    fn among_triangles(draw: &mut Draw, boxes: usize) -> StanceGround {
        let count = 2 + draw.below(60);
        let vertices = (0..count).flat_map(|_| {
            let middle = Point3::new(draw.uniform(-6.0, 6.0), draw.uniform(-6.0, 6.0), draw.uniform(-2.0, 4.0));
            let size_m = draw.uniform(0.01, 2.0);
            [(); 3].map(|()| middle + Vector3::from_fn(|_, _| draw.uniform(-size_m, size_m)))
        });
        let vertices: Vec<Point3<f64>> = vertices.collect();
        let triangles = (0..u32::try_from(count).unwrap()).map(|at| [3 * at, 3 * at + 1, 3 * at + 2]).collect();
        let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.8).unwrap())), rest: RestSlope::Unlimited };
        let hopper = Hopper::with_speeds(9.0, 9.0).unwrap();
        let tree = MeshTree::new(Mesh::new(vertices, triangles).unwrap());
        let mesh = MeshGround::new(tree, &hopper, Gravity::new(1.62).unwrap(), &surface).unwrap();
        let shell = Shell::new(0.2, 0.4, -Vector3::z_axis(), crate::quantity::Angle::from_degrees(50.0));
        let limbs = vec![Limb::new("leg", Point3::origin(), Workspace::Shell(shell))];
        let part = |draw: &mut Draw| {
            let middle = Point3::from(Vector3::from_fn(|_, _| draw.uniform(-0.4, 0.4)));
            TrunkBox::upright(middle, Vector3::from_fn(|_, _| draw.uniform(0.0, 0.5)))
        };
        let trunk = (0..boxes).map(|_| part(draw)).collect();
        let robot = Robot::new(RobotDescription { trunk, contacts_min: 1, ..RobotDescription::new("jumper", limbs) }).unwrap();
        StanceGround::new(mesh, robot, ConeKind::Exact, StandsUp::Normal).unwrap()
    }

    /// The lofts of an interval that are left, by every box of every piece against every facet.
    fn plainly_free(ground: &StanceGround, course: &MeshCourse, poses: [&Pose; 2], within: SlopeInterval) -> Vec<SlopeInterval> {
        let (_, trunks) = ground.trunks(course, poses);
        let mut blocked = BlockedLofts::default();
        for (facet, corners) in ground.mesh().tree().mesh().triangles().enumerate() {
            let triangle = corners.map(|corner| course.plane.framed(corner));
            for trunk in &trunks {
                for part in &trunk.boxes {
                    let lofts =
                        blocked_lofts_of_box(course.sight, &triangle, part, trunk.between_m, ground.mesh().envelope().clearance());
                    blocked.insert(lofts, FacetId(facet));
                }
            }
        }
        blocked.free_in(within).map(|part| part.lofts).collect()
    }

    #[test]
    fn what_is_left_out_blocks_nothing() {
        let draw = &mut Draw::seeded(20);
        let (mut some_free, mut none_free, mut cut) = (0, 0, 0);
        for case in 0..3_000 {
            let ground = among_triangles(draw, case % 4);
            let mut pose = || {
                let root = Point3::new(draw.uniform(-6.0, 6.0), draw.uniform(-6.0, 6.0), draw.uniform(-2.0, 4.0));
                let up = Vector3::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), 1.0).normalize();
                let (sine, cosine) = draw.uniform(0.0, std::f64::consts::TAU).sin_cos();
                Pose::facing(root, up, Vector2::new(cosine, sine))
            };
            let [from, to] = [pose(), pose()];
            let away = to.root_m - from.root_m;
            let run_m = away.xy().norm();
            let plane = VerticalPlane { origin: from.root_m, heading: away.xy() / run_m };
            let course = MeshCourse { plane, sight: LineOfSight::new(run_m, away.z) };
            let low = draw.uniform(0.0, 2.0);
            let within = [
                SlopeInterval { lower: low, upper: low + draw.uniform(0.0, 4.0) },
                SlopeInterval { lower: 0.0, upper: f64::INFINITY },
            ];
            for within in within {
                let mut blocked = BlockedLofts::default();
                ground.block(&course, [&from, &to], within, &mut blocked);
                let free: Vec<SlopeInterval> = blocked.free_in(within).map(|part| part.lofts).collect();
                assert_eq!(free, plainly_free(&ground, &course, [&from, &to], within), "case {case}");
                some_free += usize::from(!free.is_empty());
                none_free += usize::from(free.is_empty());
                cut += usize::from(!free.is_empty() && free != [within]);
            }
        }
        assert!(some_free > 1_000 && none_free > 100 && cut > 1_000, "{some_free} {none_free} {cut}");
    }
}
