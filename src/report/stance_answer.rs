//! Where and how a robot with legs stands, and which way it may jump from there, as plain data and text.

use nalgebra::{Vector2, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    FootJointsRecord, PushRecord,
    text::{Sheet, place},
};
use crate::{
    ballistics::stance::{ConeKind, ConeSum, ContactCone, spin_free_cut},
    ground::{Foothold, LimbOutcome, NoStance, Pose, Stance, StanceGround},
    quantity::{Angle, SlopeInterval},
};

/// The answer of `chta stance`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StanceAnswer {
    /// The name of the robot; null for contacts alone.
    pub robot: Option<String>,
    /// Whether it stands.
    pub stands: bool,
    /// Why it does not, a sentence; null if it does.
    pub refusal: Option<String>,
    /// How many poses were tried, and why those that gave no stance did not; null for contacts alone.
    pub poses: Option<TriedPoses>,
    /// The pose of the trunk; null if no pose was tried.
    pub pose: Option<PoseRecord>,
    /// Every limb, and where its foot stands; for contacts alone one for each.
    pub contacts: Vec<FootRecord>,
    /// Whether the feet can push in every direction, whatever the force.
    pub force_closure: bool,
    /// Whether the feet bear its weight without slipping: straight up lies in the cone.
    pub bears_weight: bool,
    /// Whether it need not topple at rest: its weight is borne without a moment about the centre of mass. Null for contacts alone.
    pub upright: Option<bool>,
    /// The forces on the feet of a robot at rest, and what they ask of its joints; absent where its mass is not known, and where its feet do not bear it
    /// without slipping and toppling.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest: Option<PushRecord>,
    /// Of the headings of the rose, the share in which it may take off.
    pub usable_headings: f64,
    /// The share in which it may take off without any spin; null for contacts alone.
    pub spin_free_headings: Option<f64>,
    /// The widest beam of take-off angles; null without one.
    pub widest_beam: Option<BeamRecord>,
    /// The take-off angles in every heading, by the exact cone and two that lie inside it.
    pub rose: Vec<RoseRecord>,
}

/// What became of the poses that were tried.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct TriedPoses {
    /// All.
    pub tried: u64,
    /// In which the robot stands.
    pub stand: u64,
    /// In which the trunk meets the ground, or the root lies inside it.
    pub trunk: u64,
    /// In which too few feet stand.
    pub too_few_contacts: u64,
    /// Whose cone holds no direction, or does not bear the weight.
    pub cone: u64,
}

/// A pose of the trunk.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PoseRecord {
    /// The root, [x, y, z], m.
    pub root_m: [f64; 3],
    /// Its up axis.
    pub up: [f64; 3],
    /// The heading of its forward axis, degrees clockwise from +y.
    pub heading_deg: f64,
    /// How far the root is over the place on the surface, along up, m; null for a pose that was given as such.
    pub height_m: Option<f64>,
}

/// A foot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FootRecord {
    /// The name of the limb; null for contacts alone.
    pub limb: Option<String>,
    /// What became of it: `stands`, `no_ground`, `ground_faces_away`, `ground_hidden`, `kept_out`, `same_place` or `no_friction`.
    pub outcome: LimbOutcome,
    /// Where it stands, [x, y, z], m; null if it does not, and where it is not stated.
    pub position_m: Option<[f64; 3]>,
    /// The normal of the ground there.
    pub normal: Option<[f64; 3]>,
    /// The lesser of the frictions of the ground and of the foot.
    pub friction_coefficient: Option<f64>,
    /// The greatest angle between that normal and one of the facets within reach that it stands for, degrees.
    pub spread_deg: Option<f64>,
    /// The normal of that facet: the worst that the foot may meet, where the mean hides a ridge.
    pub worst_normal: Option<[f64; 3]>,
    /// Their area, m^2.
    pub area_m2: Option<f64>,
    /// The joints that put it there; absent where they are not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joints: Option<FootJointsRecord>,
}

/// The widest beam.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BeamRecord {
    /// In which heading, degrees clockwise from +y.
    pub heading_deg: f64,
    /// How wide, degrees.
    pub width_deg: f64,
}

/// The take-off angles in one heading.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RoseRecord {
    /// Degrees clockwise from +y.
    pub heading_deg: f64,
    /// By the one cone of Campana and others about the sum of the normals, with the least friction; null if it has none.
    pub kc: Option<ElevationRecord>,
    /// By the widest cone about the same axis that is proved to lie inside.
    pub kc_plus: Option<ElevationRecord>,
    /// By the exact sum of the cones of the feet.
    pub k: Option<ElevationRecord>,
    /// Of a robot, those take-offs without spin: the forces of the feet leave no angular momentum about the centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spin_free: Option<ElevationRecord>,
    /// Of a robot, in the middle of the beam `k`: the least angular momentum for each kg and each m/s of the take-off, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub least_spin_m: Option<f64>,
    /// Of a robot with stroke, mass and forces, in the middle of the beam `k`: the greatest take-off speed that they allow, m/s; absent where no
    /// push along it is possible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub push_speed_max_m_s: Option<f64>,
}

/// An interval of take-off angles over the horizontal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ElevationRecord {
    /// The least; -90 where straight down lies inside or beyond.
    pub takeoff_angle_min_deg: f64,
    /// The greatest; 90 where straight up lies inside or beyond.
    pub takeoff_angle_max_deg: f64,
}

impl ElevationRecord {
    fn of(slopes: SlopeInterval) -> Option<Self> {
        let angle = |slope: f64| Angle::from_slope(slope).degrees();
        let [takeoff_angle_min_deg, takeoff_angle_max_deg] = [angle(slopes.lower), angle(slopes.upper)];
        (!slopes.is_empty()).then_some(Self { takeoff_angle_min_deg, takeoff_angle_max_deg })
    }

    fn width_deg(&self) -> f64 {
        self.takeoff_angle_max_deg - self.takeoff_angle_min_deg
    }
}

impl PoseRecord {
    /// Of a pose; `height_m`: how far over its place on the surface.
    pub fn of(pose: &Pose, height_m: Option<f64>) -> Self {
        Self { root_m: pose.root_m.coords.into(), up: pose.up().into(), heading_deg: heading_deg(pose.heading()), height_m }
    }
}

impl TriedPoses {
    /// Counts a pose.
    pub const fn count<T>(&mut self, outcome: &Result<T, NoStance>) {
        self.tried += 1;
        match outcome {
            Ok(_) => self.stand += 1,
            Err(NoStance::InsideRock | NoStance::Trunk(_) | NoStance::NoContact(_)) => self.trunk += 1,
            Err(NoStance::TooFewContacts { .. }) => self.too_few_contacts += 1,
            Err(NoStance::NoDirection | NoStance::Slips) => self.cone += 1,
        }
    }
}

impl FootRecord {
    fn of(ground: &StanceGround, pose: &Pose, limb: String, foothold: &Foothold) -> Self {
        Self {
            limb: Some(limb),
            outcome: LimbOutcome::Stands,
            position_m: Some(foothold.point_m.coords.into()),
            normal: Some(foothold.normal.into()),
            friction_coefficient: Some(foothold.friction.coefficient()),
            spread_deg: Some(foothold.spread.degrees()),
            worst_normal: Some(foothold.worst_normal.into()),
            area_m2: Some(foothold.area_m2),
            joints: FootJointsRecord::of(ground, pose, foothold),
        }
    }

    fn missing(limb: String, outcome: LimbOutcome) -> Self {
        Self {
            limb: Some(limb),
            outcome,
            position_m: None,
            normal: None,
            friction_coefficient: None,
            spread_deg: None,
            worst_normal: None,
            area_m2: None,
            joints: None,
        }
    }

    fn alone(contact: &ContactCone) -> Self {
        Self {
            limb: None,
            outcome: LimbOutcome::Stands,
            position_m: None,
            normal: Some(contact.normal().into()),
            friction_coefficient: Some(contact.friction().coefficient()),
            spread_deg: None,
            worst_normal: None,
            area_m2: None,
            joints: None,
        }
    }

    /// The limbs of a stance, in the order of the robot.
    pub fn all_of(ground: &StanceGround, stance: &Stance) -> Vec<Self> {
        let limbs = ground.robot().limbs().iter().zip(stance.outcomes()).enumerate();
        limbs
            .map(|(number, (limb, outcome))| {
                let foothold = stance.footholds().iter().find(|foothold| foothold.limb == number);
                foothold.map_or_else(
                    || Self::missing(limb.name.clone(), *outcome),
                    |foothold| Self::of(ground, stance.pose(), limb.name.clone(), foothold),
                )
            })
            .collect()
    }
}

impl StanceAnswer {
    /// Of a robot that stands; `poses`: how it was found.
    pub fn of_stance(ground: &StanceGround, stance: &Stance, (poses, height_m): (TriedPoses, Option<f64>), headings: u32) -> Self {
        let cones: Vec<ContactCone> = stance.footholds().iter().filter_map(Foothold::cone).collect();
        let mut answer = Self {
            robot: Some(ground.robot().name().to_owned()),
            poses: Some(poses),
            pose: Some(PoseRecord::of(stance.pose(), height_m)),
            contacts: FootRecord::all_of(ground, stance),
            upright: Some(ground.rests_upright(stance)),
            rest: PushRecord::at_rest(ground, stance),
            ..Self::of_cones(&cones, headings)
        };
        let arms = ground.arms(stance);
        for row in &mut answer.rose {
            let along = heading_of(row.heading_deg);
            let Some(beam) = row.k else { continue };
            row.spin_free = ElevationRecord::of(spin_free_cut(&arms, along).takeoff_slopes());
            let middle = f64::midpoint(beam.takeoff_angle_min_deg, beam.takeoff_angle_max_deg);
            let (sine, cosine) = libm::sincos(middle.to_radians());
            let direction = Vector3::new(along.x * cosine, along.y * cosine, sine);
            row.least_spin_m = ground.spin_of(stance, direction);
            row.push_speed_max_m_s = ground.push_speed_max_m_s(stance, direction);
        }
        let free = answer.rose.iter().filter(|row| row.spin_free.is_some()).count();
        #[expect(clippy::cast_precision_loss, reason = "at most 3600 headings")]
        let share = free as f64 / f64::from(headings);
        answer.spin_free_headings = Some(share);
        answer
    }

    /// Of contacts alone.
    pub fn of_contacts(cones: &[ContactCone], headings: u32) -> Self {
        Self { contacts: cones.iter().map(FootRecord::alone).collect(), ..Self::of_cones(cones, headings) }
    }

    /// Of a robot that cannot stand.
    pub fn of_refusal(robot: &str, refusal: &NoStance, poses: TriedPoses) -> Self {
        let contacts = match refusal {
            NoStance::TooFewContacts { limbs, .. } => {
                limbs.iter().map(|(name, outcome)| FootRecord::missing(name.clone(), *outcome)).collect()
            }
            _ => Vec::new(),
        };
        Self {
            robot: Some(robot.to_owned()),
            stands: false,
            refusal: Some(refusal.to_string()),
            poses: Some(poses),
            pose: None,
            contacts,
            force_closure: false,
            bears_weight: false,
            upright: None,
            rest: None,
            usable_headings: 0.0,
            spin_free_headings: None,
            widest_beam: None,
            rose: Vec::new(),
        }
    }

    fn of_cones(cones: &[ContactCone], headings: u32) -> Self {
        let [kc, kc_plus, k] = [ConeKind::Kc, ConeKind::KcPlus, ConeKind::Exact].map(|kind| kind.cone(cones));
        let rose: Vec<RoseRecord> = (0..headings)
            .map(|number| {
                let heading_deg = 360.0 * f64::from(number) / f64::from(headings);
                let along = heading_of(heading_deg);
                let of = |cone: &ConeSum| ElevationRecord::of(cone.takeoff_slopes(along));
                RoseRecord {
                    heading_deg,
                    kc: of(&kc),
                    kc_plus: of(&kc_plus),
                    k: of(&k),
                    spin_free: None,
                    least_spin_m: None,
                    push_speed_max_m_s: None,
                }
            })
            .collect();
        let beams = rose.iter().filter_map(|row| Some((row.heading_deg, row.k?.width_deg())));
        // Of equal beams the first heading.
        let widest = beams.reduce(|best, beam| if beam.1 > best.1 { beam } else { best });
        #[expect(clippy::cast_precision_loss, reason = "at most 3600 headings")]
        let usable_headings = rose.iter().filter(|row| row.k.is_some()).count() as f64 / f64::from(headings);
        Self {
            robot: None,
            stands: !k.is_nothing(),
            refusal: k.is_nothing().then(|| NoStance::NoDirection.to_string()),
            poses: None,
            pose: None,
            contacts: Vec::new(),
            force_closure: k.is_everything(),
            bears_weight: k.holds_weight(),
            upright: None,
            rest: None,
            usable_headings,
            spin_free_headings: None,
            widest_beam: widest.map(|(heading_deg, width_deg)| BeamRecord { heading_deg, width_deg }),
            rose,
        }
    }
}

/// The horizontal direction of a heading, degrees clockwise from +y.
pub fn heading_of(heading_deg: f64) -> Vector2<f64> {
    // Exact where the angle is: the quarters are the axes.
    let quarter = [(0.0, [0.0, 1.0]), (90.0, [1.0, 0.0]), (180.0, [0.0, -1.0]), (270.0, [-1.0, 0.0])];
    if let Some((_, axis)) = quarter.iter().find(|(deg, _)| *deg == heading_deg.rem_euclid(360.0)) {
        return Vector2::from(*axis);
    }
    let (sine, cosine) = libm::sincos(heading_deg.to_radians());
    Vector2::new(sine, cosine)
}

/// The heading of a horizontal direction, degrees clockwise from +y, from 0 to below 360.
fn heading_deg(along: Vector2<f64>) -> f64 {
    libm::atan2(along.x, along.y).to_degrees().rem_euclid(360.0)
}

/// The text of `chta stance`.
pub fn stance_text(answer: &StanceAnswer) -> String {
    let mut sheet = Sheet::default();
    let name = answer.robot.as_deref().unwrap_or("contacts");
    match &answer.refusal {
        Some(refusal) => sheet.line(format_args!("{name}: does not stand: {refusal}")),
        None => sheet.line(format_args!("{name}: stands on {}", feet(answer))),
    }
    if let Some(TriedPoses { tried, stand, trunk, too_few_contacts, cone }) = answer.poses.filter(|poses| poses.tried > 1) {
        sheet.line(format_args!(
            "{stand} of {tried} poses stand; {trunk} refused by the trunk, {too_few_contacts} by too few contacts, {cone} by the cone"
        ));
    }
    if let Some(pose) = &answer.pose {
        let [x, y, z] = pose.root_m;
        let over = pose.height_m.map_or(String::new(), |height_m| format!(", {height_m:.4} m over the surface"));
        sheet.line(format_args!(
            "root at ({}, {}, {}) m{over}, facing {:.1} deg, up ({:.3}, {:.3}, {:.3})",
            place(x),
            place(y),
            place(z),
            pose.heading_deg,
            pose.up[0],
            pose.up[1],
            pose.up[2]
        ));
    }
    for foot in &answer.contacts {
        sheet.line(format_args!("  {}", foot_text(foot)));
    }
    if !answer.rose.is_empty() {
        sheet.line(format_args!(
            "{}",
            if answer.force_closure { "force closure: it can push in every direction" } else { "no force closure" }
        ));
        let weight = if answer.bears_weight { "bears its weight without slipping" } else { "slips under its weight" };
        sheet.line(format_args!("{weight}; take-offs in {:.0} % of headings", 100.0 * answer.usable_headings));
        if let Some(beam) = &answer.widest_beam {
            sheet.line(format_args!("widest beam: {:.3} deg, heading {:.1} deg", beam.width_deg, beam.heading_deg));
        }
        if let (Some(upright), Some(share)) = (answer.upright, answer.spin_free_headings) {
            let rests = if upright { "need not topple at rest" } else { "topples at rest unless it balances" };
            sheet.line(format_args!("{rests}; take-offs without spin in {:.0} % of headings", 100.0 * share));
        }
        if let Some((limb, share)) = answer.rest.as_ref().and_then(PushRecord::greatest_effort) {
            sheet.line(format_args!("at rest the joints of {limb} hold most: {:.0} % of a torque limit", 100.0 * share));
        }
        let speeds = answer.rose.iter().filter_map(|row| row.push_speed_max_m_s);
        if let Some(least) = speeds.clone().reduce(f64::min) {
            let most = speeds.fold(0.0, f64::max);
            sheet.line(format_args!("stroke and forces allow {least:.3} to {most:.3} m/s in the middles of the beams"));
        }
        sheet.line(format_args!("heading (deg)   take-off angles (deg) by Kc, Kc+ and the exact cone K"));
        let every = answer.rose.len().div_ceil(12);
        for row in answer.rose.iter().step_by(every) {
            let of = |angles: Option<ElevationRecord>| {
                angles.map_or("-".to_owned(), |a| format!("{:.2} to {:.2}", a.takeoff_angle_min_deg, a.takeoff_angle_max_deg))
            };
            sheet.line(format_args!("{:>13.1}   {:>18} {:>18} {:>18}", row.heading_deg, of(row.kc), of(row.kc_plus), of(row.k)));
        }
    }
    sheet.into_text()
}

/// How many feet stand.
fn feet(answer: &StanceAnswer) -> String {
    let count = answer.contacts.iter().filter(|foot| foot.outcome == LimbOutcome::Stands).count();
    let of = if answer.robot.is_some() { format!(" of {} feet", answer.contacts.len()) } else { " contacts".to_owned() };
    format!("{count}{of}")
}

fn foot_text(foot: &FootRecord) -> String {
    let name = foot.limb.as_deref().unwrap_or("contact");
    let (Some([x, y, z]), Some(mu)) = (foot.normal, foot.friction_coefficient) else {
        return format!("{name} {}", foot.outcome.sentence());
    };
    let at = foot.position_m.map_or(String::new(), |[x, y, z]| format!(" at ({}, {}, {}) m", place(x), place(y), place(z)));
    let spread = foot.spread_deg.filter(|deg| *deg >= 0.05).map_or(String::new(), |deg| format!(", facets up to {deg:.1} deg off"));
    let joints = foot.joints.as_ref().map_or(String::new(), |joints| format!("; {}", joints.words()));
    format!("{name}{at}, normal ({x:.3}, {y:.3}, {z:.3}), friction {mu}{spread}{joints}")
}
