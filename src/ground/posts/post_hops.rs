//! One hop between two posts: fast arithmetic where its result is certain, the exact hop test where it is close.
//!
//! The result is that of [`slice`](crate::terrain::slice()) and [`HopTest`](crate::hop::HopTest) on the same two posts. Fast
//! arithmetic differs from theirs only by rounding; it decides where the margin to the limits is far above rounding. Closer pairs,
//! and all pairs near a border of a zone or of friction, where the slice has more vertices, are left to the slice and the hop test.

use rayon::prelude::*;

use super::{
    MapError, Post, exact,
    facet_table::{FacetTable, Footing},
    facets::Facets,
    footings::{FootingTable, Standing},
    lattice::NodeLattice,
    offsets::{Offset, OffsetTable},
    overlays::OverlayTable,
    refusal::rest_tangent,
    samples::{HeightScale, Heights, Walk},
};
use crate::{
    ballistics::{ContactLimits, FlightEnvelope, LineOfSight},
    chain::{QuickCone, QuickGrip},
    ground::{DemGround, MapPosition, Surface},
    quantity::SlopeInterval,
    terrain::OverlaidDem,
    world::Grip,
};

/// Lofts closer than this, relative to one plus their size, are left to the exact code. Fast arithmetic has relative errors of some
/// 1e-8 next to the end of a cone (see [`QuickGrip`]) and 1e-13 elsewhere. A larger value only uses the exact code more often.
const NEAR: f64 = 1.0e-5;

/// Greatest rounding error of map coordinates and heights, as a fraction of the post spacing, for fast arithmetic to be within
/// [`NEAR`]: 1 m posts up to 4 000 km from the origin. On coarser maps every pair is left to the exact code.
const FINE: f64 = 1.0e-9;

/// All single hops between the nodes of a DEM.
pub struct PostHops {
    pub(super) ground: DemGround,
    /// The same surface with a post at every node: the terrain itself, unless nodes are finer than posts.
    surface: OverlaidDem,
    scale: HeightScale,
    pub(super) lattice: NodeLattice,
    pub(super) table: OffsetTable,
    pub(super) facets: FacetTable,
    pub(super) overlays: Option<OverlayTable>,
    /// The ground under the footprint of every node, if the hopper has one.
    pub(super) footings: Option<FootingTable>,
    /// Whether a layer refuses every contact at each node; empty where none does.
    refused: Vec<bool>,
    grip: Option<QuickGrip>,
    /// For each block, how many of the nearest offsets are within reach of its nodes.
    pub(super) within_reach: Vec<usize>,
    /// Whether map coordinates are too coarse for fast arithmetic.
    coarse: bool,
    /// Whether the clearance is kept at vertices of the slice alone, of which the finer surface has others: then fast arithmetic looks at the
    /// bare ground, and the slice decides what that leaves.
    pub(super) by_vertices: bool,
}

impl std::fmt::Debug for PostHops {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter
            .debug_struct("PostHops")
            .field("lattice", &self.lattice)
            .field("offsets", &self.table.offsets.len())
            .finish_non_exhaustive()
    }
}

/// The surface of a ground with a post at every node.
fn surface(ground: &DemGround, lattice: NodeLattice) -> Result<OverlaidDem, MapError> {
    let terrain = ground.terrain();
    if lattice.per_post == 1 {
        return Ok(terrain.clone());
    }
    Ok(OverlaidDem::new(terrain.dem().finer(lattice.per_post)?, terrain.overlays().clone()))
}

/// For every node whether a layer refuses every contact there; empty if no layer is about contacts.
fn refused_by_layers(ground: &DemGround, lattice: NodeLattice) -> Vec<bool> {
    if !ground.layers().iter().any(|layer| layer.rule().on_contact) {
        return Vec::new();
    }
    let map = ground.terrain().dem().georeference();
    let refuses = |node: usize| ground.layers().refusing_contact(lattice.at(map, lattice.node(node))).is_some();
    (0..lattice.count()).into_par_iter().map(refuses).collect()
}

/// The result of fast arithmetic on a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    No,
    Hop(LineOfSight, SlopeInterval),
    Close,
}

/// The lofts of a hop over a line of sight.
pub type Lofts = (LineOfSight, SlopeInterval);

impl PostHops {
    /// Prepares the tables that all pairs share. Every `stride`-th post is a node (0 counts as 1); the terrain is always the full
    /// DEM.
    ///
    /// # Errors
    /// [`MapError`]: the reach spans too many posts, constraints are missing, or overlays do not cover the terrain.
    pub fn new(ground: DemGround, stride: usize) -> Result<Self, MapError> {
        let lattice = NodeLattice::new(ground.terrain().dem(), stride);
        Self::over(ground, lattice)
    }

    /// The same over a lattice of nodes on the DEM of this ground.
    ///
    /// Nodes finer than posts change where one may stand, not the ground: fast arithmetic uses the heights of the same surface at every
    /// node, and where it is close to a limit the slice of the DEM itself decides.
    ///
    /// # Errors
    /// As [`PostHops::new`].
    pub fn over(ground: DemGround, lattice: NodeLattice) -> Result<Self, MapError> {
        if let Some(found) = ground.footprint_without_room() {
            let expected = "one that has room on the DEM: check its unit, or take a larger DEM";
            return Err(MapError::Request { what: "hopper.footprint_m", found, expected });
        }
        exact::probe(&ground)?;
        let surface = surface(&ground, lattice)?;
        let dem = surface.dem();
        let scale = HeightScale::of(dem);
        let heights = Heights::of(dem, &scale);
        let overlays = OverlayTable::new(&surface, ground.constant_friction())?;
        let footings = FootingTable::new(&ground, lattice, overlays.as_ref());
        // With a footprint, the plane fitted over it is held against the rest slope, not the facets.
        let rest = |post| rest_tangent(&ground, overlays.as_ref(), post).filter(|_| footings.is_none());
        let facets = FacetTable::new(heights, &rest);
        let refused = refused_by_layers(&ground, lattice);
        let grip = match ground.surface().grip {
            Some(Grip::Friction(cone)) => Some(QuickGrip::friction(cone)),
            Some(Grip::FromSlope { takeoff, landing }) => Some(QuickGrip::from_slope(takeoff, landing)),
            None => None,
        };
        let bounds = dem.bounds();
        let step_m = dem.georeference().step_m();
        let (low_m, high_m) = dem.elevation_range_m();
        let largest_m =
            [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y, low_m, high_m].map(f64::abs).into_iter().fold(0.0, f64::max);
        let coarse = f64::EPSILON * largest_m > FINE * step_m;
        let table = OffsetTable::default();
        let within_reach = Vec::new();
        let clearance = ground.envelope().clearance();
        let by_vertices = lattice.per_post > 1 && clearance.height_m() > 0.0 && !clearance.has_kinks();
        let mut hops = Self {
            ground,
            surface,
            scale,
            lattice,
            table,
            facets,
            overlays,
            footings,
            refused,
            grip,
            within_reach,
            coarse,
            by_vertices,
        };
        hops.set_reach()?;
        Ok(hops)
    }

    /// The nodes.
    pub const fn lattice(&self) -> NodeLattice {
        self.lattice
    }

    /// The ground that the nodes lie on.
    pub const fn ground(&self) -> &DemGround {
        &self.ground
    }

    /// The flight envelope of the hopper under its gravity.
    pub(crate) const fn envelope(&self) -> &FlightEnvelope {
        self.ground.envelope()
    }

    /// The heights of the surface, with a post at every node.
    #[inline]
    pub(super) fn heights(&self) -> Heights<'_> {
        Heights::of(self.surface.dem(), &self.scale)
    }

    /// All offsets, nearest first.
    pub(crate) fn offsets(&self) -> &[Offset] {
        &self.table.offsets
    }

    /// The steps of all offsets in the array of nodes.
    pub(crate) fn node_steps(&self) -> &[isize] {
        &self.table.node_steps
    }

    /// How many of the nearest offsets are within reach of the nodes of a block.
    pub(crate) fn within_reach(&self, block: usize) -> usize {
        self.within_reach[block]
    }

    /// The position of a node; `None` where it has no elevation.
    pub fn position(&self, node: Post) -> Option<MapPosition> {
        self.lattice.position(self.ground.terrain().dem(), node)
    }

    /// The height of a node, m; NaN without elevation.
    #[inline]
    pub(crate) fn height_m(&self, node: Post) -> f64 {
        self.heights().at(self.lattice.raster_index(node))
    }

    /// The same by the number of the node.
    #[inline]
    pub(crate) fn height_of_index_m(&self, index: usize) -> f64 {
        if self.lattice.stride == 1 { self.heights().at(index) } else { self.height_m(self.lattice.node(index)) }
    }

    /// Whether a node has an elevation.
    pub(crate) fn has_ground(&self, node: Post) -> bool {
        !self.height_m(node).is_nan()
    }

    /// Whether a hop in some direction may begin or end at a node.
    pub(crate) fn usable(&self, node: Post) -> bool {
        self.facets.usable(self.lattice.raster_index(node)) && !self.never_stands(node) && !self.refused_by_layer(node)
    }

    /// Whether a layer refuses every contact at a node.
    #[inline]
    fn refused_by_layer(&self, node: Post) -> bool {
        self.refused.get(self.lattice.index(node)).copied().unwrap_or(false)
    }

    /// Whether a layer refuses a hop from a node by an offset: a contact, or the flight.
    #[inline]
    fn layers_refuse(&self, from: Post, offset: &Offset) -> bool {
        if self.ground.layers().is_empty() {
            return false;
        }
        let Some(to) = self.moved(from, offset.rows, offset.cols) else { return true };
        if self.refused_by_layer(from) || self.refused_by_layer(to) {
            return true;
        }
        let map = self.ground.terrain().dem().georeference();
        self.ground.layers().refusing_flight(self.lattice.at(map, from), self.lattice.at(map, to)).is_some()
    }

    /// Whether the ground under the footprint at a node allows no contact in any direction. Beside the borders of a friction raster, the
    /// rest slope may differ from one side to the other, so that a slope is then left to every pair.
    pub(super) fn never_stands(&self, node: Post) -> bool {
        let standing = self.footings.as_ref().map(|footings| footings.of(self.lattice.index(node)));
        let one_friction = self.overlays.as_ref().is_none_or(|overlays| !overlays.has_friction());
        standing == Some(Standing::Refused) || (one_friction && standing == Some(Standing::TooSteep))
    }

    /// Whether the ground under the footprint at both ends of an offset allows contacts, and whether that is certain; `None` if it does
    /// not. Where overlays change on the way, the slope is left to the exact code, which knows the friction on either side.
    #[inline]
    fn stands(&self, from: Post, offset: &Offset, overlay: Overlay) -> Option<bool> {
        let Some(footings) = &self.footings else { return Some(true) };
        let to = self.moved(from, offset.rows, offset.cols)?;
        let mut sure = true;
        for node in [from, to] {
            match footings.of(self.lattice.index(node)) {
                Standing::Sound => {}
                Standing::Refused => return None,
                Standing::TooSteep if overlay != Overlay::Mixed => return None,
                Standing::TooSteep | Standing::Close => sure = false,
            }
        }
        Some(sure)
    }

    /// The number of offsets from one node to another: `0..offset_count()` are their numbers, nearest first.
    pub fn offset_count(&self) -> usize {
        self.table.offsets.len()
    }

    /// The node at the end of an offset; `None` outside the map.
    #[inline]
    pub fn landing(&self, from: Post, offset: usize) -> Option<Post> {
        self.moved(from, self.table.offsets[offset].rows, self.table.offsets[offset].cols)
    }

    /// The node from which an offset leads to this one; `None` outside the map.
    #[inline]
    pub(crate) fn takeoff(&self, to: Post, offset: usize) -> Option<Post> {
        self.moved(to, -self.table.offsets[offset].rows, -self.table.offsets[offset].cols)
    }

    #[inline]
    pub(crate) fn moved(&self, from: Post, rows: i32, cols: i32) -> Option<Post> {
        let row = from.row.wrapping_add_signed(rows as isize);
        let col = from.col.wrapping_add_signed(cols as isize);
        (row < self.lattice.rows && col < self.lattice.cols).then_some(Post { row, col })
    }

    /// The feasible lofts of a hop from a node by an offset that ends on the map; `None` if the hop is infeasible.
    ///
    /// # Errors
    /// [`MapError::Ground`] if the exact code cannot build the slice.
    pub fn lofts(&self, from: Post, offset: usize) -> Result<Option<Lofts>, MapError> {
        self.lofts_where(from, &self.table.offsets[offset], |_, _| true)
    }

    /// The same, but `None` without a test of the terrain if `worth` rejects the lofts that all other limits leave.
    ///
    /// The lofts passed to `worth` contain the feasible ones.
    #[inline]
    pub(crate) fn lofts_where(
        &self,
        from: Post,
        offset: &Offset,
        worth: impl FnOnce(LineOfSight, SlopeInterval) -> bool,
    ) -> Result<Option<Lofts>, MapError> {
        match self.evaluate(from, offset, worth) {
            Verdict::No => Ok(None),
            Verdict::Hop(sight, lofts) => Ok(Some((sight, lofts))),
            Verdict::Close => self.exact(from, offset),
        }
    }

    /// Fast arithmetic on a pair.
    #[inline]
    fn evaluate(&self, from: Post, offset: &Offset, worth: impl FnOnce(LineOfSight, SlopeInterval) -> bool) -> Verdict {
        let takeoff = self.lattice.raster_index(from);
        let landing = takeoff.wrapping_add_signed(offset.post_step);
        let heights = self.heights();
        let takeoff_m = heights.at(takeoff);
        let rise_m = heights.at(landing) - takeoff_m;
        // NaN if either end has no elevation, which fails the comparison.
        let in_reach = offset.rises_m.0 <= rise_m && rise_m <= offset.rises_m.1;
        if !in_reach {
            return Verdict::No;
        }
        let overlay = self.overlay(from, takeoff, offset);
        if overlay == Overlay::Kept {
            return Verdict::No;
        }
        let Some(stands) = self.stands(from, offset, overlay) else { return Verdict::No };
        let Some((slopes, mut sure)) = self.cones(takeoff, landing, offset, overlay) else { return Verdict::No };
        sure &= stands;
        sure &= overlay != Overlay::Mixed && !self.coarse && !self.by_vertices;
        let limits = self.ground.hopper().limits();
        let sight = LineOfSight::new(offset.run_m, rise_m);
        let lofts = self.envelope().lofts(
            sight,
            ContactLimits { slopes: slopes[0], speed_max_m_s: limits.takeoff_speed_max_m_s },
            ContactLimits { slopes: slopes[1], speed_max_m_s: limits.arc_landing_speed_max_m_s() },
        );
        let most = lofts.upper + near(lofts.upper);
        if lofts.lower - near(lofts.lower) > most || most <= 0.0 || !worth(sight, lofts) {
            return Verdict::No;
        }
        let walk = Walk { from: takeoff, turn: offset.turn, base_m: takeoff_m, rise_m, most };
        let (crossings, kinks) = (self.table.crossings_of(offset), self.table.kinks_of(offset));
        let Some(terrain) = heights.clearing_loft(walk, crossings, kinks) else { return Verdict::No };
        if self.layers_refuse(from, offset) {
            return Verdict::No;
        }
        if self.facets.gaps && offset.departure.along_edge() && !self.has_facets_along(takeoff, offset) {
            return Verdict::No;
        }
        let lower = lofts.lower.max(terrain);
        let room = lofts.upper - near(lofts.upper);
        let sure_of = SlopeInterval { lower: lower + near(lower), upper: room };
        if !self.envelope().takeoff_speeds().are_any() {
            // The machine has an arc well inside, or none anywhere near.
            let possible = SlopeInterval { lower: lower - near(lower), upper: most };
            if !self.envelope().commands(sight, possible) {
                return Verdict::No;
            }
            sure &= self.envelope().commands(sight, sure_of);
        }
        if sure && sure_of.lower <= room && room > 0.0 {
            Verdict::Hop(sight, SlopeInterval { lower, upper: lofts.upper })
        } else {
            Verdict::Close
        }
    }

    /// The overlays on the line between a pair of posts.
    #[inline]
    fn overlay(&self, from: Post, takeoff: usize, offset: &Offset) -> Overlay {
        match &self.overlays {
            None => Overlay::Bare,
            Some(overlays) => {
                let post = self.lattice.in_raster(from);
                let stride = self.lattice.stride.cast_signed();
                let end = Post {
                    row: post.row.wrapping_add_signed(offset.rows as isize * stride),
                    col: post.col.wrapping_add_signed(offset.cols as isize * stride),
                };
                if overlays.has_border(post, end) {
                    Overlay::Mixed
                } else if overlays.kept(takeoff) {
                    Overlay::Kept
                } else {
                    Overlay::Bare
                }
            }
        }
    }

    /// The directions that both ends allow, and whether they are certain; `None` if an end allows none.
    #[inline]
    fn cones(&self, takeoff: usize, landing: usize, offset: &Offset, overlay: Overlay) -> Option<([SlopeInterval; 2], bool)> {
        let everything = ([SlopeInterval::ALL; 2], false);
        let friction = match (&self.overlays, overlay) {
            (Some(overlays), Overlay::Mixed) if overlays.has_friction() => return Some(everything),
            (Some(overlays), _) => overlays.friction(takeoff),
            (None, _) => None,
        };
        let Some(grip) = friction.map(|mu| QuickGrip::Friction { squared: mu * mu }).or(self.grip) else {
            return Some(everything);
        };
        let footings = [self.facets.footing(takeoff, offset.departure), self.facets.footing(landing, offset.arrival)];
        if footings.contains(&Footing::Refused) {
            return None;
        }
        let mut sure = !footings.contains(&Footing::Doubtful);
        let mut open = |cone: QuickCone| match cone {
            QuickCone::Closed => None,
            QuickCone::Open(slopes) => Some(slopes),
            QuickCone::Doubtful => {
                sure = false;
                Some(SlopeInterval::ALL)
            }
        };
        let (slope, steepness) = self.facet(takeoff, offset.departure, offset);
        let ahead = open(grip.takeoff(slope, steepness))?;
        let (slope, steepness) = self.facet(landing, offset.arrival, offset);
        let brakes = self.ground.hopper().limits().landing.brakes();
        let behind = open(if brakes { grip.touchdown(slope, steepness) } else { grip.landing(slope, steepness) })?;
        Some(([ahead, behind], sure))
    }

    /// Slope along the heading and squared gradient of the facet under an end; along an edge, those of the steeper facet.
    #[inline]
    fn facet(&self, post: usize, facets: Facets, offset: &Offset) -> (f64, f64) {
        let heights = self.heights();
        let of = |number| {
            let (east, north) = heights.gradient(post, number);
            (east * offset.heading.x + north * offset.heading.y, east * east + north * north)
        };
        if !facets.along_edge() {
            return of(facets.first());
        }
        let there = facets.numbers().filter(|&number| self.facets.has(post, number)).map(of);
        there.fold((0.0, f64::NEG_INFINITY), |steepest, facet| if facet.1 > steepest.1 { facet } else { steepest })
    }

    /// Whether a line along edges of facets has a facet on at least one side everywhere.
    fn has_facets_along(&self, takeoff: usize, offset: &Offset) -> bool {
        let posts = self.table.crossings_of(offset).iter();
        posts
            .map(|crossing| takeoff.wrapping_add_signed(offset.turn * crossing.first as isize))
            .all(|post| self.facets.has_any(post, offset.departure))
    }
}

/// The overlays between a pair of posts: constant, a keep-out zone everywhere, or borders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Overlay {
    Bare,
    Kept,
    Mixed,
}

/// The distance below which another loft counts as close to this one.
#[inline]
fn near(loft: f64) -> f64 {
    NEAR * (1.0 + loft.abs())
}
