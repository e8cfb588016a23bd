//! URDF: the XML of links and joints of ROS. What kinematics, trunk boxes and masses need is read; pictures, transmissions and plugins are not.

use std::fmt;

use nalgebra::{Point3, Unit, Vector3};
use roxmltree::{Document, Node};

use super::{Frame, JointKind, ModelJoint, ModelLink, RobotModel};
use crate::{
    quantity::{Angle, excerpt},
    world::{TrunkBox, roll_pitch_yaw},
};

/// One problem of a URDF.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UrdfProblem {
    /// The line, from 1.
    pub line: u32,
    /// What was found, what is expected, and how to mend it.
    pub message: String,
}

/// All problems of a URDF.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
pub struct InvalidUrdf(pub Vec<UrdfProblem>);

impl fmt::Display for UrdfProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

/// The model of a text.
pub(super) fn read(text: &str) -> Result<RobotModel, InvalidUrdf> {
    let document = Document::parse(text).map_err(|error| {
        let message = format!("this is not XML: {error}; expected a URDF, with <robot> around links and joints");
        InvalidUrdf(vec![UrdfProblem { line: error.pos().row, message }])
    })?;
    let robot = document.root_element();
    let mut reader = Reader { document: &document, problems: Vec::new() };
    if robot.tag_name().name() != "robot" {
        reader.problem(&robot, format!("found <{}>, expected <robot>", excerpt(robot.tag_name().name(), 40)));
        return Err(InvalidUrdf(reader.problems));
    }
    let of_name = |name: &'static str| robot.children().filter(move |node| node.has_tag_name(name));
    let mut links: Vec<ModelLink> = Vec::new();
    for node in of_name("link") {
        let link = reader.link(&node);
        if links.iter().any(|known| known.name == link.name) {
            reader.problem(&node, format!("link '{}' stands twice, expected one of a name", link.name));
        }
        links.push(link);
    }
    let mut joints: Vec<ModelJoint> = Vec::new();
    for node in of_name("joint") {
        if let Some(joint) = reader.joint(&node, &links) {
            if let Some(other) = joints.iter().find(|other| other.child == joint.child) {
                let (name, other) = (&links[joint.child].name, &other.name);
                reader.problem(
                    &node,
                    format!(
                        "joint '{}' moves link '{name}', which joint '{other}' moves too, expected one joint for each",
                        joint.name
                    ),
                );
            }
            joints.push(joint);
        }
    }
    let root = reader.root(&robot, &links, &joints);
    match root {
        Some(root) if reader.problems.is_empty() => {
            let name = robot.attribute("name").unwrap_or_default().to_owned();
            Ok(RobotModel { name, links, joints, root })
        }
        _ => Err(InvalidUrdf(reader.problems)),
    }
}

struct Reader<'a, 'input> {
    document: &'a Document<'input>,
    problems: Vec<UrdfProblem>,
}

/// The first element of a name in another.
fn child<'a, 'input>(node: &Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.children().find(|inner| inner.has_tag_name(name))
}

impl Reader<'_, '_> {
    fn problem(&mut self, node: &Node<'_, '_>, message: String) {
        self.problems.push(UrdfProblem { line: self.document.text_pos_at(node.range().start).row, message });
    }

    /// The numbers of an attribute, if it is given.
    fn numbers<const N: usize>(&mut self, node: &Node<'_, '_>, name: &str) -> Option<[f64; N]> {
        let text = node.attribute(name)?;
        let numbers: Option<Vec<f64>> =
            text.split_whitespace().map(|word| word.parse().ok().filter(|number: &f64| number.is_finite())).collect();
        let numbers = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
        if numbers.is_none() {
            let expected = if N == 1 { "a finite number".to_owned() } else { format!("{N} finite numbers") };
            self.problem(node, format!("{name} of <{}> is '{}', expected {expected}", node.tag_name().name(), excerpt(text, 60)));
        }
        numbers
    }

    fn number(&mut self, node: &Node<'_, '_>, name: &str) -> Option<f64> {
        self.numbers::<1>(node, name).map(|[number]| number)
    }

    /// The frame of the element `origin` in another; absent: that element's own.
    fn origin(&mut self, node: &Node<'_, '_>) -> Frame {
        let Some(origin) = child(node, "origin") else { return Frame::identity() };
        let at = self.numbers::<3>(&origin, "xyz").unwrap_or_default();
        let angles = self.numbers::<3>(&origin, "rpy").unwrap_or_default();
        Frame { axes: roll_pitch_yaw(angles.map(Angle::from_radians)), origin_m: Vector3::from(at) }
    }

    fn name(&mut self, node: &Node<'_, '_>) -> String {
        if node.attribute("name").is_none() {
            self.problem(node, format!("found a <{}> without name", node.tag_name().name()));
        }
        node.attribute("name").unwrap_or_default().to_owned()
    }

    fn link(&mut self, node: &Node<'_, '_>) -> ModelLink {
        let mut link = ModelLink { name: self.name(node), mass_kg: 0.0, boxes: Vec::new(), meshes: 0 };
        if let Some(mass) = child(node, "inertial").and_then(|inertial| child(&inertial, "mass")) {
            link.mass_kg = self.number(&mass, "value").unwrap_or(0.0);
            if link.mass_kg < 0.0 {
                self.problem(
                    &mass,
                    format!("the mass of link '{}' is {}, expected a number of at least 0", link.name, link.mass_kg),
                );
            }
        }
        for collision in node.children().filter(|inner| inner.has_tag_name("collision")) {
            let frame = self.origin(&collision);
            let shapes =
                child(&collision, "geometry").map(|geometry| geometry.children().filter(Node::is_element).collect::<Vec<_>>());
            for shape in shapes.unwrap_or_default() {
                match self.size(&shape) {
                    Some(size) => {
                        link.boxes.push(TrunkBox {
                            centre_m: Point3::from(frame.origin_m),
                            half_m: 0.5 * Vector3::from(size),
                            axes: frame.axes,
                        });
                    }
                    None => link.meshes += usize::from(shape.has_tag_name("mesh")),
                }
            }
        }
        link
    }

    /// The size of the box around a shape; `None` of a mesh, and of a shape with a problem.
    fn size(&mut self, shape: &Node<'_, '_>) -> Option<[f64; 3]> {
        let size = match shape.tag_name().name() {
            "box" => self.numbers::<3>(shape, "size")?,
            "sphere" => [2.0 * self.number(shape, "radius")?; 3],
            name @ ("cylinder" | "capsule") => {
                let (radius, length) = (self.number(shape, "radius")?, self.number(shape, "length")?);
                // A capsule has a half of a ball at either end.
                [2.0 * radius, 2.0 * radius, if name == "capsule" { length + 2.0 * radius } else { length }]
            }
            _ => return None,
        };
        if size.iter().all(|edge| *edge > 0.0) {
            return Some(size);
        }
        self.problem(shape, format!("the box around <{}> measures {size:?} m, expected numbers above 0", shape.tag_name().name()));
        None
    }

    /// The link that an element of a joint names, by its place among the links.
    fn linked(&mut self, joint: &Node<'_, '_>, name: &str, part: &str, links: &[ModelLink]) -> Option<usize> {
        let link = child(joint, part).and_then(|node| node.attribute("link"));
        let place = links.iter().position(|known| Some(known.name.as_str()) == link);
        if place.is_none() {
            let found = link.map_or_else(|| "absent".to_owned(), |link| format!("'{}'", excerpt(link, 60)));
            self.problem(joint, format!("the {part} of joint '{name}' is {found}, expected the name of a link"));
        }
        place
    }

    fn joint(&mut self, node: &Node<'_, '_>, links: &[ModelLink]) -> Option<ModelJoint> {
        let name = self.name(node);
        let (parent, child_link) = (self.linked(node, &name, "parent", links), self.linked(node, &name, "child", links));
        let follows = child(node, "mimic").is_some();
        let kind = match node.attribute("type") {
            Some("fixed") => JointKind::Fixed,
            Some("revolute" | "continuous" | "prismatic" | "floating" | "planar") if follows => JointKind::Other,
            Some("revolute") => JointKind::Revolute,
            Some("continuous") => JointKind::Continuous,
            Some("prismatic") => JointKind::Prismatic,
            Some("floating" | "planar") => JointKind::Other,
            other => {
                let found = other.map_or_else(|| "absent".to_owned(), |other| format!("'{}'", excerpt(other, 60)));
                let kinds = "fixed, revolute, continuous, prismatic, floating or planar";
                self.problem(node, format!("the type of joint '{name}' is {found}, expected {kinds}"));
                JointKind::Other
            }
        };
        let frame = self.origin(node);
        let axis = child(node, "axis").and_then(|axis| self.numbers::<3>(&axis, "xyz")).map_or_else(Vector3::x, Vector3::from);
        let axis = Unit::try_new(axis, 0.0).unwrap_or_else(|| {
            self.problem(node, format!("the axis of joint '{name}' is [0, 0, 0], expected a direction"));
            Vector3::x_axis()
        });
        let limit = child(node, "limit");
        let mut stated = |key: &str| limit.as_ref().and_then(|limit| self.number(limit, key)).unwrap_or(0.0);
        let [lower, upper, effort, velocity] = ["lower", "upper", "effort", "velocity"].map(&mut stated);
        let has_range = matches!(kind, JointKind::Revolute | JointKind::Prismatic);
        if has_range && limit.is_none() {
            self.problem(node, format!("joint '{name}' has no <limit>, expected one with lower and upper, or type continuous"));
        } else if has_range && lower > upper {
            self.problem(node, format!("joint '{name}' has lower {lower} above upper {upper}, expected a range"));
        }
        Some(ModelJoint { name, kind, parent: parent?, child: child_link?, frame, axis, lower, upper, effort, velocity })
    }

    /// The link that no joint moves, of which there has to be one, from which all others hang.
    fn root(&mut self, robot: &Node<'_, '_>, links: &[ModelLink], joints: &[ModelJoint]) -> Option<usize> {
        let is_moved = |link: usize| joints.iter().any(|joint| joint.child == link);
        let roots: Vec<usize> = (0..links.len()).filter(|&link| !is_moved(link)).collect();
        let [root] = roots[..] else {
            // Of joints with a problem, links without one are a consequence.
            if self.problems.is_empty() {
                // Four names show what is meant.
                let names: Vec<_> = roots.iter().take(4).map(|&root| format!("'{}'", links[root].name)).collect();
                let more =
                    if roots.len() > names.len() { format!(" and {} more", roots.len() - names.len()) } else { String::new() };
                let found = if names.is_empty() { "no link".to_owned() } else { format!("{}{more}", names.join(", ")) };
                self.problem(
                    robot,
                    format!("found {found} that no joint moves, expected one: the trunk, from which all limbs hang"),
                );
            }
            return None;
        };
        // One joint for each other link, and one root: what does not hang from it is a circle.
        let (mut reached, mut next) = (vec![false; links.len()], vec![root]);
        while let Some(link) = next.pop() {
            if !std::mem::replace(&mut reached[link], true) {
                next.extend(joints.iter().filter(|joint| joint.parent == link).map(|joint| joint.child));
            }
        }
        if let Some(apart) = reached.iter().position(|reached| !reached)
            && self.problems.is_empty()
        {
            self.problem(
                robot,
                format!("link '{}' hangs from no other but in a circle of joints, expected a tree", links[apart].name),
            );
        }
        Some(root)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const JOINT: &str = "<joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 2'/>\n<limit lower='-1' upper='1' effort='3' velocity='4'/></joint>";

    fn robot(inner: &str) -> Result<RobotModel, InvalidUrdf> {
        read(&format!("<robot name='r'>\n<link name='a'/><link name='b'/>\n{inner}\n</robot>"))
    }

    #[test]
    fn links_joints_and_shapes_are_read() {
        let shapes = "<link name='c'><inertial><mass value='2.5'/></inertial><collision><origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/><geometry><box size='1 2 3'/></geometry></collision>\
            <collision><geometry><cylinder radius='1' length='4'/></geometry></collision><collision><geometry><mesh filename='x.stl'/></geometry></collision></link>\
            <joint name='k' type='fixed'><parent link='a'/><child link='c'/><origin xyz='5 0 0'/></joint>";
        let model = robot(&format!("{JOINT}{shapes}")).unwrap();
        assert_eq!((model.name(), model.root().name.as_str(), model.mass_kg()), ("r", "a", Some(2.5)));
        let joint = &model.joints()[0];
        assert_eq!(
            (joint.kind, joint.lower, joint.upper, joint.effort, joint.velocity),
            (JointKind::Revolute, -1.0, 1.0, 3.0, 4.0)
        );
        assert_eq!(joint.axis, Vector3::z_axis());
        let (boxes, meshes) = model.trunk();
        assert_eq!((boxes.len(), meshes), (2, 1));
        assert_eq!((boxes[0].centre_m, boxes[0].half_m), (Point3::new(5.0, 0.0, 1.0), Vector3::new(0.5, 1.0, 1.5)));
        assert!((boxes[0].axes * Vector3::x() - Vector3::y()).norm() < 1e-15);
        assert_eq!(boxes[1].half_m, Vector3::new(1.0, 1.0, 2.0));
    }

    #[test]
    fn every_problem_is_reported_with_its_line() {
        for (inner, line, part) in [
            (JOINT.replace("link='b'", "link='x'"), 3, "the child of joint 'j' is 'x', expected the name of a link"),
            (JOINT.replace("<parent link='a'/>", ""), 3, "the parent of joint 'j' is absent"),
            (JOINT.replace("revolute", "hinge"), 3, "the type of joint 'j' is 'hinge'"),
            (JOINT.replace("0 0 2", "0 0 0"), 3, "the axis of joint 'j' is [0, 0, 0]"),
            (JOINT.replace("0 0 2", "0 0"), 3, "xyz of <axis> is '0 0', expected 3 finite numbers"),
            (JOINT.replace("'-1'", "'nan'"), 4, "lower of <limit> is 'nan', expected a finite number"),
            (JOINT.replace("'-1'", "'2'"), 3, "joint 'j' has lower 2 above upper 1"),
            (JOINT.replace("<limit lower='-1' upper='1' effort='3' velocity='4'/>", ""), 3, "joint 'j' has no <limit>"),
            (String::new(), 1, "found 'a', 'b' that no joint moves, expected one"),
            (
                format!("{JOINT}<joint name='k' type='fixed'><parent link='a'/><child link='b'/></joint>"),
                4,
                "which joint 'j' moves too",
            ),
            (format!("{JOINT}<link name='a'/>"), 4, "link 'a' stands twice"),
            (
                format!(
                    "{JOINT}<link name='c'/><link name='d'/><joint name='k' type='fixed'><parent link='c'/><child link='d'/></joint><joint name='l' type='fixed'><parent link='d'/><child link='c'/></joint>"
                ),
                1,
                "in a circle of joints",
            ),
            (
                format!("{JOINT}<link name='c'><collision><geometry><box size='1 -1 1'/></geometry></collision></link>"),
                4,
                "expected numbers above 0",
            ),
        ] {
            let InvalidUrdf(problems) = robot(&inner).unwrap_err();
            assert!(
                problems.iter().any(|problem| problem.line == line && problem.message.contains(part)),
                "{inner}\n{problems:?}\n  {line}: {part}"
            );
        }
        assert!(robot("<link").unwrap_err().to_string().contains("this is not XML"));
        assert!(read("<sdf/>").unwrap_err().to_string().contains("found <sdf>, expected <robot>"));
        // All at once.
        let two = JOINT.replace("0 0 2", "0 0 0").replace("'-1'", "'2'");
        assert_eq!(robot(&two).unwrap_err().0.len(), 2);
    }

    #[test]
    fn feet_that_are_no_feet_are_refused() {
        let model = robot(JOINT).unwrap();
        assert!(model.limb("b", Point3::origin()).is_ok());
        let refused = |model: &RobotModel, link: &str| model.limb(link, Point3::origin()).unwrap_err().to_string();
        assert!(refused(&model, "a").contains("no joint moves link 'a'"));
        assert!(refused(&model, "bb").contains("no link 'bb', expected one of the 2 links of the model; the nearest is 'b'"));
        let follows = robot(&JOINT.replace("<axis", "<mimic joint='k'/><axis")).unwrap();
        assert!(refused(&follows, "b").contains("joint 'j' before link 'b'"));
    }
}
