//! A robot with legs in a pose, as it is drawn, and the pictures of its key postures.

use std::ops::ControlFlow;

use nalgebra::{Point3, Vector2, Vector3};

use super::{LegsRouted, captions::title, conditions};
use crate::{
    figure::{
        Caption, FigureError, LimbMark, POSTURE_ROWS_MAX, Picture, PostureMark, PostureRow, PosturesFigure, RobotMark,
        draw_postures,
    },
    ground::{Pose, Stance, StanceGround},
    path::{PostureKind, StanceFlight},
    quantity::ChainPoint,
    scenario::Scenario,
    terrain::VerticalPlane,
    world::{Limb, Workspace},
};

/// How far a limb that is drawn in is stretched, as a share of what its workspace allows.
const DRAWN_IN: f64 = 0.4;

/// A robot in a pose, with the ground in the vertical plane through its root along a heading. `feet`: the limbs that stand, and where, m.
pub(super) fn robot_mark(ground: &StanceGround, pose: &Pose, feet: &[(usize, Point3<f64>)], heading: Vector2<f64>) -> RobotMark {
    let robot = ground.robot();
    let plane = VerticalPlane { origin: pose.root_m, heading };
    let near_m = 3.0 * (robot.reach_m() + robot.trunk_radius_m());
    let mut cut: Vec<[ChainPoint; 2]> = Vec::new();
    let _ = ground.mesh().tree().cut(
        &plane,
        |[low, high]| high.x_m >= -near_m && low.x_m <= near_m,
        |_, segment| {
            cut.push(segment);
            ControlFlow::Continue(())
        },
    );
    let limbs = robot.limbs().iter().enumerate().map(|(number, limb)| {
        let stands_at = feet.iter().find(|(stands, _)| *stands == number).map(|(_, point)| pose.to_trunk(point));
        let target = stands_at.unwrap_or_else(|| drawn_in(limb));
        let points =
            ground.chain(number).map_or_else(|| vec![limb.hip_m, target], |chain| chain.points(&chain.reach(&target).positions));
        let points_m = points.iter().map(|point| pose.turn * point.coords).collect();
        LimbMark { points_m, normal: None, stands: stands_at.is_some() }
    });
    let boxes = robot.trunk().iter().map(|part| part.corners_m().map(|corner| pose.turn * corner.coords));
    RobotMark { boxes: boxes.collect::<Vec<[Vector3<f64>; 8]>>(), limbs: limbs.collect(), cut }
}

/// Where the foot of a limb is that is drawn in, in the trunk frame.
fn drawn_in(limb: &Limb) -> Point3<f64> {
    match &limb.workspace {
        Workspace::Shell(shell) => {
            let [least, most] = [shell.radius_min_m(), shell.radius_max_m()];
            limb.hip_m + shell.axis().into_inner() * (least + DRAWN_IN * (most - least))
        }
        Workspace::Convex(convex) => {
            let [low, high] = convex.bounds();
            limb.hip_m + (nalgebra::center(&low, &high) - limb.hip_m) * DRAWN_IN.sqrt()
        }
    }
}

impl LegsRouted {
    /// The picture of the key postures of its hops, from one on as many as fit a page; `None` without a path. `first`: the first hop, from 1.
    pub fn postures_picture(&self, scenario: &Scenario, first: usize) -> Option<Result<Picture, FigureError>> {
        let (path, found) = (self.path.as_ref()?, self.grown.route.path.as_ref()?);
        let stances: Vec<&Stance> = found.contacts.iter().map(|node| self.grown.roadmap.contact(*node)).collect();
        let pairs = found.takeoffs().into_iter().map(|at| [stances[at], stances[at + 1]]);
        let hops = path.hops.iter().zip(pairs).enumerate().skip(first.saturating_sub(1)).take(POSTURE_ROWS_MAX);
        let rows: Vec<PostureRow> = hops
            .map(|(number, (hop, ends))| {
                let flight = StanceFlight::new(&self.ground, ends, hop);
                let heading = crate::report::heading_of(hop.heading_deg);
                let postures = flight.postures().map(|posture| PostureMark {
                    name: match posture.kind {
                        PostureKind::Takeoff => posture.kind.name().to_owned(),
                        kind => format!("{}, {:.2} s", kind.name(), posture.time_s),
                    },
                    robot: robot_mark(&self.ground, &posture.pose, &posture.feet, heading),
                });
                let title = format!(
                    "Hop {} of {}, heading {:.0} deg, take-off at {:.1} deg with {:.2} m/s",
                    number + 1,
                    path.hops.len(),
                    hop.heading_deg,
                    hop.takeoff_angle.degrees(),
                    hop.takeoff_speed_m_s
                );
                PostureRow { title, heading_deg: hop.heading_deg, postures: postures.into() }
            })
            .collect();
        let scenario = Scenario { hopper: *self.ground.mesh().envelope().hopper(), ..scenario.clone() };
        let joints = if self.ground.has_joints() {
            "limbs by their joints where they are known"
        } else {
            "limbs as lines from hip to foot: their joints are not known"
        };
        let shown = format!("hops {first} to {} of {}; {joints}", first + rows.len().max(1) - 1, path.hops.len());
        let caption = Caption { title: title("Key postures", &scenario), lines: vec![conditions(&scenario), shown] };
        Some(draw_postures(&PosturesFigure { caption, rows }))
    }
}
