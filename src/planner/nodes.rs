//! The nodes of a search over a DEM: a lattice, and single places beside it.

use std::collections::HashSet;

use nalgebra::Vector2;

use super::SurfaceLattice;
use crate::{
    ground::{DemGround, HopReach, MapPosition},
    quantity::MapPoint,
};

/// A line whose ends are off a line of the posts by less than this, in post spacings, may run along it; the slice then decides. Far more than
/// rounding errors, and so little that few other lines are meant.
const NEARLY_ALONG: f64 = 1e-6;

/// A node, as its number in the lattice, or behind all of these among the single places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SurfaceNode(pub(super) u32);

impl SurfaceNode {
    /// That of a number.
    #[expect(clippy::cast_possible_truncation, reason = "at most MOST")]
    pub(super) const fn of_index(index: usize) -> Self {
        Self(index as u32)
    }

    /// That of a column and a row of the lattice.
    pub(super) const fn of_lattice(lattice: &SurfaceLattice, (i, j): (usize, usize)) -> Self {
        Self::of_index(lattice.index(i, j))
    }

    pub(super) const fn index(self) -> usize {
        self.0 as usize
    }
}

/// More nodes than can be numbered.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "found {nodes} nodes, {nodes_per_post} for each post spacing, expected at most {most}: make the spacing of nodes larger, or cut the raster"
)]
pub struct TooManyNodes {
    /// How many.
    pub nodes: usize,
    /// For each post spacing.
    pub nodes_per_post: usize,
    /// The most.
    pub most: usize,
}

/// The lattice and the single places.
#[derive(Clone, Debug)]
pub struct SurfaceNodes {
    lattice: SurfaceLattice,
    places: Vec<MapPosition>,
    /// The numbers of the places, in the order of their eastings or of their northings.
    sorted: Vec<u32>,
    /// Whether they are in the order of their eastings: of a slice the longer of both extents.
    by_easting: bool,
}

impl SurfaceNodes {
    /// The most nodes: a search takes up to 12 bytes for each, 3 GiB in all.
    pub const MOST: usize = 1 << 28;

    /// The lattice, and places beside it: start, goal, the nodes of a slice. Those without ground are left out.
    ///
    /// # Errors
    /// [`TooManyNodes`].
    pub fn new(
        ground: &DemGround,
        lattice: SurfaceLattice,
        places: impl IntoIterator<Item = MapPoint>,
    ) -> Result<Self, TooManyNodes> {
        Self::check(&lattice, 0)?;
        let mut known = HashSet::new();
        let different = places.into_iter().filter(|at| known.insert((at.x.to_bits(), at.y.to_bits())));
        let found: Vec<MapPosition> = different.filter_map(|at| ground.position(at)).collect();
        Self::check(&lattice, found.len())?;
        let (by_easting, sorted) = in_order(&found);
        Ok(Self { lattice, places: found, sorted, by_easting })
    }

    /// Checks the number of nodes of a lattice with so many places beside it.
    ///
    /// # Errors
    /// [`TooManyNodes`].
    pub const fn check(lattice: &SurfaceLattice, places: usize) -> Result<(), TooManyNodes> {
        let nodes = lattice.count().saturating_add(places);
        if nodes > Self::MOST {
            return Err(TooManyNodes { nodes, nodes_per_post: lattice.nodes_per_post(), most: Self::MOST });
        }
        Ok(())
    }

    /// How many there are.
    pub const fn count(&self) -> usize {
        self.lattice.count() + self.places.len()
    }

    /// No more pairs of nodes than these are no farther apart than a hop over a ground may be by its speeds.
    pub fn pairs_max(&self, ground: &DemGround) -> u64 {
        let (down, aside) = self.lattice.cells_within(HopReach::of(ground).longest_m());
        let about = (2 * down + 1).saturating_mul(2 * aside + 1).saturating_add(self.places.len()).min(self.count());
        (self.count() as u64).saturating_mul(about as u64)
    }

    /// The lattice.
    pub const fn lattice(&self) -> &SurfaceLattice {
        &self.lattice
    }

    /// The node at exactly this place among the single places.
    pub fn place(&self, at: MapPoint) -> Option<SurfaceNode> {
        let index = self.places.iter().position(|place| place.at == at)?;
        u32::try_from(self.lattice.count() + index).ok().map(SurfaceNode)
    }

    /// The node of a column and a row of the lattice.
    pub const fn lattice_node(&self, (i, j): (usize, usize)) -> SurfaceNode {
        SurfaceNode::of_lattice(&self.lattice, (i, j))
    }

    /// The single places.
    pub(super) fn single_places(&self) -> impl Iterator<Item = (SurfaceNode, MapPoint)> + '_ {
        let numbered = |(number, place): (usize, &MapPosition)| (SurfaceNode::of_index(number), place.at);
        (self.lattice.count()..).zip(&self.places).map(numbered)
    }

    /// The row and column of a node in the lattice, of a single place those of a node near to it.
    pub(super) fn cell(&self, node: SurfaceNode) -> (usize, usize) {
        let place = node.index().checked_sub(self.lattice.count()).and_then(|place| self.places.get(place));
        place.map_or_else(
            || {
                let (i, j) = self.lattice.node(node.index());
                (j, i)
            },
            |place| self.lattice.cell_near(place.at),
        )
    }

    /// A node on the ground; `None` without elevation.
    pub fn position(&self, ground: &DemGround, node: SurfaceNode) -> Option<MapPosition> {
        match node.index().checked_sub(self.lattice.count()) {
            Some(place) => self.places.get(place).copied(),
            None => self.lattice.position(ground.terrain().dem(), self.lattice.node(node.index())),
        }
    }

    /// All nodes in a square about a position, those of the lattice first.
    pub(crate) fn about(&self, at: MapPoint, distance_m: f64) -> impl Iterator<Item = SurfaceNode> + '_ {
        let of_lattice = self.lattice.about(at, distance_m).map(|node| SurfaceNode::of_lattice(&self.lattice, node));
        of_lattice.chain(self.places_about(at, distance_m))
    }

    /// A distance that no hop over a ground exceeds, m.
    pub(crate) fn reach_m(ground: &DemGround) -> f64 {
        HopReach::of(ground).longest_m()
    }

    /// The single places in a square about a position.
    pub(super) fn places_about(&self, at: MapPoint, distance_m: f64) -> impl Iterator<Item = SurfaceNode> + '_ {
        let key = move |at: MapPoint| if self.by_easting { at.x } else { at.y };
        let place = |number: &u32| self.places[*number as usize];
        let first = self.sorted.partition_point(|number| key(place(number).at) < key(at) - distance_m);
        let in_strip = self.sorted[first..].iter().map(|number| *number as usize).map_while(move |number| {
            let away = self.places.get(number)?.at - at;
            (key(MapPoint::origin() + away) <= distance_m).then_some((number, away))
        });
        let beside = in_strip.filter(move |(_, away)| away.amax() <= distance_m).map(|(number, _)| self.lattice.count() + number);
        beside.map(SurfaceNode::of_index)
    }

    /// The column and row of a node of the lattice; `None` for a single place.
    pub(super) const fn of_lattice(&self, node: SurfaceNode) -> Option<(usize, usize)> {
        if node.index() < self.lattice.count() { Some(self.lattice.node(node.index())) } else { None }
    }

    /// Whether the line between two nodes may run along edges of the triangulated DEM, where two facets bound it: decided in integers where
    /// both are nodes of the lattice.
    pub(super) fn may_run_along_edges(&self, ground: &DemGround, nodes: [SurfaceNode; 2], at: [MapPoint; 2]) -> bool {
        if let [Some(from), Some(to)] = nodes.map(|node| self.of_lattice(node)) {
            return self.lattice.runs_along_edges(from, to);
        }
        let map = ground.terrain().dem().georeference();
        let [from, to] = at.map(|at| {
            let away = at - map.north_west();
            Vector2::new(away.x / map.dx_m(), -away.y / map.dy_m())
        });
        let on_a_line = |a: f64, b: f64| (a - b).abs() < NEARLY_ALONG && (a - a.round()).abs() < NEARLY_ALONG;
        on_a_line(from.x, to.x) || on_a_line(from.y, to.y) || on_a_line(from.x - from.y, to.x - to.y)
    }
}

/// The numbers of places in the order of the coordinate over which they extend farther, and whether that is the easting.
#[expect(clippy::cast_possible_truncation, reason = "at most MOST")]
fn in_order(places: &[MapPosition]) -> (bool, Vec<u32>) {
    let extent = |of: fn(&MapPosition) -> f64| {
        let all = || places.iter().map(of);
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    let by_easting = extent(|place| place.at.x) >= extent(|place| place.at.y);
    let key = |number: &u32| places[*number as usize].at;
    let mut sorted: Vec<u32> = (0..places.len() as u32).collect();
    sorted.sort_by(|a, b| {
        let (a, b) = (key(a), key(b));
        if by_easting { a.x.total_cmp(&b.x) } else { a.y.total_cmp(&b.y) }
    });
    (by_easting, sorted)
}
