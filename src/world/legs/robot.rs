//! The robot, checked.

use std::f64::consts::PI;

use nalgebra::{Point3, Vector3};

use super::{InvalidRobot, Limb, RobotPart, RobotProblem, Shell, TrunkBox, Workspace};
use crate::world::hopper::{NOT_NEGATIVE, POSITIVE, not_negative, positive};

/// What a robot with legs states, not yet checked: [`Robot::new`] does that.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotDescription {
    /// Its name in reports.
    pub name: String,
    /// The boxes of its trunk, which must not touch the ground; none: a point.
    pub trunk: Vec<TrunkBox>,
    /// Its limbs, at least one.
    pub limbs: Vec<Limb>,
    /// How many feet have to be on the ground at a take-off and at a landing.
    pub contacts_min: usize,
    /// Its mass, kg.
    pub mass_kg: Option<f64>,
    /// Its moments of inertia about the axes of the trunk through the centre of mass, kg m^2.
    pub inertia_kg_m2: Option<[f64; 3]>,
    /// The centre of mass, m.
    pub centre_of_mass_m: Point3<f64>,
    /// The length over which it pushes off, m; `None`: it takes off by an impulse.
    pub stroke_m: Option<f64>,
    /// The greatest take-off speed, m/s.
    pub takeoff_speed_max_m_s: Option<f64>,
    /// The greatest landing speed, m/s.
    pub landing_speed_max_m_s: Option<f64>,
    /// The greatest rate of rotation after take-off, rad/s; `None`: any.
    pub spin_max_rad_s: Option<f64>,
}

impl RobotDescription {
    /// A robot of these limbs without a trunk that needs one contact and states nothing else.
    pub fn new(name: impl Into<String>, limbs: Vec<Limb>) -> Self {
        Self {
            name: name.into(),
            trunk: Vec::new(),
            limbs,
            contacts_min: 1,
            mass_kg: None,
            inertia_kg_m2: None,
            centre_of_mass_m: Point3::origin(),
            stroke_m: None,
            takeoff_speed_max_m_s: None,
            landing_speed_max_m_s: None,
            spin_max_rad_s: None,
        }
    }
}

/// A robot with legs, whose statements hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    stated: RobotDescription,
    leg_length_m: f64,
}

/// The statements found that do not hold.
#[derive(Default)]
struct Problems(Vec<RobotProblem>);

impl Problems {
    /// Notes a statement that does not hold.
    fn ask(&mut self, holds: bool, part: &RobotPart, key: &'static str, found: &(impl ToString + ?Sized), expected: &'static str) {
        if !holds {
            self.0.push(RobotProblem { part: part.clone(), key, found: found.to_string(), expected });
        }
    }

    /// Notes a number of the robot that is given and does not hold.
    fn number(&mut self, key: &'static str, number: Option<f64>, holds: fn(f64) -> bool, expected: &'static str) {
        let found = number.unwrap_or_default();
        self.ask(number.is_none_or(holds), &RobotPart::Robot, key, &found, expected);
    }

    fn point(&mut self, part: &RobotPart, key: &'static str, point: &Point3<f64>) {
        self.ask(point.iter().all(|x| x.is_finite()), part, key, &list(point.coords), "three finite numbers");
    }
}

/// Three numbers as a robot file lists them.
fn list(numbers: Vector3<f64>) -> String {
    format!("[{}, {}, {}]", numbers.x, numbers.y, numbers.z)
}

impl Robot {
    /// A robot as described.
    ///
    /// # Errors
    /// [`InvalidRobot`] with everything that does not hold.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::Angle, world::{Limb, Robot, RobotDescription, Shell, Workspace}};
    /// use nalgebra::{Point3, Vector3};
    /// let shell = Shell::new(0.1, 0.3, -Vector3::z_axis(), Angle::from_degrees(40.0));
    /// let foot = |name, y| Limb::new(name, Point3::new(0.0, y, 0.0), Workspace::Shell(shell));
    /// let robot = Robot::new(RobotDescription { contacts_min: 2, ..RobotDescription::new("biped", vec![foot("left", 0.1), foot("right", -0.1)]) })?;
    /// assert_eq!((robot.limbs().len(), robot.contacts_min(), robot.leg_length_m()), (2, 2, 0.3));
    /// let wrong = RobotDescription { contacts_min: 2, mass_kg: Some(-1.0), ..RobotDescription::new("monoped", vec![foot("foot", 0.0)]) };
    /// assert_eq!(
    ///     Robot::new(wrong).unwrap_err().to_string(),
    ///     "robot: mass_kg is -1, expected a finite number above 0; \
    ///      robot: contacts_min is 2, expected a whole number from 1 to the number of limbs"
    /// );
    /// # Ok::<(), chta::world::InvalidRobot>(())
    /// ```
    pub fn new(stated: RobotDescription) -> Result<Self, InvalidRobot> {
        // No destructuring with `..`, so that a new statement cannot be left unchecked.
        let RobotDescription {
            name,
            trunk,
            limbs,
            contacts_min,
            mass_kg,
            inertia_kg_m2,
            centre_of_mass_m,
            stroke_m,
            takeoff_speed_max_m_s,
            landing_speed_max_m_s,
            spin_max_rad_s,
        } = &stated;
        let robot = RobotPart::Robot;
        let mut problems = Problems::default();
        problems.ask(!name.trim().is_empty(), &robot, "name", "empty", "a name");
        for (key, number) in [
            ("mass_kg", mass_kg),
            ("stroke_m", stroke_m),
            ("takeoff_speed_max_m_s", takeoff_speed_max_m_s),
            ("landing_speed_max_m_s", landing_speed_max_m_s),
        ] {
            problems.number(key, *number, positive, POSITIVE);
        }
        problems.number("spin_max_rad_s", *spin_max_rad_s, not_negative, NOT_NEGATIVE);
        problems.point(&robot, "centre_of_mass_m", centre_of_mass_m);
        if let Some(moments) = inertia_kg_m2 {
            problems.ask(is_inertia(*moments), &robot, "inertia_kg_m2", &list((*moments).into()), INERTIA);
        }
        // No spin at all is a condition on the forces alone; a rate needs what turns a moment into one.
        let inertia_missing = spin_max_rad_s.is_some_and(|spin| spin > 0.0) && inertia_kg_m2.is_none();
        problems.ask(
            !inertia_missing,
            &robot,
            "inertia_kg_m2",
            "absent",
            "the moments of inertia, by which spin_max_rad_s is judged",
        );
        problems.ask(!limbs.is_empty(), &robot, "limb", "absent", "at least one limb: a robot without limbs has no contact");
        let contacts = limbs.is_empty() || (1..=limbs.len()).contains(contacts_min);
        problems.ask(contacts, &robot, "contacts_min", contacts_min, "a whole number from 1 to the number of limbs");
        for (index, part) in trunk.iter().enumerate() {
            check_box(&mut problems, &RobotPart::Trunk(index), part);
        }
        for (index, limb) in limbs.iter().enumerate() {
            let part = RobotPart::Limb(index, limb.name.clone());
            let other = limbs[..index].iter().all(|earlier| earlier.name != limb.name);
            problems.ask(other, &part, "name", "the name of an earlier limb", "a name that no other limb has");
            check_limb(&mut problems, &part, limb);
        }
        if !problems.0.is_empty() {
            return Err(InvalidRobot(problems.0));
        }
        let leg_length_m = limbs.iter().map(Limb::length_m).fold(0.0, f64::max);
        Ok(Self { stated, leg_length_m })
    }

    /// A robot without size whose only contact is its root: the point of the hop test, for comparisons.
    pub fn point(name: impl Into<String>) -> Self {
        let limb = Limb::new("foot", Point3::origin(), Workspace::Shell(Shell::at_hip()));
        Self { stated: RobotDescription::new(name, vec![limb]), leg_length_m: 0.0 }
    }

    /// All that it states.
    pub const fn description(&self) -> &RobotDescription {
        &self.stated
    }

    /// Its name in reports.
    pub fn name(&self) -> &str {
        &self.stated.name
    }

    /// The boxes of its trunk.
    pub fn trunk(&self) -> &[TrunkBox] {
        &self.stated.trunk
    }

    /// Its limbs, at least one.
    pub fn limbs(&self) -> &[Limb] {
        &self.stated.limbs
    }

    /// How many feet have to be on the ground at a take-off and at a landing: from 1 to the number of limbs.
    pub const fn contacts_min(&self) -> usize {
        self.stated.contacts_min
    }

    /// Its mass, kg.
    pub const fn mass_kg(&self) -> Option<f64> {
        self.stated.mass_kg
    }

    /// Its moments of inertia about the axes of the trunk through the centre of mass, kg m^2.
    pub const fn inertia_kg_m2(&self) -> Option<[f64; 3]> {
        self.stated.inertia_kg_m2
    }

    /// The centre of mass, m.
    pub const fn centre_of_mass_m(&self) -> Point3<f64> {
        self.stated.centre_of_mass_m
    }

    /// The length over which it pushes off, m; `None`: it takes off by an impulse.
    pub const fn stroke_m(&self) -> Option<f64> {
        self.stated.stroke_m
    }

    /// The greatest take-off speed, m/s.
    pub const fn takeoff_speed_max_m_s(&self) -> Option<f64> {
        self.stated.takeoff_speed_max_m_s
    }

    /// The greatest landing speed, m/s.
    pub const fn landing_speed_max_m_s(&self) -> Option<f64> {
        self.stated.landing_speed_max_m_s
    }

    /// The greatest rate of rotation after take-off, rad/s; `None`: any.
    pub const fn spin_max_rad_s(&self) -> Option<f64> {
        self.stated.spin_max_rad_s
    }

    /// The length of its longest limb, m: from the hip to the farthest point of the workspace.
    pub const fn leg_length_m(&self) -> f64 {
        self.leg_length_m
    }

    /// The distance of the farthest point that a foot reaches from the root, m.
    pub fn reach_m(&self) -> f64 {
        self.limbs().iter().map(Limb::reach_m).fold(0.0, f64::max)
    }

    /// The distance of the farthest corner of the trunk from the root, m; 0 without a trunk.
    pub fn trunk_radius_m(&self) -> f64 {
        self.trunk().iter().map(TrunkBox::radius_m).fold(0.0, f64::max)
    }
}

/// What is expected of moments of inertia.
const INERTIA: &str = "three finite numbers above 0, each no larger than the other two together";

/// Whether moments of inertia are those of a body: of a thin plate, the greatest is the sum of the others, which rounding may exceed.
fn is_inertia(moments: [f64; 3]) -> bool {
    let sum: f64 = moments.iter().sum();
    moments.iter().all(|&moment| positive(moment) && moment <= 0.5 * sum * (1.0 + 1e-9))
}

fn check_box(problems: &mut Problems, part: &RobotPart, trunk_box: &TrunkBox) {
    problems.point(part, "centre_m", &trunk_box.centre_m);
    let sizes = trunk_box.half_m.iter().all(|&half| positive(half));
    problems.ask(
        sizes,
        part,
        "size_m",
        &list(2.0 * trunk_box.half_m),
        "three finite numbers above 0: a box that is not inside out",
    );
    let axes = trunk_box.axes.matrix();
    let turned = (axes * axes.transpose()).is_identity(1e-9) && axes.determinant() > 0.0;
    problems.ask(turned, part, "roll_deg, pitch_deg, yaw_deg", "no rotation", "three finite angles");
}

fn check_limb(problems: &mut Problems, part: &RobotPart, limb: &Limb) {
    problems.ask(!limb.name.trim().is_empty(), part, "name", "empty", "a name");
    problems.point(part, "hip_m", &limb.hip_m);
    if let Some(friction) = limb.friction {
        let coefficient = friction.coefficient();
        let expected = "a finite number above 0: a foot without friction pushes along the normal alone and does not stand";
        problems.ask(positive(coefficient), part, "friction_coefficient", &coefficient, expected);
    }
    if let Some(force) = limb.force_max_n {
        problems.ask(positive(force), part, "force_max_n", &force, POSITIVE);
    }
    if let Workspace::Shell(shell) = &limb.workspace {
        check_shell(problems, part, shell);
    }
}

fn check_shell(problems: &mut Problems, part: &RobotPart, shell: &Shell) {
    let (least, greatest) = (shell.radius_min_m(), shell.radius_max_m());
    problems.ask(not_negative(least), part, "shell.radius_min_m", &least, NOT_NEGATIVE);
    problems.ask(not_negative(greatest), part, "shell.radius_max_m", &greatest, NOT_NEGATIVE);
    let ordered = least < greatest || (least == 0.0 && greatest == 0.0);
    let comparable = not_negative(least) && not_negative(greatest);
    problems.ask(
        ordered || !comparable,
        part,
        "shell.radius_min_m",
        &least,
        "less than shell.radius_max_m, or 0 for both: the contact is the hip",
    );
    let axis = shell.axis();
    problems.ask(
        (axis.norm() - 1.0).abs() < 1e-9,
        part,
        "shell.axis",
        &list(axis.into_inner()),
        "three finite numbers that are not all 0",
    );
    let half = shell.half_angle();
    let in_range = half.radians() > 0.0 && half.radians() <= PI;
    problems.ask(in_range, part, "shell.half_angle_deg", &half.degrees(), "an angle above 0 and at most 180 degrees");
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Unit};

    use super::*;
    use crate::{quantity::Angle, world::FrictionCone};

    fn shell() -> Shell {
        Shell::new(0.1, 0.3, -Vector3::z_axis(), Angle::from_degrees(40.0))
    }

    fn sound() -> RobotDescription {
        let limb = |name, y| Limb::new(name, Point3::new(0.0, y, 0.0), Workspace::Shell(shell()));
        let trunk = vec![TrunkBox::upright(Point3::origin(), Vector3::new(0.2, 0.1, 0.05))];
        RobotDescription { trunk, contacts_min: 2, ..RobotDescription::new("biped", vec![limb("left", 0.1), limb("right", -0.1)]) }
    }

    /// The keys of the problems that a change to a sound robot causes.
    fn refused(change: impl FnOnce(&mut RobotDescription)) -> Vec<&'static str> {
        let mut stated = sound();
        change(&mut stated);
        Robot::new(stated).map_or_else(|InvalidRobot(problems)| problems.iter().map(|p| p.key).collect(), |_| Vec::new())
    }

    #[test]
    fn invalid_numbers_are_refused_by_key() {
        for bad in [f64::NAN, -1.0, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(refused(|r| r.mass_kg = Some(bad)), ["mass_kg"], "{bad}");
            assert_eq!(refused(|r| r.stroke_m = Some(bad)), ["stroke_m"], "{bad}");
            assert_eq!(refused(|r| r.takeoff_speed_max_m_s = Some(bad)), ["takeoff_speed_max_m_s"], "{bad}");
            assert_eq!(refused(|r| r.landing_speed_max_m_s = Some(bad)), ["landing_speed_max_m_s"], "{bad}");
            assert_eq!(refused(|r| r.spin_max_rad_s = Some(bad)).first(), Some(&"spin_max_rad_s"), "{bad}");
            assert_eq!(refused(|r| r.inertia_kg_m2 = Some([1.0, bad, 1.0])), ["inertia_kg_m2"], "{bad}");
            assert_eq!(refused(|r| r.trunk[0].half_m.y = bad), ["size_m"], "{bad}");
            assert_eq!(refused(|r| r.limbs[1].force_max_n = Some(bad)), ["force_max_n"], "{bad}");
            let radii = |least, greatest| Shell::new(least, greatest, Vector3::z_axis(), Angle::from_degrees(40.0));
            assert_eq!(refused(|r| r.limbs[0].workspace = Workspace::Shell(radii(bad, 1.0))), ["shell.radius_min_m"], "{bad}");
            assert_eq!(refused(|r| r.limbs[0].workspace = Workspace::Shell(radii(0.0, bad))), ["shell.radius_max_m"], "{bad}");
        }
        for bad in [f64::NAN, f64::INFINITY] {
            assert_eq!(refused(|r| r.centre_of_mass_m.x = bad), ["centre_of_mass_m"], "{bad}");
            assert_eq!(refused(|r| r.limbs[0].hip_m.z = bad), ["hip_m"], "{bad}");
            assert_eq!(refused(|r| r.trunk[0].centre_m.z = bad), ["centre_m"], "{bad}");
        }
        for bad in [0.0, -1.0, 180.1, f64::NAN] {
            let wide = Shell::new(0.0, 1.0, Vector3::z_axis(), Angle::from_degrees(bad));
            assert_eq!(refused(|r| r.limbs[0].workspace = Workspace::Shell(wide)), ["shell.half_angle_deg"], "{bad}");
        }
    }

    #[test]
    fn what_is_no_robot_is_refused() {
        assert_eq!(refused(|_| ()), [""; 0]);
        assert_eq!(refused(|r| r.limbs.clear()), ["limb"]);
        assert_eq!(refused(|r| r.contacts_min = 0), ["contacts_min"]);
        assert_eq!(refused(|r| r.contacts_min = 3), ["contacts_min"]);
        assert_eq!(refused(|r| r.name = " ".to_owned()), ["name"]);
        assert_eq!(refused(|r| r.limbs[1].name = "left".to_owned()), ["name"]);
        assert_eq!(refused(|r| r.limbs[1].name = String::new()), ["name"]);
        assert_eq!(refused(|r| r.limbs[0].friction = FrictionCone::new(0.0).ok()), ["friction_coefficient"]);
        assert_eq!(refused(|r| r.trunk[0].half_m.x = 0.0), ["size_m"]);
        let squeezed = Rotation3::from_matrix_unchecked(nalgebra::Matrix3::identity() * 0.9);
        assert_eq!(refused(|r| r.trunk[0].axes = squeezed), ["roll_deg, pitch_deg, yaw_deg"]);
        assert_eq!(refused(|r| r.inertia_kg_m2 = Some([1.0, 1.0, 2.1])), ["inertia_kg_m2"]);
        assert_eq!(refused(|r| r.spin_max_rad_s = Some(0.1)), ["inertia_kg_m2"]);
        let none = Shell::new(0.0, 1.0, Unit::new_unchecked(Vector3::zeros()), Angle::from_degrees(40.0));
        assert_eq!(refused(|r| r.limbs[0].workspace = Workspace::Shell(none)), ["shell.axis"]);
        let thin = |radius| Shell::new(radius, radius, Vector3::z_axis(), Angle::from_degrees(40.0));
        assert_eq!(refused(|r| r.limbs[0].workspace = Workspace::Shell(thin(0.2))), ["shell.radius_min_m"]);
        assert_eq!(refused(|r| r.limbs[0].workspace = Workspace::Shell(thin(0.0))), [""; 0]);
    }

    #[test]
    fn all_problems_are_reported_at_once() {
        let mut stated = sound();
        stated.mass_kg = Some(0.0);
        stated.trunk[0].half_m.z = -0.1;
        stated.limbs[1].force_max_n = Some(0.0);
        let message = Robot::new(stated).unwrap_err().to_string();
        assert_eq!(
            message,
            "robot: mass_kg is 0, expected a finite number above 0; trunk box 1: size_m is [0.4, 0.2, -0.2], expected three finite \
             numbers above 0: a box that is not inside out; limb 2 'right': force_max_n is 0, expected a finite number above 0"
        );
    }

    #[test]
    fn the_ends_of_the_ranges_are_accepted() {
        let plate = |r: &mut RobotDescription| {
            r.inertia_kg_m2 = Some([1.0, 1.0, 2.0]);
            r.spin_max_rad_s = Some(0.0);
            r.limbs[0].workspace = Workspace::Shell(Shell::new(0.0, 1.0, Vector3::z_axis(), Angle::from_degrees(180.0)));
        };
        assert_eq!(refused(plate), [""; 0]);
        let point = Robot::point("point");
        assert_eq!(Robot::new(point.description().clone()), Ok(point));
    }
}
