//! Contacts drawn on a mesh: by area, on every facet, and about a path.

use nalgebra::{Point3, Vector3};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use rayon::prelude::*;

use super::RoadmapSampler;
use crate::{
    ground::{MeshContact, MeshGround, NoMeshContact},
    quantity::FacetId,
};

/// An axis-parallel box, from its lowest to its highest corner, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceBounds {
    /// The lowest coordinates, m.
    pub min: Point3<f64>,
    /// The highest coordinates, m.
    pub max: Point3<f64>,
}

impl SpaceBounds {
    /// Whether a point lies within.
    pub fn contain(&self, point: &Point3<f64>) -> bool {
        (0..3).all(|axis| self.min[axis] <= point[axis] && point[axis] <= self.max[axis])
    }
}

impl std::fmt::Display for SpaceBounds {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { min, max } = self;
        write!(f, "({}, {}, {}) to ({}, {}, {}) m", min.x, min.y, min.z, max.x, max.y, max.z)
    }
}

/// Bounds that hold no facet of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the bounds {bounds} hold no facet of the mesh, which lies within {mesh}: widen them")]
pub struct NothingWithin {
    /// The bounds.
    pub bounds: SpaceBounds,
    /// Those of the mesh.
    pub mesh: SpaceBounds,
}

/// How many contacts were drawn, and why others were left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DrawnContacts {
    /// By area.
    pub by_area: usize,
    /// On a facet without one, or on one of which each has the same probability.
    pub on_facets: usize,
    /// About the best path.
    pub about_path: usize,
    /// Points of the surface inside a closed body, left out; with a stand-off or a ball also those without room for it.
    pub buried: usize,
    /// Points outside the bounds, left out.
    pub outside: usize,
    /// Points left out since no better path leads through them, by straight lines.
    pub useless: usize,
}

/// Draws contacts on a mesh, the same for the same seed.
///
/// Half of them are drawn by area. The other half are the middles of facets in random order, one for each facet, until every one has had
/// its turn: a small bevel may be the only way up.
#[derive(Debug)]
pub struct ContactSampler<'g> {
    ground: &'g MeshGround,
    bounds: Option<SpaceBounds>,
    stand_off_m: f64,
    source: ChaCha8Rng,
    /// The facets that meet the bounds, and the sum of areas up to each.
    facets: Vec<FacetId>,
    areas_m2: Vec<f64>,
    /// The facets in the order of their turns, and how many have had theirs.
    turns: Vec<FacetId>,
    turned: usize,
    drawn: DrawnContacts,
}

/// A point to become a contact.
#[derive(Clone, Copy)]
enum Candidate {
    ByArea(Point3<f64>),
    OnFacet(Point3<f64>),
    AboutPath(Point3<f64>),
}

impl Candidate {
    const fn point(self) -> Point3<f64> {
        match self {
            Self::ByArea(point) | Self::OnFacet(point) | Self::AboutPath(point) => point,
        }
    }
}

/// What became of a point.
enum Outcome {
    Contact(MeshContact),
    Buried,
    Outside,
    Useless,
}

/// So many points are drawn for each contact that is wanted, at most: bounds may hold a small part of large facets.
const TRIES: usize = 40;

/// The share of contacts drawn one by one that are drawn by area: that of Campana and Laumond's program.
pub const BY_AREA: f64 = 0.7;

impl<'g> ContactSampler<'g> {
    /// A sampler for the facets within bounds.
    ///
    /// # Errors
    /// [`NothingWithin`].
    pub fn new(ground: &'g MeshGround, bounds: Option<SpaceBounds>, stand_off_m: f64, seed: u64) -> Result<Self, NothingWithin> {
        let tree = ground.tree();
        let mut source = ChaCha8Rng::seed_from_u64(seed);
        let (mut facets, mut areas_m2, mut sum_m2) = (Vec::new(), Vec::new(), 0.0);
        for facet in (0..tree.mesh().triangle_count()).map(FacetId) {
            let [a, b, c] = tree.corners(facet);
            let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            let meets = |bounds: SpaceBounds| (0..3).all(|i| low[i] <= bounds.max[i] && bounds.min[i] <= high[i]);
            if bounds.is_none_or(meets) {
                sum_m2 += 0.5 * (b - a).cross(&(c - a)).norm();
                facets.push(facet);
                areas_m2.push(sum_m2);
            }
        }
        if let (true, Some(bounds)) = (facets.is_empty(), bounds) {
            let of = tree.mesh().bounds();
            let corner = |at: nalgebra::Point2<f64>, z_m| Point3::new(at.x, at.y, z_m);
            let mesh = SpaceBounds { min: corner(of.map.min, of.low_m), max: corner(of.map.max, of.high_m) };
            return Err(NothingWithin { bounds, mesh });
        }
        let mut turns = facets.clone();
        for last in (1..turns.len()).rev() {
            turns.swap(last, below(&mut source, last + 1));
        }
        Ok(Self { ground, bounds, stand_off_m, source, facets, areas_m2, turns, turned: 0, drawn: DrawnContacts::default() })
    }

    /// The facets that meet the bounds.
    pub const fn facet_count(&self) -> usize {
        self.facets.len()
    }

    /// Their area, m^2.
    pub fn area_m2(&self) -> f64 {
        self.areas_m2.last().copied().unwrap_or(0.0)
    }

    /// How many of them have had their turn.
    pub const fn turned(&self) -> usize {
        self.turned
    }

    /// How many were drawn, and left out, so far.
    pub const fn drawn(&self) -> DrawnContacts {
        self.drawn
    }

    /// So many contacts all over the mesh, of those that are useful; fewer where few are found.
    pub fn all_over(&mut self, count: usize, is_useful: &(dyn Fn(&Point3<f64>) -> bool + Sync)) -> Vec<MeshContact> {
        self.contacts(count, is_useful, |sampler, number| {
            let facet = sampler.turns.get(sampler.turned).copied().filter(|_| number % 2 == 1);
            match facet {
                Some(facet) => {
                    sampler.turned += 1;
                    let [a, b, c] = sampler.ground.tree().corners(facet);
                    Candidate::OnFacet(Point3::from((a.coords + b.coords + c.coords) / 3.0))
                }
                None => Candidate::ByArea(sampler.by_area()),
            }
        })
    }

    /// One contact as Campana and Laumond draw them: with the share of [`BY_AREA`] by area, else anywhere on a facet of which each has the
    /// same probability. `None` where none is found in some thousand tries.
    pub fn one(&mut self) -> Option<MeshContact> {
        for _ in 0..TRIES * TRIES {
            let candidate = if self.source.random::<f64>() < BY_AREA {
                Candidate::ByArea(self.by_area())
            } else {
                let facet = self.facets[below(&mut self.source, self.facets.len())];
                Candidate::OnFacet(self.within(facet))
            };
            let outcome = self.tested(&candidate.point(), &|_| true);
            if let Some(contact) = self.record(candidate, outcome) {
                return Some(contact);
            }
        }
        None
    }

    /// So many contacts nearest to points drawn in balls about some points, of those that are useful; fewer where few are found.
    pub fn about(
        &mut self,
        points: &[Point3<f64>],
        radius_m: f64,
        count: usize,
        is_useful: &(dyn Fn(&Point3<f64>) -> bool + Sync),
    ) -> Vec<MeshContact> {
        if points.is_empty() {
            return Vec::new();
        }
        self.contacts(count, is_useful, |sampler, _| {
            let about = points[below(&mut sampler.source, points.len())];
            let away = loop {
                let away = Vector3::from_fn(|_, _| 2.0 * sampler.source.random::<f64>() - 1.0);
                if away.norm_squared() <= 1.0 {
                    break away;
                }
            };
            Candidate::AboutPath(sampler.ground.tree().nearest(about + away * radius_m).point)
        })
    }

    /// Draws points until so many are contacts. Points are drawn one after another and tested by all threads.
    fn contacts(
        &mut self,
        count: usize,
        is_useful: &(dyn Fn(&Point3<f64>) -> bool + Sync),
        mut draw: impl FnMut(&mut Self, usize) -> Candidate,
    ) -> Vec<MeshContact> {
        let mut found = Vec::with_capacity(count);
        let mut tried = 0;
        while found.len() < count && tried < TRIES * count {
            let wanted = count - found.len();
            let candidates: Vec<Candidate> = (0..wanted).map(|i| draw(self, tried + i)).collect();
            tried += wanted;
            let tested = |candidate: &Candidate| self.tested(&candidate.point(), is_useful);
            let outcomes: Vec<Outcome> = candidates.par_iter().map(tested).collect();
            for (candidate, outcome) in candidates.iter().zip(outcomes) {
                found.extend(self.record(*candidate, outcome));
            }
        }
        found
    }

    /// Counts what became of a point, and gives the contact.
    fn record(&mut self, candidate: Candidate, outcome: Outcome) -> Option<MeshContact> {
        match outcome {
            Outcome::Buried => self.drawn.buried += 1,
            Outcome::Outside => self.drawn.outside += 1,
            Outcome::Useless => self.drawn.useless += 1,
            Outcome::Contact(contact) => {
                match candidate {
                    Candidate::ByArea(_) => self.drawn.by_area += 1,
                    Candidate::OnFacet(_) => self.drawn.on_facets += 1,
                    Candidate::AboutPath(_) => self.drawn.about_path += 1,
                }
                return Some(contact);
            }
        }
        None
    }

    fn tested(&self, point: &Point3<f64>, is_useful: &(dyn Fn(&Point3<f64>) -> bool + Sync)) -> Outcome {
        if self.bounds.is_some_and(|bounds| !bounds.contain(point)) {
            return Outcome::Outside;
        }
        if !is_useful(point) {
            return Outcome::Useless;
        }
        match self.ground.contact(*point) {
            Ok(contact) => self.ground.stood_off(&contact, self.stand_off_m).map_or(Outcome::Buried, Outcome::Contact),
            Err(
                NoMeshContact::InsideRock { .. }
                | NoMeshContact::Covered { .. }
                | NoMeshContact::NoRoom { .. }
                | NoMeshContact::NoPoint { .. },
            ) => Outcome::Buried,
        }
    }

    /// A point of the facets, each part of the same area with the same probability.
    fn by_area(&mut self) -> Point3<f64> {
        let whole_m2 = self.area_m2();
        let at_m2 = whole_m2 * self.source.random::<f64>();
        let facet = self.areas_m2.partition_point(|sum_m2| *sum_m2 <= at_m2).min(self.facets.len() - 1);
        self.within(self.facets[facet])
    }

    /// A point of a facet, each part of the same area with the same probability.
    fn within(&mut self, facet: FacetId) -> Point3<f64> {
        let [a, b, c] = self.ground.tree().corners(facet);
        let (mut u, mut v) = (self.source.random::<f64>(), self.source.random::<f64>());
        // The half of the parallelogram beyond the triangle, turned back into it.
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        a + (b - a) * u + (c - a) * v
    }
}

/// A number below a count, from 64 random bits: the same on every platform.
#[expect(clippy::cast_possible_truncation, reason = "the product of a 64-bit number and a count, shifted, is below the count")]
fn below(source: &mut ChaCha8Rng, count: usize) -> usize {
    ((u128::from(source.random::<u64>()) * count as u128) >> 64) as usize
}

impl RoadmapSampler<MeshContact> for ContactSampler<'_> {
    fn all_over(&mut self, count: usize, is_useful: &(dyn Fn(&Point3<f64>) -> bool + Sync)) -> Vec<MeshContact> {
        self.all_over(count, is_useful)
    }

    fn about(
        &mut self,
        points: &[Point3<f64>],
        radius_m: f64,
        count: usize,
        is_useful: &(dyn Fn(&Point3<f64>) -> bool + Sync),
    ) -> Vec<MeshContact> {
        self.about(points, radius_m, count, is_useful)
    }

    fn drawn(&self) -> DrawnContacts {
        self.drawn()
    }
}
