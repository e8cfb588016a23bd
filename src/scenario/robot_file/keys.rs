//! The keys of a robot file: the one list behind its reader, its schema and its table.

/// The kind of value that a key takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotKeyKind {
    /// Any text that is not empty.
    Text,
    /// A path, relative to the file.
    File,
    /// A number above 0.
    Positive,
    /// A number of at least 0.
    NotNegative,
    /// Any finite number.
    Number,
    /// A whole number of at least 1.
    Count,
    /// Three finite numbers.
    Three,
    /// Three numbers above 0.
    ThreePositive,
}

/// One key of a robot file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RobotKey {
    /// The table: `robot`, or `trunk` and `limb`, of which there may be several.
    pub table: &'static str,
    /// The name, which ends in its unit; with a dot for a key of an inner table.
    pub name: &'static str,
    /// The kind of value.
    pub kind: RobotKeyKind,
    /// What it means, in one line.
    pub help: &'static str,
}

impl RobotKeyKind {
    /// The expected value, for messages and tables.
    pub const fn expected(self) -> &'static str {
        match self {
            Self::Text => "a text in quotes, not empty",
            Self::File => "a path in quotes, from this file's folder",
            Self::Positive => "a finite number above 0",
            Self::NotNegative => "a finite number of at least 0",
            Self::Number => "a finite number",
            Self::Count => "a whole number of at least 1",
            Self::Three => "three finite numbers in brackets, such as [0.1, 0, -0.2]",
            Self::ThreePositive => "three finite numbers above 0 in brackets, such as [0.4, 0.3, 0.1]",
        }
    }
}

impl RobotKey {
    /// The known key of this table and name.
    pub fn find(table: &str, name: &str) -> Option<&'static Self> {
        ROBOT_KEYS.iter().find(|key| key.table == table && key.name == name)
    }
}

const fn key(table: &'static str, name: &'static str, kind: RobotKeyKind, help: &'static str) -> RobotKey {
    RobotKey { table, name, kind, help }
}

/// The tables, in the order of the file.
pub(super) const TABLES: [&str; 3] = ["robot", "trunk", "limb"];

/// All keys, in the order of a file.
pub const ROBOT_KEYS: [RobotKey; 28] = [
    key("robot", "name", RobotKeyKind::Text, "name in reports; absent: the name of the file"),
    key("robot", "contacts_min", RobotKeyKind::Count, "feet on the ground at every take-off and landing, at least; absent: 1"),
    key("robot", "mass_kg", RobotKeyKind::Positive, "mass, kg; absent: that of the URDF, else hopper.mass_kg of the scenario"),
    key(
        "robot",
        "inertia_kg_m2",
        RobotKeyKind::ThreePositive,
        "moments of inertia about x, y and z through the centre of mass, kg m^2; needed beside spin_max_rad_s above 0",
    ),
    key("robot", "centre_of_mass_m", RobotKeyKind::Three, "centre of mass, m; absent: the root"),
    key("robot", "stroke_m", RobotKeyKind::Positive, "length over which it pushes off, m; absent: take-off by an impulse"),
    key("robot", "takeoff_speed_max_m_s", RobotKeyKind::Positive, "greatest take-off speed, m/s; absent: that of the scenario"),
    key("robot", "landing_speed_max_m_s", RobotKeyKind::Positive, "greatest landing speed, m/s; absent: that of the scenario"),
    key("robot", "spin_max_rad_s", RobotKeyKind::NotNegative, "greatest rate of rotation after take-off, rad/s; absent: any"),
    key("robot", "stl_unit_m", RobotKeyKind::Positive, "metres per unit of the STL files that it names; absent: 1"),
    key(
        "robot",
        "urdf",
        RobotKeyKind::File,
        "URDF whose root link is the trunk frame: the joints of limbs; mass and trunk boxes where this file has none",
    ),
    key("trunk", "size_m", RobotKeyKind::ThreePositive, "lengths of the edges of a box that must not touch the ground, m"),
    key("trunk", "centre_m", RobotKeyKind::Three, "middle of the box, m; absent: the root"),
    key("trunk", "roll_deg", RobotKeyKind::Number, "turn of the box about its x, degrees, before the others; absent: 0"),
    key("trunk", "pitch_deg", RobotKeyKind::Number, "turn of the box about y, degrees, after roll; absent: 0"),
    key("trunk", "yaw_deg", RobotKeyKind::Number, "turn of the box about z, degrees, last; absent: 0"),
    key(
        "trunk",
        "stl",
        RobotKeyKind::File,
        "instead of size_m: the box is that around this mesh, along the axes of the trunk frame",
    ),
    key("limb", "name", RobotKeyKind::Text, "name in reports, another one for each limb"),
    key("limb", "hip_m", RobotKeyKind::Three, "where the limb is fixed to the trunk, m; the ground at a contact has to face it"),
    key("limb", "shell.radius_min_m", RobotKeyKind::NotNegative, "least distance of the foot from the hip, m; absent: 0"),
    key(
        "limb",
        "shell.radius_max_m",
        RobotKeyKind::NotNegative,
        "greatest distance of the foot from the hip, m; 0: the contact is the hip",
    ),
    key(
        "limb",
        "shell.axis",
        RobotKeyKind::Three,
        "middle direction of the foot from the hip, of any length; absent: down, [0, 0, -1]",
    ),
    key(
        "limb",
        "shell.half_angle_deg",
        RobotKeyKind::Positive,
        "greatest angle of the foot's direction from the axis, degrees, up to 180",
    ),
    key(
        "limb",
        "workspace_stl",
        RobotKeyKind::File,
        "instead of shell: mesh in the trunk frame, m, of which the convex hull is the foot's workspace",
    ),
    key("limb", "friction_coefficient", RobotKeyKind::Positive, "friction of the foot; absent: that of the ground"),
    key("limb", "force_max_n", RobotKeyKind::Positive, "greatest force on the foot, N; absent: any"),
    key("limb", "urdf_link", RobotKeyKind::Text, "link of robot.urdf that is the foot, for inverse kinematics"),
    key("limb", "urdf_foot_m", RobotKeyKind::Three, "contact point of the foot in the frame of urdf_link, m; absent: its origin"),
];
