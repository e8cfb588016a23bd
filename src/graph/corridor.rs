//! The nodes of a transect over a DEM and the posts on both sides of it, over which a robot replans once it has left the line.

use std::sync::Arc;

use nalgebra::{Vector2, Vector3};
use rayon::prelude::*;

use super::{
    MapJudge, NodeSet, ReliabilityOptions, RiskModel, SearchOptions,
    reliability::ten_nodes_a_hop_m,
    successors::{Successor, Successors},
    thinned::kept_nodes,
};
use crate::{
    ballistics::LineOfSight,
    ground::{DemGround, HopReach, MapPosition, NodeLattice, Post, Surface},
    hop::HopTest,
    progress::{Cancelled, Detail, Meter, PairCounter, Progress, Stage},
    quantity::{MapPoint, NodeId, SlopeInterval},
};

/// How far the corridor extends from the nodes of the transect, in longest hops over level ground.
///
/// Measured on three journeys over the rough DEM of the tests that are hard to fly: with half a hop their success is 0.19, 0.21 and 0.23,
/// with one 0.70, 0.89 and 0.36, with one and a half or two 0.9, 0.9 and 0.4 over posts.
const HALF_WIDTH_HOPS: f64 = 1.5;

/// The longest hop over level ground spans at least this many posts; over coarser DEMs there is no corridor.
const POSTS_A_HOP_MIN: f64 = 3.0;

/// The most nodes of a corridor, with some 10^7 hops between them.
const NODES_MAX: usize = 20_000;

/// How many feasible hops from where the robot believes to be are compared.
const COMPARED: usize = 8;

/// Which places beside the line a robot may hop to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// Posts of the DEM, around which six facets meet.
    Posts,
    /// The middles of facets: of every square of as many posts, the flattest. Landings scatter about a post over six facets, and about the
    /// middle of one mostly over that one, but slopes that are flatter than the ground around them may lead nowhere.
    FlatFacets,
}

impl Beside {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Posts, Self::FlatFacets];
}

/// The most reliable paths to the goal of a transect over a DEM, from the nodes of the transect and from places on both sides of it.
///
/// Hops lead in any direction. A hop weighs as over a map: by a closed form of its risk, since flown draws of every pair would take minutes.
/// The command of the hop that is flown is chosen by flown draws.
///
/// # Complexity
/// Every pair of nodes within reach is tested once; 24 bytes for each feasible hop.
#[derive(Clone, Debug)]
pub struct Corridor {
    nodes: Arc<Nodes>,
    successors: Successors,
}

#[derive(Debug)]
struct Nodes {
    positions: Vec<MapPosition>,
    /// Those of the transect come first.
    start: usize,
    goal: usize,
    /// The ground under the limits that planning may use.
    ground: DemGround,
    reach: HopReach,
    judge: MapJudge,
}

/// A hop that the robot may take next.
struct Onward {
    target: MapPosition,
    sight: LineOfSight,
    heading: Vector2<f64>,
    lofts: SlopeInterval,
    /// The weight of the journey over it.
    total: f64,
}

impl Corridor {
    /// The corridor of a transect. `planned_over`: the ground under the limits that planning may use; it differs from that of the model, over
    /// which hops are flown, where limits are derated.
    ///
    /// # Returns
    /// `None` if hops are not flown over a DEM with errors, if its posts are too far apart, or if no path leads over these nodes.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(
        test: &HopTest,
        nodes: &NodeSet,
        options: &SearchOptions,
        (reliability, planned_over, beside): (&ReliabilityOptions, &DemGround, Beside),
        progress: &dyn Progress,
    ) -> Result<Option<Self>, Cancelled> {
        let RiskModel::Flown { errors, over: Some(flown_over), .. } = &reliability.model else { return Ok(None) };
        let meter = Meter::new(progress, Stage::Reliability);
        meter.report(Detail::None)?;
        let judge = MapJudge::new(flown_over, errors, options.takeoff);
        let kept = kept_nodes(test, nodes, options, reliability);
        let Some(nodes) = Nodes::new((test, nodes, &kept), (planned_over, beside), judge) else { return Ok(None) };
        let edges = nodes.edges(&meter)?;
        let fewest = fewest_hops(&edges, nodes.goal);
        let Some(from_start) = fewest[nodes.start] else { return Ok(None) };
        let extra = reliability.extra_hops(from_start);
        Ok(Some(Self { nodes: Arc::new(nodes), successors: Successors::new(edges, fewest, extra) }))
    }

    /// The same for a journey of this many hops from the start: as many more than the fewest are allowed from everywhere, at most those that
    /// the corridor was made for.
    #[must_use]
    pub fn with_hops(&self, hops: u64) -> Self {
        let fewest = self.successors.fewest(self.nodes.start).unwrap_or(hops);
        let successors = self.successors.with_fewer_extra_hops(hops.saturating_sub(fewest));
        Self { nodes: Arc::clone(&self.nodes), successors }
    }

    /// The number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.positions.len()
    }

    /// The places of the most reliable path from the start to the goal within the hop budget, both included.
    pub fn path(&self) -> Vec<MapPosition> {
        self.successors.path(self.nodes.start).into_iter().map(|node| self.nodes.positions[node]).collect()
    }

    /// The ground under the limits that planning may use.
    pub(crate) fn ground(&self) -> &DemGround {
        &self.nodes.ground
    }

    /// The next command from where the robot believes to be: `command` makes one of a target and the hop to it, the hops of the most
    /// reliable journeys first, until it makes one.
    pub(crate) fn next_command<T>(
        &self,
        from: &MapPosition,
        mut command: impl FnMut(&MapJudge, &MapPosition, Vector2<f64>, (LineOfSight, SlopeInterval)) -> Option<T>,
    ) -> Option<T> {
        let nodes = self.nodes.as_ref();
        let nearest = nodes.nearest(from.at, |node| self.successors.fewest(node).is_some())?;
        let rest_hops = self.successors.fewest(nearest).map_or(0, |own| (own + self.successors.extra()).saturating_sub(1));
        let in_budget = |node: usize| self.successors.weight_with_hops(node, rest_hops);
        let near =
            self.successors.of(NodeId(nearest)).iter().filter_map(|node| nodes.onward(from, node.index(), in_budget(node.index())));
        let mut hops: Vec<Onward> = near.take(COMPARED).collect();
        let mut made = |hops: &mut Vec<Onward>| {
            hops.sort_by(|a, b| a.total.total_cmp(&b.total));
            hops.iter().find_map(|hop| command(&nodes.judge, &hop.target, hop.heading, (hop.sight, hop.lofts)))
        };
        if let Some(command) = made(&mut hops) {
            return Some(command);
        }
        // From beside the nodes none of the hops of the nearest one may be feasible.
        let anywhere = |node: usize| nodes.onward(from, node, self.successors.weight(NodeId(node)));
        hops = (0..nodes.positions.len()).filter_map(anywhere).collect();
        made(&mut hops)
    }
}

impl Nodes {
    /// `None` where posts are too far apart for the hops, too many, or a node of the transect lies off the ground.
    fn new(
        (test, nodes, kept): (&HopTest, &NodeSet, &[bool]),
        (ground, beside): (&DemGround, Beside),
        judge: MapJudge,
    ) -> Option<Self> {
        let position = |node: usize| {
            let point = test.chain().contact_point(nodes.station(NodeId(node)));
            let at = point.map().filter(|at| ground.covers(*at))?;
            Some(MapPosition { at, z_m: point.point_m.z })
        };
        let on_line: Vec<usize> = (0..kept.len()).filter(|&node| kept[node]).collect();
        let mut positions: Vec<MapPosition> = on_line.iter().map(|&node| position(node)).collect::<Option<_>>()?;
        let number = |node: NodeId| on_line.binary_search(&node.index()).ok();
        let (start, goal) = (number(nodes.start())?, number(nodes.goal())?);
        let reach = HopReach::of(ground);
        let dem = ground.terrain().dem();
        let hop_m = reach.level_m();
        let map = dem.georeference();
        if !hop_m.is_finite() || hop_m < POSTS_A_HOP_MIN * map.dx_m().max(map.dy_m()) {
            return None;
        }
        let stride = stride(ten_nodes_a_hop_m(test)? / map.dx_m().max(map.dy_m()));
        let beside = places_beside((ground, beside), &positions, (stride, HALF_WIDTH_HOPS * hop_m));
        positions.extend(beside);
        (positions.len() <= NODES_MAX).then(|| Self { positions, start, goal, ground: ground.clone(), reach, judge })
    }

    /// The hop from a position to a node from which the rest of the journey has this weight; `None` if it is infeasible.
    fn onward(&self, from: &MapPosition, node: usize, rest: f64) -> Option<Onward> {
        let target = self.positions[node];
        if rest == f64::INFINITY {
            return None;
        }
        let (sight, heading) = self.reach.sight(&self.ground, from, &target)?;
        let lofts = self.ground.lofts_by_walk(from, &target, sight, heading)?;
        let total = rest + self.judge.estimate(&target, heading, (sight, lofts));
        Some(Onward { target, sight, heading, lofts, total })
    }

    /// All feasible hops between nodes.
    fn edges(&self, meter: &Meter<'_>) -> Result<Vec<Vec<Successor>>, Cancelled> {
        let from_node = |counter: &mut PairCounter<'_>, node: usize| -> Result<Vec<Successor>, Cancelled> {
            counter.check()?;
            let from = &self.positions[node];
            let run_m = self.reach.run_m(from);
            let mut edges = Vec::new();
            for (target, to) in self.positions.iter().enumerate() {
                if target == node || node == self.goal || (to.at - from.at).norm_squared() > run_m * run_m {
                    continue;
                }
                counter.pair()?;
                let weight = self.onward(from, target, 0.0).map(|hop| hop.total);
                edges.extend(weight.map(|weight| Successor { target, hops: 1, weight }));
            }
            Ok(edges)
        };
        let all = (0..self.positions.len()).into_par_iter().map_init(|| meter.counter(), from_node);
        let edges = all.collect::<Result<Vec<_>, _>>();
        meter.check()?;
        edges
    }

    /// The node nearest to a position, of those that are of use.
    fn nearest(&self, at: MapPoint, of_use: impl Fn(usize) -> bool) -> Option<usize> {
        let away2 = |node: &usize| (self.positions[*node].at - at).norm_squared();
        (0..self.positions.len()).filter(|&node| of_use(node)).min_by(|a, b| away2(a).total_cmp(&away2(b)))
    }
}

/// The posts from one node to the next, for nodes that are this many posts apart.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the cast saturates")]
fn stride(posts: f64) -> usize {
    (posts.round() as usize).max(1)
}

/// Of every square of `stride` posts whose north-west post is within a distance of any of these positions, one place.
fn places_beside(
    (ground, beside): (&DemGround, Beside),
    positions: &[MapPosition],
    (stride, half_width_m): (usize, f64),
) -> Vec<MapPosition> {
    let dem = ground.terrain().dem();
    let lattice = NodeLattice::new(dem, stride);
    let map = dem.georeference();
    let corner = |of: fn(f64, f64) -> f64, first: f64, add_m: f64| {
        let all = positions.iter().fold([first; 2], |all, position| [of(all[0], position.at.x), of(all[1], position.at.y)]);
        MapPoint::new(all[0] + add_m, all[1] + add_m)
    };
    let (low, high) = (corner(f64::min, f64::INFINITY, -half_width_m), corner(f64::max, f64::NEG_INFINITY, half_width_m));
    let (north_west, south_east) =
        (lattice.nearest(map, MapPoint::new(low.x, high.y)), lattice.nearest(map, MapPoint::new(high.x, low.y)));
    let is_near = |at: MapPoint| positions.iter().any(|on_line| (on_line.at - at).norm_squared() <= half_width_m * half_width_m);
    let cols = north_west.col..=south_east.col;
    let posts = (north_west.row..=south_east.row).flat_map(|row| cols.clone().map(move |col| lattice.post(Post { row, col })));
    let place = |post: Post| match beside {
        Beside::Posts => Some(MapPosition { at: map.post(post.row, post.col), z_m: dem.elevation(post.row, post.col)? }),
        Beside::FlatFacets => flattest(ground, post, stride),
    };
    posts.filter(|post| is_near(map.post(post.row, post.col))).filter_map(place).collect()
}

/// The middle of the flattest facet of the square of posts that begins at this one.
fn flattest(ground: &DemGround, from: Post, stride: usize) -> Option<MapPosition> {
    /// The corners of the facets of a square between four posts, in rows and columns from the north-west one.
    const FACETS: [[(usize, usize); 3]; 2] = [[(0, 0), (0, 1), (1, 1)], [(0, 0), (1, 0), (1, 1)]];
    let dem = ground.terrain().dem();
    let map = dem.georeference();
    let facet = |row: usize, col: usize, corners: [(usize, usize); 3]| {
        let mut middle = Vector3::zeros();
        let mut at = [Vector3::zeros(); 3];
        for (corner, (down, right)) in at.iter_mut().zip(corners) {
            let post = map.post(row + down, col + right);
            *corner = Vector3::new(post.x, post.y, dem.elevation(row + down, col + right)?);
            middle += *corner / 3.0;
        }
        let normal = (at[1] - at[0]).cross(&(at[2] - at[0]));
        let steepness = (normal.x * normal.x + normal.y * normal.y) / (normal.z * normal.z);
        Some((steepness, MapPosition { at: MapPoint::new(middle.x, middle.y), z_m: middle.z }))
    };
    let squares = (from.row..from.row + stride).flat_map(|row| (from.col..from.col + stride).map(move |col| (row, col)));
    let facets = squares.flat_map(|(row, col)| FACETS.into_iter().filter_map(move |corners| facet(row, col, corners)));
    facets.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, middle)| middle)
}

/// The fewest hops from every node to the goal: breadth first, against the direction of the hops.
fn fewest_hops(edges: &[Vec<Successor>], goal: usize) -> Vec<Option<u64>> {
    let mut into: Vec<Vec<usize>> = vec![Vec::new(); edges.len()];
    for (from, edges) in edges.iter().enumerate() {
        for edge in edges {
            into[edge.target].push(from);
        }
    }
    let mut fewest = vec![None; edges.len()];
    fewest[goal] = Some(0);
    let mut layer = vec![goal];
    for hops in 1.. {
        let before = std::mem::take(&mut layer);
        for from in before.iter().flat_map(|&to| &into[to]) {
            if fewest[*from].is_none() {
                fewest[*from] = Some(hops);
                layer.push(*from);
            }
        }
        if layer.is_empty() {
            break;
        }
    }
    fewest
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;
    use crate::{
        draw::Draw,
        flight::Uncertainty,
        graph::{PointSpacing, TakeoffScatter},
        ground::Windows,
        quantity::{Angle, VertexId},
        terrain::{Dem, GeoReference, OverlaidDem, Overlays, Triangles},
        world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
    };

    const ERRORS: Uncertainty =
        Uncertainty { takeoff_speed_sigma_fraction: 0.02, takeoff_angle_sigma: Angle::from_radians(0.02), ..Uncertainty::NONE };

    fn rough_ground(draw: &mut Draw) -> DemGround {
        let heights = (0..14 * 18).map(|_| if draw.chance(0.02) { f64::NAN } else { draw.uniform(0.0, 0.3) }).collect();
        let dem = Dem::new(14, 18, heights, GeoReference::local(MapPoint::new(3.0, 20.0), 1.0, 1.2).unwrap()).unwrap();
        let grip = Some(Grip::Friction(FrictionCone::new(draw.uniform(0.7, 1.2)).unwrap()));
        let surface = SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds };
        let hopper = Hopper::with_speeds(2.6, 2.6).unwrap();
        DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, Gravity::new(1.62).unwrap(), &surface)
    }

    /// The corridor of a line over the middle of a ground; `None` if the line crosses missing elevations, or the ground has no corridor.
    fn corridor(ground: &DemGround, beside: Beside, extra: u32) -> Option<Corridor> {
        let chain = ground.chain(MapPoint::new(4.2, 12.3), MapPoint::new(18.4, 11.1)).ok()?;
        let last = VertexId(chain.geometry().segment_count());
        let [start, goal] = [VertexId(0), last].map(|vertex| chain.geometry().vertex_station(vertex));
        let spacing = PointSpacing::PerSegment(0);
        let nodes = NodeSet::new(&chain, start, goal, spacing).unwrap();
        let options = SearchOptions { spacing: Some(spacing), ..SearchOptions::default() };
        let model = RiskModel::Flown {
            errors: ERRORS,
            takeoffs: TakeoffScatter::OfPosition,
            over: Some(Box::new(ground.clone())),
            whole: None,
        };
        let reliability = ReliabilityOptions { model, extra_hops_max: Some(extra), goal_tolerance_m: Some(0.5) };
        Corridor::new(&HopTest::new(chain), &nodes, &options, (&reliability, ground, beside), &()).unwrap()
    }

    /// A path takes what is stated of its start, hop by hop, in no more hops than are allowed.
    #[test]
    fn a_path_adds_up_to_the_weight_of_its_start() {
        let draw = &mut Draw::seeded(2102);
        let (mut paths, mut longer) = (0, 0);
        for round in 0..24 {
            let (ground, beside, extra) = (rough_ground(draw), Beside::ALL[round % 2], [0, 1, 4, 60][round / 2 % 4]);
            let Some(found) = corridor(&ground, beside, extra) else { continue };
            let (nodes, path) = (found.nodes.as_ref(), found.path());
            assert_eq!(path.first().zip(path.last()), Some((&nodes.positions[nodes.start], &nodes.positions[nodes.goal])));
            let number = |place: &MapPosition| nodes.positions.iter().position(|node| node == place).unwrap();
            let taken: f64 = path.windows(2).map(|pair| nodes.onward(&pair[0], number(&pair[1]), 0.0).unwrap().total).sum();
            let stated = found.successors.weight(NodeId(nodes.start));
            assert!((taken - stated).abs() < 1e-9 * stated, "{taken}, stated {stated}");
            let (hops, fewest) = (path.len() as u64 - 1, found.successors.fewest(nodes.start).unwrap());
            assert!((fewest..=fewest + u64::from(extra)).contains(&hops), "{hops} hops, fewest {fewest}, {extra} more");
            paths += 1;
            longer += u32::from(hops > fewest);
        }
        assert!(paths > 6 && longer > 1, "{paths} paths, {longer} longer than the fewest");
    }

    /// Fewest hops and least weights by rounds over all pairs until nothing changes.
    #[test]
    fn hops_and_weights_equal_those_of_all_pairs() {
        let draw = &mut Draw::seeded(1701);
        let (mut corridors, mut edges, mut fewer) = (0, 0, 0);
        let apart = Cell::new(0);
        for round in 0..10 {
            let (ground, beside) = (rough_ground(draw), Beside::ALL[round % 2]);
            let Some(found) = corridor(&ground, beside, 60) else { continue };
            corridors += 1;
            let nodes = found.nodes.as_ref();
            let count = nodes.positions.len();
            let weight = |from: usize, to: usize| {
                if from == to {
                    return None;
                }
                let [from, to] = [from, to].map(|node| nodes.positions[node]);
                let away = to.at - from.at;
                let (sight, heading) = (LineOfSight::new(away.norm(), to.z_m - from.z_m), away.normalize());
                let lofts = ground.lofts_by_walk(&from, &to, sight, heading);
                let of_slice = ground.windows(&from, &to).is_some_and(|windows| !windows.lofts.is_empty());
                // Along an edge between facets a walk sees one of them, a slice both.
                apart.set(apart.get() + u32::from(lofts.is_some() != of_slice));
                let lofts = lofts?;
                Some(nodes.judge.estimate(&to, heading, (sight, lofts)))
            };
            let all: Vec<Vec<Option<f64>>> = (0..count).map(|from| (0..count).map(|to| weight(from, to)).collect()).collect();
            let mut expected = vec![(u64::MAX, f64::INFINITY); count];
            expected[nodes.goal] = (0, 0.0);
            loop {
                let before = expected.clone();
                for from in (0..count).filter(|&from| from != nodes.goal) {
                    for (to, weight) in all[from].iter().enumerate().filter_map(|(to, weight)| Some((to, (*weight)?))) {
                        let (hops, least) = &mut expected[from];
                        *hops = (*hops).min(before[to].0.saturating_add(1));
                        *least = least.min(before[to].1 + weight);
                    }
                }
                if expected == before {
                    break;
                }
            }
            for (node, &(hops, least)) in expected.iter().enumerate() {
                assert_eq!(found.successors.fewest(node).unwrap_or(u64::MAX), hops, "node {node} of round {round}");
                let weight = found.successors.weight(NodeId(node));
                assert!(weight == least || (weight - least).abs() < 1e-9 * least, "node {node}: {weight}, expected {least}");
                fewer += u32::from(least.is_finite() && hops > 2);
            }
            edges += all.iter().flatten().flatten().count();
        }
        assert!(
            corridors > 4 && edges > 5000 && fewer > 100,
            "{corridors} corridors, {edges} hops, {fewer} nodes far from the goal"
        );
    }

    /// Without errors the robot lands where it aims.
    #[test]
    fn a_robot_without_errors_comes_to_the_goal_from_every_node_and_from_beside_them() {
        let draw = &mut Draw::seeded(1702);
        let (mut arrived, mut from_beside) = (0, 0);
        for round in 0..10 {
            let ground = rough_ground(draw);
            for extra in [0, 3] {
                let Some(found) = corridor(&ground, Beside::ALL[round % 2], 8).map(|found| {
                    let fewest = found.successors.fewest(found.nodes.start).unwrap_or(0);
                    found.with_hops(fewest + extra)
                }) else {
                    continue;
                };
                let goal = found.nodes.positions[found.nodes.goal];
                let mut fly = |mut at: MapPosition| {
                    for hops in 0..80 {
                        if at == goal {
                            return Some(hops);
                        }
                        at = found.next_command(&at, |_, target, _, _| Some(*target))?;
                    }
                    None
                };
                for node in 0..found.node_count() {
                    let Some(fewest) = found.successors.fewest(node) else { continue };
                    let hops = fly(found.nodes.positions[node]).expect("a way to the goal");
                    assert!(hops >= fewest, "{hops} hops from node {node}, expected at least {fewest}");
                    arrived += 1;
                }
                for _ in 0..10 {
                    let beside = MapPoint::new(draw.uniform(5.0, 17.0), draw.uniform(9.0, 14.0));
                    from_beside += u32::from(ground.position(beside).and_then(&mut fly).is_some());
                }
            }
        }
        assert!(arrived > 300 && from_beside > 30, "{arrived} nodes, {from_beside} places beside them");
    }

    #[test]
    fn the_flattest_facet_of_a_square_is_the_flattest_and_its_middle_lies_on_the_ground() {
        let draw = &mut Draw::seeded(1703);
        let (mut found, mut gaps) = (0, 0);
        for _ in 0..8 {
            let ground = rough_ground(draw);
            let (dem, none) = (ground.terrain().dem(), Triangles::of(ground.terrain().dem()));
            let triangles = |at: MapPoint| Triangles::of(dem).at(at, none.nominal()).map(|(_, gradient)| gradient);
            for (row, col, stride) in [(0, 0, 2), (3, 5, 1), (6, 10, 3), (12, 16, 1), (13, 17, 1), (12, 3, 4)] {
                let Some(middle) = flattest(&ground, Post { row, col }, stride) else {
                    gaps += 1;
                    continue;
                };
                let there = ground.position(middle.at).expect("ground under the middle of a facet");
                assert!((there.z_m - middle.z_m).abs() < 1e-12, "{middle:?}: {there:?}");
                let map = ground.terrain().dem().georeference();
                let own = triangles(middle.at).expect("a facet").norm_squared();
                // The middles of all facets lie at thirds of their squares.
                for (down, right) in (0..stride).flat_map(|down| (0..stride).map(move |right| (down, right))) {
                    for (third_down, third_right) in [(1.0, 2.0), (2.0, 1.0)] {
                        let post = map.post(row + down, col + right);
                        let at = MapPoint::new(post.x + third_right / 3.0 * map.dx_m(), post.y - third_down / 3.0 * map.dy_m());
                        let is_flatter = triangles(at).is_some_and(|gradient| gradient.norm_squared() < own * (1.0 - 1e-9));
                        assert!(!is_flatter, "{row}, {col}: flatter at {at:?}");
                    }
                }
                found += 1;
            }
        }
        assert!(found > 20 && gaps > 7, "{found} found, {gaps} squares without a facet");
    }
}
