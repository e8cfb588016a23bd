//! The picture of a stance.

use std::ops::ControlFlow;

use nalgebra::Vector3;

use super::{Stood, captions::title, conditions};
use crate::{
    figure::{Caption, FigureError, FootMark, Picture, StanceFigure, StandingRobot, draw_stance},
    ground::Stance,
    quantity::{ChainPoint, SlopeInterval},
    report::{StanceAnswer, heading_of},
    scenario::Scenario,
    terrain::VerticalPlane,
};

impl Stood {
    /// The picture: the robot from the side and from above, and the rose.
    ///
    /// # Errors
    /// As [`draw_stance`].
    pub fn picture(&self, scenario: &Scenario) -> Result<Picture, FigureError> {
        let robot = self.ground.robot().name();
        let result = match &self.answer.refusal {
            Some(refusal) => format!("{robot} does not stand: {refusal}"),
            None => verdict(&self.answer, robot),
        };
        let scenario = &Scenario { hopper: *self.ground.mesh().envelope().hopper(), ..scenario.clone() };
        draw_stance(&StanceFigure {
            caption: Caption { title: title("Stance", scenario), lines: vec![conditions(scenario), result] },
            robot: self.stance.as_ref().map(|stance| self.standing(stance)),
            rose: &self.answer.rose,
        })
    }

    fn standing(&self, stance: &Stance) -> StandingRobot {
        let pose = stance.pose();
        let heading_deg = self.answer.widest_beam.map_or(0.0, |beam| beam.heading_deg);
        let heading = heading_of(heading_deg);
        let plane = VerticalPlane { origin: pose.root_m, heading };
        let mut cut: Vec<[ChainPoint; 2]> = Vec::new();
        let _ = self.ground.mesh().tree().cut(
            &plane,
            |_| true,
            |_, segment| {
                cut.push(segment);
                ControlFlow::Continue(())
            },
        );
        let limbs = self.ground.robot().limbs();
        let feet = stance.footholds().iter().map(|foot| FootMark {
            hip_m: pose.turn * limbs[foot.limb].hip_m.coords,
            foot_m: foot.point_m - pose.root_m,
            normal: foot.normal,
        });
        let boxes = self.ground.robot().trunk().iter().map(|part| part.corners_m().map(|corner| pose.turn * corner.coords));
        StandingRobot {
            root_m: pose.root_m,
            boxes: boxes.collect::<Vec<[Vector3<f64>; 8]>>(),
            feet: feet.collect(),
            facing_deg: self.answer.pose.map_or(0.0, |pose| pose.heading_deg),
            heading_deg,
            cut,
            slopes: stance.cone().map_or(SlopeInterval::EMPTY, |cone| cone.takeoff_slopes(heading)),
        }
    }
}

/// The picture of contacts without a robot: the rose alone.
///
/// # Errors
/// As [`draw_stance`].
pub fn contacts_picture(answer: &StanceAnswer) -> Result<Picture, FigureError> {
    let caption = Caption { title: "Cone of contacts".to_owned(), lines: vec![verdict(answer, "the stance")] };
    draw_stance(&StanceFigure { caption, robot: None, rose: &answer.rose })
}

/// What a stance may do, in words.
fn verdict(answer: &StanceAnswer, name: &str) -> String {
    let closure = if answer.force_closure { "force closure" } else { "no force closure" };
    let weight = if answer.bears_weight { "bears its weight without slipping" } else { "slips under its weight" };
    let beam = answer
        .widest_beam
        .map_or(String::new(), |beam| format!(", widest beam {:.1} deg at heading {:.0} deg", beam.width_deg, beam.heading_deg));
    format!("{name}: {closure}, {weight}; take-offs in {:.0} % of headings{beam}", 100.0 * answer.usable_headings)
}
