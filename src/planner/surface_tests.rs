//! The search over a DEM with its bounds against the same without any, and the fewest hops against all pairs of nodes.

use super::{
    by_layers::best_of_fewest,
    fewest_hops::{FewestHops, Within},
    surface_hops::{Side, SurfaceHops},
    surface_legs::{Counted, LegOffers, Settling},
    *,
};
use crate::{
    ballistics::{PathBounds, TakeoffChoice},
    draw::Draw,
    graph::Effort,
    ground::{DemGround, MapPosition},
    progress::{Cancelled, Meter, Stage},
    quantity::MapPoint,
    terrain::{Dem, GeoReference, OverlaidDem, Overlays},
    world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};

/// Greatest speeds of the tests, and gravity.
const SPEEDS_M_S: (f64, f64) = (3.2, 2.9);
const GRAVITY_M_S2: f64 = 2.1;

fn ground(draw: &mut Draw, side: usize) -> DemGround {
    let relief_m = draw.log_uniform(0.1, 2.0);
    let heights = (0..side * side).map(|_| if draw.chance(0.05) { f64::NAN } else { draw.uniform(0.0, relief_m) }).collect();
    let dem = Dem::new(side, side, heights, GeoReference::local(MapPoint::new(3.0, 40.0), 1.0, 1.3).unwrap()).unwrap();
    let grip = Some(Grip::Friction(FrictionCone::new(draw.uniform(0.5, 1.5)).unwrap()));
    let surface = SurfaceProperties { grip, rest: RestSlope::Unlimited };
    let hopper = Hopper::with_speeds(SPEEDS_M_S.0, SPEEDS_M_S.1).unwrap();
    DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, Gravity::new(GRAVITY_M_S2).unwrap(), &surface)
}

/// A ground, its nodes, and two places with ground; `None` where a draw has none.
fn world(draw: &mut Draw, side: usize) -> Option<(DemGround, SurfaceNodes, [MapPoint; 2])> {
    let ground = ground(draw, side);
    let bounds = ground.terrain().dem().bounds();
    let ends = [0, 1].map(|_| MapPoint::new(draw.uniform(bounds.min.x, bounds.max.x), draw.uniform(bounds.min.y, bounds.max.y)));
    ends.iter().all(|at| ground.position(*at).is_some()).then_some(())?;
    let lattice = SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::at_most_m(0.5, 1.0));
    let nodes = SurfaceNodes::new(&ground, lattice, ends).unwrap();
    Some((ground, nodes, ends))
}

/// The same graph without bounds.
struct WithoutBounds<'a>(SurfaceLegs<'a>);

impl LegGraph for WithoutBounds<'_> {
    fn nodes(&self) -> usize {
        self.0.nodes()
    }

    fn successors(&self, node: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled> {
        self.0.successors(node, visitor)
    }

    fn least_to_goal(&self, _: usize) -> Amounts {
        Amounts::NONE
    }
}

const EVERYWHERE: fn(&MapPosition) -> u64 = |_| 0;

fn all() -> Within<'static> {
    Within { line: None, most: u64::MAX, rest: &EVERYWHERE, until: &[] }
}

#[test]
fn bounds_change_no_best_total() {
    let draw = &mut Draw::seeded(1731);
    let (mut found, mut fewer) = (0, 0);
    for case in 0..40 {
        let Some((ground, nodes, ends)) = world(draw, 5) else { continue };
        let surface = SurfaceHops::new(&ground, &nodes);
        let meter = Meter::new(&(), Stage::Search);
        let [start, goal] = ends.map(|at| nodes.place(at).unwrap());
        let goal = (goal, surface.position(goal).unwrap());
        let levels = FewestHops::from(&surface, (Side::Goal, goal.0), &all(), &meter).unwrap();
        for objective in [
            vec![Amount::Hops, Amount::Energy],
            vec![Amount::Energy],
            vec![Amount::FlightTime, Amount::Hops],
            vec![Amount::Hops, Amount::PeakSpeed],
            vec![Amount::Hops, Amount::Distance, Amount::FlightTime, Amount::PeakSpeed],
            vec![Amount::ArcLength],
        ] {
            let objective = Objective::new(objective).unwrap();
            let first = objective.first();
            let searched = |counted, bounded| {
                let offered = (SearchedCommands::Distinct, TakeoffChoice::LeastSpeed);
                let offers = LegOffers::new(&surface, Settling::BeforeAllBut(start), offered, None);
                let legs = SurfaceLegs::new(offers, (start, goal), (&levels, counted), &meter);
                let (ends, budgets, cap) = (legs.ends(), Budgets::NONE, LabelCap::default());
                if bounded {
                    search(&legs, ends, &objective, &budgets, cap).unwrap()
                } else {
                    search(&WithoutBounds(legs), ends, &objective, &budgets, cap).unwrap()
                }
            };
            let plain = searched(Counted::All, false);
            let mut others = vec![searched(Counted::All, true), searched(Counted::Known, true)];
            if first == Amount::Hops {
                let offered = (SearchedCommands::Distinct, TakeoffChoice::LeastSpeed);
                let offers = LegOffers::new(&surface, Settling::BeforeAllBut(start), offered, None);
                let legs = SurfaceLegs::new(offers, (start, goal), (&levels, Counted::Known), &meter);
                others.push(best_of_fewest(&legs, &levels, (&objective, LabelCap::default()), &meter).unwrap());
            }
            for other in others {
                assert_eq!(other.path.is_some(), plain.path.is_some(), "case {case}: {objective}");
                let (Some(path), Some(expected)) = (&other.path, &plain.path) else { continue };
                for amount in objective.amounts() {
                    let (total, expected) = (path.totals.of(*amount), expected.totals.of(*amount));
                    assert!((total - expected).abs() <= 1e-9 * (1.0 + expected), "case {case}: {objective}: {total}, {expected}");
                }
                found += 1;
                fewer += u32::from(other.settled < plain.settled);
            }
        }
    }
    assert!(found > 150 && fewer > 100, "{found} found, {fewer} with fewer nodes");
}

#[test]
fn fewest_hops_are_those_of_all_pairs_also_under_a_bound() {
    let draw = &mut Draw::seeded(1732);
    let (mut compared, mut left_out) = (0, 0);
    for case in 0..30 {
        let Some((ground, nodes, ends)) = world(draw, 6) else { continue };
        let surface = SurfaceHops::new(&ground, &nodes);
        let meter = Meter::new(&(), Stage::Search);
        let [start, goal] = ends.map(|at| nodes.place(at).unwrap());
        let numbered = |node: usize| SurfaceNode(u32::try_from(node).unwrap());
        let at: Vec<Option<MapPosition>> = (0..nodes.count()).map(|node| surface.position(numbered(node))).collect();
        let is_hop = |from: usize, to: usize| {
            let (Some(here), Some(there)) = (at[from], at[to]) else { return false };
            let sight = surface.sight(&here, &there);
            sight.is_some_and(|sight| surface.between([numbered(from), numbered(to)], [&here, &there], sight).is_some())
        };
        let count = nodes.count();
        let hops: Vec<Vec<usize>> =
            (0..count).map(|from| (0..count).filter(|to| *to != from && is_hop(from, *to)).collect()).collect();
        let levels = |end: SurfaceNode, backwards: bool| {
            let mut level = vec![None; count];
            level[end.index()] = Some(0);
            for next in 1..count {
                let before = level.clone();
                for (from, to) in hops.iter().enumerate().flat_map(|(from, all)| all.iter().map(move |to| (from, *to))) {
                    let (known, other) = if backwards { (to, from) } else { (from, to) };
                    if before[known] == Some(next - 1) && level[other].is_none() {
                        level[other] = Some(next);
                    }
                }
                if before == level {
                    break;
                }
            }
            level
        };
        let (from_start, to_goal) = (levels(start, false), levels(goal, true));
        let forward = FewestHops::from(&surface, (Side::Start, start), &all(), &meter).unwrap();
        let backward = FewestHops::from(&surface, (Side::Goal, goal), &all(), &meter).unwrap();
        let of = |found: &FewestHops, node: usize| found.of(numbered(node)).map(|hops| hops as usize);
        for node in 0..count {
            assert_eq!((of(&forward, node), of(&backward, node)), (from_start[node], to_goal[node]), "case {case}: node {node}");
        }
        assert_eq!(backward.known, to_goal.iter().flatten().count(), "case {case}");
        let Some(fewest) = to_goal[start.index()] else { continue };
        let most = fewest + draw.below(3);
        let bounds = PathBounds::new(SPEEDS_M_S.0, SPEEDS_M_S.1, GRAVITY_M_S2);
        let first = at[start.index()].unwrap();
        let rest = |to: &MapPosition| bounds.hops((to.at - first.at).norm(), to.z_m - first.z_m).unwrap();
        let within = Within { most: most as u64, rest: &rest, ..all() };
        let bounded = FewestHops::from(&surface, (Side::Goal, goal), &within, &meter).unwrap();
        for node in 0..count {
            let (found, expected) = (of(&bounded, node), to_goal[node]);
            let is_on_a_path = from_start[node].zip(expected).is_some_and(|(before, after)| before + after <= most);
            assert!(found == expected || (found.is_none() && !is_on_a_path), "case {case}: node {node}: {found:?}, {expected:?}");
            left_out += u32::from(found.is_none() && expected.is_some());
        }
        compared += 1;
    }
    assert!(compared > 10 && left_out > 100, "{compared} compared, {left_out} nodes left out");
}

/// A search that may keep hardly any label still answers with a path where one exists, and says that labels were left out.
#[test]
fn labels_that_were_left_out_are_no_reason_to_deny_a_path() {
    let draw = &mut Draw::seeded(1735);
    let (mut paths, mut capped) = (0, 0);
    for case in 0..40 {
        let Some((ground, nodes, [start, goal])) = world(draw, 5) else { continue };
        let how = RouteGoal { start, goal, effort: Effort::Energy, takeoff: TakeoffChoice::LeastSpeed };
        let whole = free_route(&ground, &nodes, &how, &()).unwrap();
        let question = RouteQuestion {
            objective: &Objective::of(Amount::Energy),
            budgets: &Budgets::NONE,
            commands: SearchedCommands::Distinct,
            errors: None,
            cap: LabelCap { of_node: 1, in_all: 2 },
        };
        let few = free_route_by(&ground, &nodes, &how, &question, &()).unwrap();
        assert_eq!(few.path.is_some(), whole.path.is_some(), "case {case}");
        if let Some(path) = &few.path {
            assert!(few.within && path.places.first().is_some_and(|place| place.at == start), "case {case}");
            paths += 1;
            capped += u32::from(few.capped);
        }
    }
    assert!(paths > 10 && capped > 5, "{paths} paths, {capped} with labels left out");
}
