//! Stanford PLY: text, and binary of both byte orders.

mod header;
mod values;

use self::header::{Element, Encoding, Header, Kind, Property};
use self::values::Values;
use super::build::MeshBuilder;
use crate::terrain::TerrainError;

pub(super) const NAME: &str = "PLY";

/// Whether a file begins like a PLY.
pub(super) fn recognises(beginning: &[u8]) -> bool {
    beginning.starts_with(b"ply\n") || beginning.starts_with(b"ply\r")
}

pub(super) fn damaged(reason: impl Into<String>) -> TerrainError {
    TerrainError::Damaged { format: NAME, reason: reason.into() }
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
                return Err(TerrainError::Unsuitable {
                    found: "the PLY has triangle strips".to_owned(),
                    expected: "an element face of polygons",
                    mend: "an export as triangles".to_owned(),
                });
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
        found.ok_or_else(|| damaged(format!("element 'vertex' has no property {name}")))
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
        builder.vertex(x, y, z).map(|_| ()).map_err(|problem| damaged(format!("vertex {}: {problem}", row + 1)))
    };
    read_rows(element, values, &mut take, &mut end_row)
}

fn read_faces(element: &Element, values: &mut Values<'_>, builder: &mut MeshBuilder) -> Result<(), TerrainError> {
    let names = ["vertex_indices", "vertex_index"];
    let is_corners = |property: &Property| property.list.is_some() && names.contains(&property.name.as_str());
    let list = element.properties.iter().position(is_corners);
    let list = list.ok_or_else(|| damaged("element 'face' has no list vertex_indices"))?;
    if matches!(element.properties[list].kind, Kind::F32 | Kind::F64) {
        return Err(damaged("the list vertex_indices holds fractions, expected whole numbers"));
    }
    let corners = std::cell::RefCell::new(Vec::new());
    let mut take = |number, value| {
        if number == list {
            corners.borrow_mut().push(value);
        }
    };
    let mut end_row = |row| {
        let at_face = |problem: String| damaged(format!("face {}: {problem}", row + 1));
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
