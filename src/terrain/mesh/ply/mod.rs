//! Stanford PLY: text, and binary of both byte orders.

mod header;
mod values;

use self::header::{Element, Encoding, Header, Kind, Property};
use self::values::Values;
use super::FaceKind;
use super::build::MeshBuilder;
use crate::{
    quantity::Angle,
    terrain::TerrainError,
    world::{FaceGroup, FrictionCone, RestSlope},
};

pub(super) const NAME: &str = "PLY";

/// Whether a file begins like a PLY.
pub(super) fn recognises(beginning: &[u8]) -> bool {
    beginning.strip_prefix(b"ply").is_some_and(|rest| rest.first().is_some_and(u8::is_ascii_whitespace))
}

pub(super) fn damaged(reason: impl Into<String>) -> TerrainError {
    TerrainError::Damaged { format: NAME, reason: reason.into() }
}

/// The error of a sound file whose content is no surface of polygons.
pub(super) fn unsuitable(found: impl Into<String>, expected: &'static str, mend: &str) -> TerrainError {
    TerrainError::Unsuitable { found: found.into(), expected, mend: mend.to_owned() }
}

/// The error of one row.
fn in_row(element: &str, row: u64, problem: &str) -> TerrainError {
    TerrainError::InvalidMesh(format!("{element} {} of the PLY: {problem}", row + 1))
}

/// Reads a PLY: its elements `vertex` (x, y, z) and `face` (a list of vertices); others are skipped.
pub(super) fn read(bytes: &[u8], builder: &mut MeshBuilder) -> Result<(), TerrainError> {
    let (header, body) = Header::read(bytes)?;
    let mut values = Values::new(body, header.encoding);
    for element in &header.elements {
        check_count(element, header.encoding, values.bytes_left())?;
        match element.name.as_str() {
            "vertex" => read_vertices(element, &mut values, builder)?,
            "face" => read_faces(element, &mut values, builder)?,
            "tristrips" => {
                return Err(unsuitable("the PLY has triangle strips", "an element face of polygons", "an export as triangles"));
            }
            _ => read_rows(element, &mut values, &mut |_, _| {}, &mut |_| Ok(()))?,
        }
    }
    Ok(())
}

/// Refuses a count that the rest of the file cannot hold, before memory is allocated.
fn check_count(element: &Element, encoding: Encoding, bytes_left: usize) -> Result<(), TerrainError> {
    let least: u64 = element.properties.iter().map(|property| property.least_bytes(encoding)).sum();
    if element.count > 0 && least == 0 {
        return Err(damaged(format!("element '{}' has no properties", element.name)));
    }
    if element.count.saturating_mul(least) > (bytes_left as u64).saturating_add(1) {
        return Err(damaged(format!(
            "the header promises {} of element '{}', {least} bytes or more each, but {bytes_left} bytes are left",
            element.count, element.name
        )));
    }
    Ok(())
}

/// Reads all rows of an element: passes on every value with the index of its property, and ends every row.
fn read_rows(
    element: &Element,
    values: &mut Values<'_>,
    take: &mut dyn FnMut(usize, f64),
    end_row: &mut dyn FnMut(u64) -> Result<(), TerrainError>,
) -> Result<(), TerrainError> {
    for row in 0..element.count {
        let cut = |reason: String| damaged(format!("element '{}', row {}: {reason}", element.name, row + 1));
        for (number, property) in element.properties.iter().enumerate() {
            match property.list {
                None => take(number, values.next(property.kind).map_err(cut)?),
                Some(count_kind) => {
                    let count = values.next_count(count_kind).map_err(cut)?;
                    for _ in 0..count {
                        take(number, values.next(property.kind).map_err(cut)?);
                    }
                }
            }
        }
        end_row(row)?;
    }
    Ok(())
}

fn read_vertices(element: &Element, values: &mut Values<'_>, builder: &mut MeshBuilder) -> Result<(), TerrainError> {
    let find = |name: &str| {
        let found = element.properties.iter().position(|property| property.name == name && property.list.is_none());
        found.ok_or_else(|| {
            let found = format!("a PLY whose element 'vertex' has no property {name}");
            unsuitable(found, "x, y and z of every vertex, each a number", "an export as a mesh with its vertices' positions")
        })
    };
    let axes = [find("x")?, find("y")?, find("z")?];
    let point = std::cell::Cell::new([f64::NAN; 3]);
    let mut take = |number, value| {
        if let Some(axis) = axes.iter().position(|wanted| *wanted == number) {
            let mut changed = point.get();
            changed[axis] = value;
            point.set(changed);
        }
    };
    let mut end_row = |row| {
        let [x, y, z] = point.get();
        builder.vertex(x, y, z).map(|_| ()).map_err(|problem| in_row("vertex", row, &problem))
    };
    read_rows(element, values, &mut take, &mut end_row)
}

/// The properties of a face that say what its surface is, by the names of the keys of a scenario.
const OF_SURFACE: [&str; 4] = ["friction_coefficient", "friction", "rest_slope_max_deg", "keep_out"];

/// What the values of [`OF_SURFACE`] say of a face; NaN says nothing.
fn face_kind([friction, short, rest_deg, keep_out]: [f64; 4]) -> Result<FaceKind, String> {
    let friction = if friction.is_nan() { short } else { friction };
    let friction = if friction.is_nan() { None } else { Some(FrictionCone::new(friction).map_err(|error| error.to_string())?) };
    let rest = match rest_deg {
        rest_deg if rest_deg.is_nan() => None,
        f64::INFINITY => Some(RestSlope::Unlimited),
        rest_deg if (0.0..=90.0).contains(&rest_deg) => Some(RestSlope::AtMost(Angle::from_degrees(rest_deg))),
        _ => return Err(format!("found a rest_slope_max_deg of {rest_deg}, expected an angle from 0 to 90 degrees, or inf")),
    };
    let keep_out = match keep_out {
        keep_out if keep_out.is_nan() || keep_out == 0.0 => false,
        1.0 => true,
        _ => return Err(format!("found a keep_out of {keep_out}, expected 0 or 1")),
    };
    Ok(FaceKind { names: Vec::new(), stated: FaceGroup { friction, rest, keep_out } })
}

fn read_faces(element: &Element, values: &mut Values<'_>, builder: &mut MeshBuilder) -> Result<(), TerrainError> {
    let names = ["vertex_indices", "vertex_index"];
    let is_corners = |property: &Property| property.list.is_some() && names.contains(&property.name.as_str());
    let list = element.properties.iter().position(is_corners);
    let whole = "an element face with a list vertex_indices of whole numbers";
    let mend = "an export as triangles, such as property list uchar int vertex_indices";
    let list = list.ok_or_else(|| unsuitable("a PLY whose element 'face' has no list vertex_indices", whole, mend))?;
    if matches!(element.properties[list].kind, Kind::F32 | Kind::F64) {
        return Err(unsuitable("a PLY whose list vertex_indices holds fractions", whole, mend));
    }
    let of_surface =
        OF_SURFACE.map(|name| element.properties.iter().position(|property| property.list.is_none() && property.name == name));
    let corners = std::cell::RefCell::new(Vec::new());
    let stated = std::cell::Cell::new([f64::NAN; 4]);
    let mut take = |number, value| {
        if number == list {
            corners.borrow_mut().push(value);
        } else if let Some(at) = of_surface.iter().position(|property| *property == Some(number)) {
            let mut changed = stated.get();
            changed[at] = value;
            stated.set(changed);
        }
    };
    let mut end_row = |row| {
        let at_face = |problem: String| in_row("face", row, &problem);
        builder.begin_faces(face_kind(stated.replace([f64::NAN; 4])).map_err(at_face)?);
        let named: Result<Vec<u32>, String> = corners.borrow_mut().drain(..).map(vertex_index).collect();
        builder.polygon(&named.map_err(at_face)?).map_err(at_face)
    };
    read_rows(element, values, &mut take, &mut end_row)
}

/// A vertex index; PLY counts from 0.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the type's range, and whole")]
fn vertex_index(value: f64) -> Result<u32, String> {
    if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
        Ok(value as u32)
    } else {
        Err(format!("found the vertex {value}, expected a whole number from 0"))
    }
}

#[cfg(test)]
mod tests;
