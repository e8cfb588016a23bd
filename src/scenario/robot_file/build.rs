//! From the tables of a robot file to the robot.

use std::path::{Path, PathBuf};

use nalgebra::{Point3, Unit, Vector3};

use super::{
    RobotFile,
    joints::names_urdf,
    parts::{Part, Parts},
    shape::{self, Refused},
};
use crate::{
    quantity::Angle,
    robot_model::LimbChain,
    scenario::{Place, ProblemKind, ScenarioProblem},
    world::{
        FrictionCone, InvalidRobot, Limb, Robot, RobotDescription, RobotPart, RobotProblem, Shell, TrunkBox, Workspace,
        roll_pitch_yaw,
    },
};

/// The robot, or all problems in the order of the file.
pub(super) fn build(parts: &Parts, folder: &Path, called: &str) -> Result<RobotFile, Vec<ScenarioProblem>> {
    let problems = parts.problems.clone();
    let mut builder = Builder { folder, unit_m: 1.0, problems, warnings: Vec::new(), files: Vec::new(), chains: Vec::new() };
    let robot = if parts.unreadable { None } else { builder.robot(parts, called) };
    match robot {
        Some(robot) if builder.problems.is_empty() => {
            let Builder { warnings, files, chains, .. } = builder;
            Ok(RobotFile { robot, chains, warnings, files })
        }
        _ => {
            builder.problems.sort_by_key(|problem| match &problem.place {
                Place::File(span) => span.start,
                Place::Option(_) | Place::Nowhere => usize::MAX,
            });
            Err(builder.problems)
        }
    }
}

/// A robot under construction, and what is wrong with it.
pub(super) struct Builder<'a> {
    folder: &'a Path,
    unit_m: f64,
    problems: Vec<ScenarioProblem>,
    pub(super) warnings: Vec<String>,
    files: Vec<PathBuf>,
    chains: Vec<Option<LimbChain>>,
}

impl Builder<'_> {
    pub(super) fn problem(&mut self, part: &Part, name: &str, kind: ProblemKind, message: String, help: impl Into<String>) {
        let key = crate::scenario::KeyPath::new(part.table, name);
        self.problems.push(ScenarioProblem { key, kind, place: part.place(name), message, help: help.into() });
    }

    /// Reports a key that is absent and needed. One that was given with a wrong value has been reported.
    fn missing(&mut self, part: &Part, name: &str, help: &str) {
        if !part.has(name) {
            let message = format!("{} is missing", part.path(name));
            self.problem(part, name, ProblemKind::Missing, message, help);
        }
    }

    /// The robot; `None` if [`Robot::new`] refuses it. What is missing is replaced, so that all problems are found at once.
    fn robot(&mut self, read: &Parts, called: &str) -> Option<Robot> {
        let parts = &read.tables[..];
        let model = self.model(read);
        let whole = parts.iter().find(|part| part.table == "robot");
        self.unit_m = whole.and_then(|part| part.number("stl_unit_m")).unwrap_or(1.0);
        let of_table = |table: &'static str| parts.iter().filter(move |part| part.table == table);
        let mut trunk: Vec<TrunkBox> = of_table("trunk").map(|part| self.trunk(part)).collect();
        if let Some(model) = model.as_ref().filter(|_| trunk.is_empty()) {
            trunk = self.model_trunk(model);
        }
        let mut limbs = Vec::new();
        for part in of_table("limb") {
            let limb = self.limb(part);
            let chain = self.chain(part, model.as_ref(), names_urdf(read), &limb.hip_m);
            self.chains.push(chain);
            limbs.push(limb);
        }
        let number = |name: &str| whole.and_then(|part| part.number(name));
        let three = |name: &str| whole.and_then(|part| part.three(name));
        let name = whole.and_then(|part| part.text("name")).unwrap_or(called);
        let stated = RobotDescription {
            trunk,
            contacts_min: whole.and_then(|part| part.count("contacts_min")).unwrap_or(1),
            mass_kg: number("mass_kg").or_else(|| model.as_ref()?.mass_kg()),
            inertia_kg_m2: three("inertia_kg_m2"),
            centre_of_mass_m: three("centre_of_mass_m").map_or_else(Point3::origin, Point3::from),
            stroke_m: number("stroke_m"),
            takeoff_speed_max_m_s: number("takeoff_speed_max_m_s"),
            landing_speed_max_m_s: number("landing_speed_max_m_s"),
            spin_max_rad_s: number("spin_max_rad_s"),
            ..RobotDescription::new(name, limbs)
        };
        match Robot::new(stated) {
            Ok(robot) => Some(robot),
            Err(InvalidRobot(problems)) => {
                for problem in &problems {
                    self.refuse(parts, problem);
                }
                None
            }
        }
    }

    /// A problem of the robot at the position of its key.
    fn refuse(&mut self, parts: &[Part], problem: &RobotProblem) {
        let (table, index) = match &problem.part {
            RobotPart::Robot => ("robot", 0),
            RobotPart::Trunk(index) => ("trunk", *index),
            RobotPart::Limb(index, _) => ("limb", *index),
        };
        let part = parts.iter().find(|part| part.table == table && part.index == index);
        let is_told = part.is_some_and(|part| part.is_refused(problem.key));
        let is_list_told = problem.key == "limb" && self.problems.iter().any(|told| told.key.table == "limb");
        if is_told || is_list_told {
            return;
        }
        let help = match problem.key {
            "limb" => "add a [[limb]] with name, hip_m and shell or workspace_stl",
            "contacts_min" => "give it at most as many contacts as the file has limbs",
            "inertia_kg_m2" => "add the moments of inertia of the whole robot, or remove spin_max_rad_s",
            "name" => "give each limb a name of its own",
            _ => "give a value in that range",
        };
        let place = part.map_or(Place::Nowhere, |part| part.place(problem.key));
        let key = crate::scenario::KeyPath::new(table, problem.key);
        let kind = if problem.found == "absent" { ProblemKind::Missing } else { ProblemKind::Value };
        self.problems.push(ScenarioProblem { key, kind, place, message: problem.to_string(), help: help.to_owned() });
    }

    /// The file that a key names, from the folder of the robot file.
    pub(super) fn file(&mut self, path: &str) -> PathBuf {
        let path = self.folder.join(path);
        self.files.push(path.clone());
        path
    }

    fn refused_shape(&mut self, part: &Part, name: &str, Refused { message, help }: Refused) {
        let message = format!("{}: {message}", part.path(name));
        self.problem(part, name, ProblemKind::Value, message, help);
    }

    fn trunk(&mut self, part: &Part) -> TrunkBox {
        let unit = TrunkBox::upright(Point3::origin(), Vector3::repeat(1.0));
        if let Some(path) = part.text("stl") {
            for name in ["size_m", "centre_m", "roll_deg", "pitch_deg", "yaw_deg"] {
                if part.has(name) {
                    let message = format!("{} is given beside stl, whose mesh is the box", part.path(name));
                    self.problem(part, name, ProblemKind::Conflict, message, "remove one of them");
                }
            }
            let path = self.file(path);
            let of = format!("trunk box {}", part.index + 1);
            return match shape::trunk_box(&path, self.unit_m, &of, &mut self.warnings) {
                Ok(trunk_box) => trunk_box,
                Err(refused) => {
                    self.refused_shape(part, "stl", refused);
                    unit
                }
            };
        }
        if !part.has("stl") {
            self.missing(part, "size_m", "add size_m = [0.4, 0.3, 0.1], the lengths of its edges, or stl");
        }
        let angle = |name: &str| Angle::from_degrees(part.number(name).unwrap_or(0.0));
        TrunkBox {
            centre_m: part.three("centre_m").map_or_else(Point3::origin, Point3::from),
            half_m: part.three("size_m").map_or(unit.half_m, |size| 0.5 * Vector3::from(size)),
            axes: roll_pitch_yaw([angle("roll_deg"), angle("pitch_deg"), angle("yaw_deg")]),
        }
    }

    fn limb(&mut self, part: &Part) -> Limb {
        self.missing(part, "name", "add name = \"left\"");
        self.missing(part, "hip_m", "add hip_m = [0.2, 0.1, 0], where the limb is fixed to the trunk");
        let name = part.text("name").map_or_else(|| format!("limb {}", part.index + 1), str::to_owned);
        let workspace = self.workspace(part, &name);
        Limb {
            name,
            hip_m: part.three("hip_m").map_or_else(Point3::origin, Point3::from),
            workspace,
            friction: part.number("friction_coefficient").and_then(|friction| FrictionCone::new(friction).ok()),
            force_max_n: part.number("force_max_n"),
        }
    }

    fn workspace(&mut self, part: &Part, limb: &str) -> Workspace {
        if part.has("shell.") && part.has("workspace_stl") {
            let message = format!("{} is given beside shell, and a limb has one workspace", part.path("workspace_stl"));
            self.problem(part, "workspace_stl", ProblemKind::Conflict, message, "remove one of them");
        } else if let Some(path) = part.text("workspace_stl") {
            let path = self.file(path);
            match shape::workspace(&path, self.unit_m, &format!("limb '{limb}'"), &mut self.warnings) {
                Ok(hull) => return Workspace::Convex(hull),
                Err(refused) => self.refused_shape(part, "workspace_stl", refused),
            }
        } else if part.has("shell.") {
            return self.shell(part);
        } else if !part.has("workspace_stl") {
            let message = format!("{} is missing", part.path("shell"));
            let help =
                "add shell = { radius_min_m = 0.1, radius_max_m = 0.3, axis = [0, 0, -1], half_angle_deg = 45 }, or workspace_stl";
            self.problem(part, "shell", ProblemKind::Missing, message, help);
        }
        Workspace::Shell(Shell::at_hip())
    }

    fn shell(&mut self, part: &Part) -> Workspace {
        let [least, greatest] = ["shell.radius_min_m", "shell.radius_max_m"].map(|name| part.number(name));
        self.missing(part, "shell.radius_max_m", "add radius_max_m, the greatest distance of the foot from the hip");
        if greatest != Some(0.0) {
            self.missing(part, "shell.half_angle_deg", "add half_angle_deg, the greatest angle from the axis");
        }
        let axis = part.three("shell.axis").map_or_else(|| -Vector3::z(), Vector3::from);
        // A zero axis has no direction: the robot refuses it.
        let axis = Unit::try_new(axis, 0.0).unwrap_or_else(|| Unit::new_unchecked(Vector3::zeros()));
        let half_angle = Angle::from_degrees(part.number("shell.half_angle_deg").unwrap_or(180.0));
        // What was refused is replaced by values in order.
        let least = if greatest.is_some() { least.unwrap_or(0.0) } else { 0.0 };
        Workspace::Shell(Shell::new(least, greatest.unwrap_or(1.0), axis, half_angle))
    }
}
