//! The surface of every kind of face of a mesh: that of the scenario, where neither the file nor a named group says otherwise.

use std::sync::Arc;

use super::MeshGround;
use crate::{
    chain::FacetGround,
    quantity::FacetId,
    terrain::FaceKinds,
    world::{Derating, FaceGroup, FaceGroups, SurfaceProperties},
};

/// What holds on a kind of face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::ground) struct FaceSurface {
    pub(in crate::ground) ground: FacetGround,
    pub(in crate::ground) surface: SurfaceProperties,
}

/// A group that no face of a mesh belongs to.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("found surface.group.{name}, expected a group, object or material of the mesh: {known}")]
pub struct UnknownGroup {
    /// The name in the scenario.
    pub name: String,
    /// The names that the mesh has, for a sentence.
    pub known: String,
}

/// The surfaces of all kinds of faces.
pub(super) fn surfaces(
    faces: &FaceKinds,
    surface: &SurfaceProperties,
    groups: &FaceGroups,
    derating: &Derating,
) -> Arc<[FaceSurface]> {
    let of_kind = |kind: &crate::terrain::FaceKind| {
        let named = kind.names.iter().filter_map(|name| groups.get(name));
        // Groups that the scenario states replace what the file says; of several the stricter counts.
        let group = named.fold(FaceGroup::default(), |all, group| all.and(*group));
        let friction = group.friction.or(kind.stated.friction).map(|cone| derating.cone(cone));
        let rest = group.rest.or(kind.stated.rest).unwrap_or(surface.rest);
        FaceSurface {
            ground: FacetGround { friction, keep_out: group.keep_out || kind.stated.keep_out },
            surface: SurfaceProperties { rest, ..*surface },
        }
    };
    faces.kinds().iter().map(of_kind).collect()
}

impl MeshGround {
    /// The same ground with the surfaces of named groups of faces, and of faces of which the file states one. Planning may use the stated
    /// share of their friction.
    ///
    /// # Errors
    /// [`UnknownGroup`], if no face bears a name.
    pub fn with_groups(mut self, groups: &FaceGroups, derating: &Derating) -> Result<Self, UnknownGroup> {
        let faces = self.tree.mesh().faces();
        let names = faces.names();
        if let Some(name) = groups.keys().find(|name| !names.contains(name.as_str())) {
            let known = match names.len() {
                0 => "it has none (the statements g, o and usemtl of an OBJ give them)".to_owned(),
                1..=20 => names.into_iter().collect::<Vec<_>>().join(", "),
                count => format!("{}, ... ({count} names)", names.into_iter().take(20).collect::<Vec<_>>().join(", ")),
            };
            return Err(UnknownGroup { name: name.clone(), known });
        }
        self.faces = surfaces(faces, &self.surface, groups, derating);
        self.groups = Arc::new(groups.clone());
        Ok(self)
    }

    /// The same ground with the surfaces that another one of the same mesh has for its groups, with the whole of their friction.
    pub(super) fn with_groups_of(mut self, other: &Self) -> Self {
        self.faces = surfaces(self.tree.mesh().faces(), &self.surface, &other.groups, &Derating::NONE);
        self.groups = Arc::clone(&other.groups);
        self
    }

    /// The surface of a facet.
    pub(in crate::ground) fn face_surface(&self, facet: FacetId) -> &FaceSurface {
        &self.faces[self.tree.mesh().faces().of(facet.index())]
    }

    /// The surface of every kind of face, to be compared as text.
    pub(crate) fn face_surfaces(&self) -> &dyn std::fmt::Debug {
        &self.faces
    }

    /// The names of the groups, the object and the material of a facet.
    pub fn names_of(&self, facet: FacetId) -> &[String] {
        let faces = self.tree.mesh().faces();
        &faces.kinds()[faces.of(facet.index())].names
    }
}
