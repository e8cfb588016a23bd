//! The joints from the trunk to a foot: forward kinematics, torques and rates.

use nalgebra::{Matrix3, Point3, Rotation3, Unit, Vector3};

use super::{Frame, JointKind, ModelJoint, frame::about};

/// A joint that moves, on the way to a foot.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainJoint {
    /// Its name.
    pub name: String,
    /// Whether it slides along its axis; else it turns about it.
    pub slides: bool,
    /// Its frame relative to that of the joint before it, or to the trunk.
    pub frame: Frame,
    /// Its axis in its own frame.
    pub axis: Unit<Vector3<f64>>,
    /// The least and the greatest position, rad or m; infinite of a continuous joint.
    pub range: [f64; 2],
    /// The greatest torque, N m, or force, N; `None` if none is stated.
    pub effort_max: Option<f64>,
    /// The greatest rate, rad/s or m/s; `None` if none is stated.
    pub rate_max: Option<f64>,
}

impl ChainJoint {
    pub(super) fn new(joint: &ModelJoint, frame: Frame) -> Self {
        let stated = |number: f64| (number > 0.0).then_some(number);
        let range =
            if joint.kind == JointKind::Continuous { [f64::NEG_INFINITY, f64::INFINITY] } else { [joint.lower, joint.upper] };
        Self {
            name: joint.name.clone(),
            slides: joint.kind == JointKind::Prismatic,
            frame,
            axis: joint.axis,
            range,
            effort_max: stated(joint.effort),
            rate_max: stated(joint.velocity),
        }
    }

    /// How far a position is from the middle of its range, as a share of the way to a limit: 1 at a limit, 0 in the middle and of a
    /// continuous joint.
    pub fn travel_share(&self, position: f64) -> f64 {
        let [low, high] = self.range;
        let half = 0.5 * (high - low);
        if !half.is_finite() {
            0.0
        } else if half == 0.0 {
            1.0
        } else {
            (position - (low + half)).abs() / half
        }
    }
}

/// The joints from the trunk to a foot.
#[derive(Clone, Debug, PartialEq)]
pub struct LimbChain {
    joints: Vec<ChainJoint>,
    /// The foot in the frame of the last joint, m.
    foot_m: Point3<f64>,
    length_m: f64,
}

impl LimbChain {
    pub(super) fn new(joints: Vec<ChainJoint>, foot_m: Point3<f64>) -> Self {
        let slides = |joint: &ChainJoint| if joint.slides { joint.range[0].abs().max(joint.range[1].abs()) } else { 0.0 };
        let between: f64 = joints.iter().skip(1).map(|joint| joint.frame.origin_m.norm()).sum();
        let length_m = between + joints.iter().map(slides).sum::<f64>() + foot_m.coords.norm();
        Self { joints, foot_m, length_m }
    }

    /// Its joints, from the trunk on.
    pub fn joints(&self) -> &[ChainJoint] {
        &self.joints
    }

    /// The greatest distance of the foot from the first joint if nothing limited the joints, m.
    pub const fn length_m(&self) -> f64 {
        self.length_m
    }

    /// Where the first joint is in the trunk frame, m: the hip.
    pub fn hip_m(&self) -> Point3<f64> {
        Point3::from(self.joints[0].frame.origin_m)
    }

    /// Where the foot is in the trunk frame, m.
    ///
    /// # Arguments
    /// `positions`: one a joint, rad or m; a joint without one is at 0.
    pub fn foot(&self, positions: &[f64]) -> Point3<f64> {
        let mut frame = Frame::identity();
        for (index, joint) in self.joints.iter().enumerate() {
            frame = frame.then(&joint.frame).then(&moved(joint, positions.get(index).copied().unwrap_or(0.0)));
        }
        frame.point(&self.foot_m)
    }

    /// Where the joints are in the trunk frame, m, from the trunk on, and then the foot.
    ///
    /// # Arguments
    /// `positions`: as of [`foot`](Self::foot).
    pub fn points(&self, positions: &[f64]) -> Vec<Point3<f64>> {
        let mut frame = Frame::identity();
        let mut points = Vec::with_capacity(self.joints.len() + 1);
        for (index, joint) in self.joints.iter().enumerate() {
            frame = frame.then(&joint.frame);
            points.push(Point3::from(frame.origin_m));
            frame = frame.then(&moved(joint, positions.get(index).copied().unwrap_or(0.0)));
        }
        points.push(frame.point(&self.foot_m));
        points
    }

    /// Where the foot is, and the Jacobian by its columns: how the foot moves with each joint, m/rad or m/m.
    ///
    /// ```text
    ///     turning: axis x (foot - joint),   sliding: axis
    /// ```
    pub fn jacobian(&self, positions: &[f64]) -> (Point3<f64>, Vec<Vector3<f64>>) {
        let mut frame = Frame::identity();
        let mut axes = Vec::with_capacity(self.joints.len());
        for (index, joint) in self.joints.iter().enumerate() {
            frame = frame.then(&joint.frame);
            axes.push((frame.axes * joint.axis.into_inner(), frame.origin_m));
            frame = frame.then(&moved(joint, positions.get(index).copied().unwrap_or(0.0)));
        }
        let foot = frame.point(&self.foot_m);
        let column = |(joint, (axis, at)): (&ChainJoint, &(Vector3<f64>, Vector3<f64>))| {
            if joint.slides { *axis } else { axis.cross(&(foot.coords - at)) }
        };
        (foot, self.joints.iter().zip(&axes).map(column).collect())
    }

    /// The torques, N m, or forces, N, of the joints that hold a force of the ground on the foot, N in the trunk frame: `-J^T f`. The weight of the
    /// limb itself is left out.
    pub fn efforts(&self, positions: &[f64], force_n: &Vector3<f64>) -> Vec<f64> {
        self.jacobian(positions).1.iter().map(|column| -column.dot(force_n)).collect()
    }

    /// The greatest effort of these as a share of its joint's limit; 0 if no joint states one.
    pub fn effort_share(&self, positions: &[f64], force_n: &Vector3<f64>) -> f64 {
        share(&self.efforts(positions, force_n), self.joints.iter().map(|joint| joint.effort_max))
    }

    /// The rates of the joints, rad/s or m/s, that move the foot at a velocity relative to the trunk, m/s, of least sum of squares. A limb that is
    /// stretched or folded does not move in all directions: what it cannot do is left out, by a slight damping.
    pub fn rates(&self, positions: &[f64], velocity_m_s: &Vector3<f64>) -> Vec<f64> {
        let columns = self.jacobian(positions).1;
        let square = columns.iter().map(|column| column * column.transpose()).sum::<Matrix3<f64>>();
        // Far below what a leg that is not singular has: it only keeps the inverse finite.
        let damping = 1e-6 * self.length_m.max(f64::MIN_POSITIVE);
        let inverse = (square + Matrix3::identity() * damping * damping).try_inverse().unwrap_or_else(Matrix3::zeros);
        let solved = inverse * velocity_m_s;
        columns.iter().map(|column| column.dot(&solved)).collect()
    }

    /// The greatest rate of these as a share of its joint's limit; 0 if no joint states one.
    pub fn rate_share(&self, positions: &[f64], velocity_m_s: &Vector3<f64>) -> f64 {
        share(&self.rates(positions, velocity_m_s), self.joints.iter().map(|joint| joint.rate_max))
    }
}

/// The motion of a joint.
fn moved(joint: &ChainJoint, position: f64) -> Frame {
    let axis = joint.axis.into_inner();
    if joint.slides {
        Frame { axes: Rotation3::identity(), origin_m: axis * position }
    } else {
        Frame { axes: about(&axis, position), origin_m: Vector3::zeros() }
    }
}

fn share(amounts: &[f64], limits: impl Iterator<Item = Option<f64>>) -> f64 {
    let shares = amounts.iter().zip(limits).filter_map(|(amount, limit)| Some(amount.abs() / limit?));
    shares.fold(0.0, f64::max)
}
