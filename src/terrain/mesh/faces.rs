//! What a file states of the faces of a mesh beside their shape: names of groups, friction, keep-out.

use std::collections::{BTreeSet, HashMap};

use crate::world::{FaceGroup, FrictionCone, RestSlope};

/// What a file states of a face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceKind {
    /// The names that it bears: of its groups, its object and its material.
    pub names: Vec<String>,
    /// What the file says of its surface.
    pub stated: FaceGroup,
}

impl FaceKind {
    /// A key that tells kinds apart.
    fn key(&self) -> (Vec<String>, [u64; 3]) {
        let FaceGroup { friction, rest, keep_out } = self.stated;
        let friction = friction.map_or(f64::NAN, FrictionCone::coefficient);
        let rest = match rest {
            Some(RestSlope::AtMost(angle)) => angle.radians(),
            Some(RestSlope::Unlimited) => f64::INFINITY,
            Some(RestSlope::AsFrictionHolds) | None => f64::NAN,
        };
        (self.names.clone(), [friction.to_bits(), rest.to_bits(), u64::from(keep_out)])
    }
}

/// The kinds of the triangles of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceKinds {
    kinds: Vec<FaceKind>,
    /// Of every triangle; empty where all are of the first kind.
    of: Vec<u32>,
}

impl Default for FaceKinds {
    fn default() -> Self {
        Self { kinds: vec![FaceKind::default()], of: Vec::new() }
    }
}

impl FaceKinds {
    /// The kinds, the first of which is that of a face of which nothing is stated.
    pub fn kinds(&self) -> &[FaceKind] {
        &self.kinds
    }

    /// The number of the kind of a triangle.
    pub fn of(&self, triangle: usize) -> usize {
        self.of.get(triangle).map_or(0, |kind| *kind as usize)
    }

    /// Whether nothing is stated of any face but names.
    pub fn are_bare(&self) -> bool {
        self.kinds.iter().all(|kind| kind.stated == FaceGroup::default())
    }

    /// All names, in alphabetical order.
    pub fn names(&self) -> BTreeSet<&str> {
        self.kinds.iter().flat_map(|kind| &kind.names).map(String::as_str).collect()
    }

    /// Keeps the triangles of which a condition holds.
    pub(super) fn retain(&mut self, mut keeps: impl FnMut(usize) -> bool) {
        let mut triangle = 0;
        self.of.retain(|_| {
            triangle += 1;
            keeps(triangle - 1)
        });
    }
}

/// Kinds under construction.
#[derive(Debug, Default)]
pub(in crate::terrain) struct FaceKindsBuilder {
    done: FaceKinds,
    known: HashMap<(Vec<String>, [u64; 3]), u32>,
    current: u32,
    /// Triangles that have a kind.
    filled: usize,
}

impl FaceKindsBuilder {
    /// The kind of the triangles that follow.
    pub(in crate::terrain) fn begin(&mut self, kind: FaceKind) {
        if self.done.kinds[self.current as usize] == kind {
            return;
        }
        let next = u32::try_from(self.done.kinds.len()).unwrap_or(u32::MAX);
        self.current = if kind == FaceKind::default() {
            0
        } else {
            *self.known.entry(kind.key()).or_insert_with(|| {
                self.done.kinds.push(kind);
                next
            })
        };
    }

    /// The triangles up to a count that have no kind yet are of the current one.
    pub(in crate::terrain) fn fill(&mut self, triangles: usize) {
        if self.current > 0 && self.done.of.is_empty() {
            self.done.of.resize(self.filled, 0);
        }
        if self.current > 0 || !self.done.of.is_empty() {
            self.done.of.resize(triangles, self.current);
        }
        self.filled = triangles;
    }

    /// Keeps the triangles of which a condition holds.
    pub(in crate::terrain) fn retain(&mut self, keeps: impl FnMut(usize) -> bool) {
        self.done.retain(keeps);
    }

    pub(in crate::terrain) fn finish(self) -> FaceKinds {
        self.done
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_kept_once_and_the_first_faces_without_one_are_bare() {
        let mut builder = FaceKindsBuilder::default();
        let named = |name: &str| FaceKind { names: vec![name.to_owned()], ..FaceKind::default() };
        builder.fill(2);
        builder.begin(named("rock"));
        builder.fill(3);
        builder.begin(named("sand"));
        builder.fill(5);
        builder.begin(named("rock"));
        builder.fill(6);
        builder.retain(|triangle| triangle != 3);
        let kinds = builder.finish();
        assert_eq!((0..5).map(|triangle| kinds.of(triangle)).collect::<Vec<_>>(), [0, 0, 1, 2, 1]);
        assert_eq!((kinds.kinds().len(), kinds.names().into_iter().collect::<Vec<_>>()), (3, vec!["rock", "sand"]));
        assert!(kinds.are_bare());
    }
}
