//! A roadmap as JSON: built once, asked often.

use std::{
    fmt::Write as _,
    io::{Read, Write},
};

use nalgebra::Point3;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::Roadmap;
use crate::{
    ground::MeshGround,
    quantity::{FacetId, SlopeInterval},
};

/// The kind and version of the file.
const SCHEMA: &str = "chta/roadmap/1";

/// Why a file is no roadmap of a ground.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RoadmapFileError {
    /// Not JSON, a key too few or too many, or not readable.
    #[error("this is no roadmap ({0}), expected the JSON file of a plan over this mesh")]
    Json(#[from] serde_json::Error),
    /// Another kind or version of file.
    #[error("found a file of schema \"{found}\", expected a roadmap, \"{SCHEMA}\"")]
    Schema {
        /// What was found.
        found: String,
    },
    /// It was built for another mesh, hopper, gravity or surface, or by another version.
    #[error(
        "this roadmap was built for another mesh, hopper, gravity or surface, or by another version, expected one of this scenario: build it again"
    )]
    OtherGround,
    /// A hop that the mesh does not have.
    #[error("a hop of this roadmap is not feasible over the mesh, expected the file as it was written: build it again")]
    Hop,
    /// A contact that is not on the mesh.
    #[error("contact {number} does not lie on its facets of the mesh")]
    Contact {
        /// Which, from 0.
        number: usize,
    },
    /// A window that cannot be.
    #[error(
        "window {number} is not valid: expected two different contacts of the file and lofts from 0 up, ascending among the windows of a hop, which \
         stand together"
    )]
    Window {
        /// Which, from 0.
        number: usize,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RoadmapFile {
    schema: String,
    /// SHA-256 of the mesh, hopper, gravity and surface.
    ground_sha256: String,
    pairs_tested: u64,
    contacts: Vec<ContactRow>,
    /// Take-off and landing by the numbers of their contacts, and the least and the greatest loft.
    windows: Vec<(u32, u32, f64, f64)>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ContactRow {
    point_m: [f64; 3],
    moved_m: f64,
    stand_off_m: f64,
    /// From 0.
    facets: Vec<usize>,
}

impl Roadmap {
    /// Writes it as JSON, for the ground that it was built on.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_json(&self, ground: &MeshGround, out: impl Write) -> Result<(), serde_json::Error> {
        let contacts = self.graph().node_weights().map(|contact| ContactRow {
            point_m: contact.point_m().coords.into(),
            moved_m: contact.moved_m(),
            stand_off_m: contact.stand_off_m(),
            facets: contact.facets().iter().map(|facet| facet.id.index()).collect(),
        });
        let number = |node: usize| u32::try_from(node).unwrap_or(u32::MAX);
        let windows = self.all_windows().map(|(from, to, lofts)| (number(from), number(to), lofts.lower, lofts.upper));
        let file = RoadmapFile {
            schema: SCHEMA.to_owned(),
            ground_sha256: fingerprint(ground),
            pairs_tested: self.pairs_tested(),
            contacts: contacts.collect(),
            windows: windows.collect(),
        };
        serde_json::to_writer(out, &file)
    }

    /// Reads what [`write_json`](Self::write_json) wrote, for the same ground.
    ///
    /// # Errors
    /// [`RoadmapFileError`].
    pub fn read_json(ground: &MeshGround, input: impl Read) -> Result<Self, RoadmapFileError> {
        let file: RoadmapFile = serde_json::from_reader(input)?;
        if file.schema != SCHEMA {
            return Err(RoadmapFileError::Schema { found: file.schema });
        }
        if file.ground_sha256 != fingerprint(ground) {
            return Err(RoadmapFileError::OtherGround);
        }
        let mut contacts = Vec::with_capacity(file.contacts.len());
        for (number, row) in file.contacts.iter().enumerate() {
            let facets: Vec<FacetId> = row.facets.iter().copied().map(FacetId).collect();
            let contact = ground.known_contact(Point3::from(row.point_m), (row.moved_m, row.stand_off_m), &facets);
            contacts.push(contact.ok_or(RoadmapFileError::Contact { number })?);
        }
        let mut windows: Vec<(u32, u32, SlopeInterval)> = Vec::with_capacity(file.windows.len());
        let mut known = std::collections::HashSet::new();
        for (number, (from, to, lower, upper)) in file.windows.into_iter().enumerate() {
            let exists = |node: u32| (node as usize) < contacts.len();
            let goes_on = match windows.last() {
                Some((last_from, last_to, last)) if (*last_from, *last_to) == (from, to) => last.upper <= lower,
                _ => known.insert((from, to)),
            };
            if !(exists(from) && exists(to) && from != to && 0.0 <= lower && lower <= upper && upper.is_finite() && goes_on) {
                return Err(RoadmapFileError::Window { number });
            }
            windows.push((from, to, SlopeInterval { lower, upper }));
        }
        Ok(Self::of_parts(contacts, &windows, file.pairs_tested))
    }
}

/// A number for all that the windows depend on.
fn fingerprint(ground: &MeshGround) -> String {
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    let mesh = ground.tree().mesh();
    for coordinate in mesh.vertices().iter().flat_map(|vertex| vertex.coords.iter()) {
        hash.update(coordinate.to_bits().to_le_bytes());
    }
    for corner in mesh.indices().iter().flatten() {
        hash.update(corner.to_le_bytes());
    }
    for triangle in 0..mesh.triangle_count() {
        hash.update(mesh.faces().of(triangle).to_le_bytes());
    }
    // Numbers are printed with all of their digits.
    hash.update(format!("{:?} {:?}", ground.envelope(), ground.face_surfaces()));
    hash.finalize().iter().fold(String::new(), |mut text, byte| {
        // Writing to a String cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}
