//! The picture of a stance.

use super::{Stood, captions::title, conditions, robot_mark::robot_mark};
use crate::{
    figure::{Caption, FigureError, Picture, StanceFigure, StandingRobot, draw_stance},
    ground::Stance,
    quantity::SlopeInterval,
    report::{StanceAnswer, heading_of},
    scenario::Scenario,
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
        let heading_deg = self.answer.widest_beam.map_or(0.0, |beam| beam.heading_deg);
        let heading = heading_of(heading_deg);
        let feet: Vec<_> = stance.footholds().iter().map(|foot| (foot.limb, foot.point_m)).collect();
        let mut robot = robot_mark(&self.ground, stance.pose(), &feet, heading);
        // Those that do not stand are named in the answer.
        robot.limbs.retain(|limb| limb.stands);
        for (limb, foot) in robot.limbs.iter_mut().zip(stance.footholds()) {
            limb.normal = Some(foot.normal);
        }
        StandingRobot {
            robot,
            facing_deg: self.answer.pose.map_or(0.0, |pose| pose.heading_deg),
            heading_deg,
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
