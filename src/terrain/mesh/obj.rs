//! Wavefront OBJ: the lines `v` and `f`, and the names of `g`, `o` and `usemtl`; normals and texture are ignored.

use super::FaceKind;
use super::build::MeshBuilder;
use super::text::{in_line, lines, shown, three};
use crate::terrain::TerrainError;

pub(super) const NAME: &str = "OBJ";

/// Statements without surface geometry.
const WITHOUT_SURFACE: [&str; 14] =
    ["vn", "vt", "vp", "s", "mtllib", "l", "p", "mg", "lod", "usemap", "maplib", "shadow_obj", "trace_obj", "bevel"];

/// Statements that name the faces after them.
const NAMING: [&str; 3] = ["g", "o", "usemtl"];

/// The names of the faces that follow, by the statements [`NAMING`].
#[derive(Debug, Default)]
struct Names([Vec<String>; 3]);

impl Names {
    /// Replaces the names of a statement.
    fn replace(&mut self, at: usize, words: std::str::SplitAsciiWhitespace<'_>, builder: &mut MeshBuilder) {
        // An object and a material have one name, which may hold blanks; a face may be in several groups.
        self.0[at] = match NAMING[at] {
            "g" => words.map(str::to_owned).collect(),
            _ => vec![words.collect::<Vec<_>>().join(" ")],
        };
        self.0[at].retain(|name| !name.is_empty());
        let mut names: Vec<String> = self.0.concat();
        names.sort_unstable();
        names.dedup();
        builder.begin_faces(FaceKind { names, ..FaceKind::default() });
    }
}

/// Statements of curves and curved surfaces, and of files to be read in.
const FREE_FORM: [&str; 19] = [
    "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp", "end", "con", "ctech", "stech",
    "bzp", "bsp", "call",
];

/// Whether a text begins like an OBJ: its first line, not counting empty lines and comments, is a statement.
pub(super) fn recognises(beginning: &[u8]) -> bool {
    let first = lines(beginning).find(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    first.is_some_and(|(_, line)| {
        let word = line.split_ascii_whitespace().next().unwrap_or_default();
        (["v", "f", "fo"].contains(&word) || NAMING.contains(&word) || WITHOUT_SURFACE.contains(&word) || FREE_FORM.contains(&word))
            && line.len() > word.len()
    })
}

/// Reads an OBJ.
pub(super) fn read(bytes: &[u8], builder: &mut MeshBuilder) -> Result<(), TerrainError> {
    let (mut corners, mut names) = (Vec::new(), Names::default());
    let mut begun: Option<(usize, String)> = None;
    for (number, line) in lines(bytes) {
        // A backslash at the end of a line joins it with the next one.
        let (number, line) = match begun.take() {
            Some((first, before)) => (first, format!("{before} {line}").into()),
            None => (number, line),
        };
        if let Some(before) = line.strip_suffix('\\') {
            begun = Some((number, before.to_owned()));
            continue;
        }
        if let Some(word) = line.split_ascii_whitespace().next().filter(|word| FREE_FORM.contains(word)) {
            return Err(TerrainError::Unsuitable {
                found: format!("curved geometry (the statement '{word}' in line {number} of the OBJ)"),
                expected: "polygons (v and f)",
                mend: "an export of the model as polygons".to_owned(),
            });
        }
        statement(&line, builder, (&mut corners, &mut names)).map_err(|problem| in_line(NAME, number, &problem))?;
    }
    match begun {
        Some((number, _)) => Err(in_line(NAME, number, "the file ends after a backslash, expected one more line")),
        None => Ok(()),
    }
}

/// Reads one statement.
fn statement(line: &str, builder: &mut MeshBuilder, (corners, names): (&mut Vec<u32>, &mut Names)) -> Result<(), String> {
    let content = line.split('#').next().unwrap_or_default();
    let mut words = content.split_ascii_whitespace();
    match words.next() {
        None => Ok(()),
        Some("v") => {
            // A weight or a colour may follow.
            let [x, y, z] = three(&mut words)?;
            builder.vertex(x, y, z).map(|_| ())
        }
        Some("f" | "fo") => {
            corners.clear();
            for word in words {
                corners.push(corner(word, builder.vertex_count())?);
            }
            builder.polygon(corners)
        }
        Some(word) if WITHOUT_SURFACE.contains(&word) => Ok(()),
        Some(word) if NAMING.contains(&word) => {
            let at = NAMING.iter().position(|known| *known == word).unwrap_or_default();
            names.replace(at, words, builder);
            Ok(())
        }
        Some(word) => Err(format!(
            "found the statement '{}', expected v, f or one without a surface; export the mesh as polygons",
            shown(word)
        )),
    }
}

/// Parses the vertex of `v`, `v/vt`, `v//vn` or `v/vt/vn`: counted from 1, or backwards from -1.
fn corner(word: &str, count: usize) -> Result<u32, String> {
    let wrong = || format!("found the corner '{}', expected a vertex from 1 to {count}, or from -1 to -{count}", shown(word));
    let index: i64 = word.split('/').next().unwrap_or_default().parse().map_err(|_| wrong())?;
    let count = i64::try_from(count).map_err(|_| wrong())?;
    let from_zero = if index > 0 { index - 1 } else { count + index };
    if index == 0 || !(0..count).contains(&from_zero) {
        return Err(wrong());
    }
    u32::try_from(from_zero).map_err(|_| wrong())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(text: &str) -> Result<Vec<[u32; 3]>, String> {
        let mut builder = MeshBuilder::new(1.0);
        read(text.as_bytes(), &mut builder).map_err(|error| error.to_string())?;
        builder.finish().map(|(mesh, _)| mesh.indices().to_vec()).map_err(|error| error.to_string())
    }

    const POINTS: &str = "v 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1e0 0\n";

    #[test]
    fn all_forms_of_a_corner_are_read() {
        for face in [
            "f 1 2 3",
            "f 1/1 2/2 3/3 # face",
            "f 1//9 2//9 3//9",
            "f 1/4/9 2/4/9 3/4/9",
            "f -4 -3 -2",
            "f 1 \\\n 2 \\\n 3",
            "fo 1 2 3",
        ] {
            assert_eq!(
                mesh(&format!("# ours\nmtllib a.mtl\n\n{POINTS}g rock\nusemtl grey\n{face}\r\n")).unwrap(),
                [[0, 1, 2]],
                "{face}"
            );
            assert_eq!(mesh(&format!("{POINTS}{face}\n").replace('\n', "\r")).unwrap(), [[0, 1, 2]], "{face}");
        }
    }

    #[test]
    fn curved_surfaces_are_named() {
        for statement in ["cstype bspline", "surf 0 1 0 1 1 2 3", "curv 0 1 1 2", "call other.obj"] {
            let message = mesh(&format!("{POINTS}{statement}\n")).unwrap_err();
            let word = statement.split(' ').next().unwrap();
            assert!(message.contains(&format!("'{word}' in line 5")) && message.contains("polygons"), "{message}");
            assert!(recognises(statement.as_bytes()), "{statement}");
        }
    }

    #[test]
    fn faults_are_named_with_their_line() {
        for (line, expected) in [
            ("f 1 2 5", "vertex from 1 to 4"),
            ("f 0 1 2", "corner '0'"),
            ("f -5 1 2", "corner '-5'"),
            ("f 1 2", "2 corners"),
            ("f", "without corners"),
            ("f 1 2 x", "corner 'x'"),
            ("f 1 2 99999999999999999999", "corner"),
            ("v 1 2", "the line ends"),
            ("v 1 2 nan", "finite"),
            ("v 1 inf 2", "finite"),
            ("v 1 2 three", "found 'three', expected a number"),
            ("v 1,5 2 3", "not a comma: 1.5"),
            ("surface 0 1 0 1", "statement 'surface'"),
            ("\u{0}\u{1}\u{fffd}", "statement"),
            ("f 1 2 \\", "backslash"),
        ] {
            let message = mesh(&format!("{POINTS}{line}")).unwrap_err();
            assert!(message.contains("OBJ") && message.contains("line 5") && message.contains(expected), "{line}: {message}");
        }
        assert!(mesh(POINTS).unwrap_err().contains("no faces"));
        assert!(mesh(&format!("f 1 2 3\n{POINTS}")).is_err(), "a face before its vertices must be refused");
    }
}
