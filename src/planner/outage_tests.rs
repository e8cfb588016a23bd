//! Routes and missions under outages against all sequences of hops over tiny maps.

use super::{
    surface_hops::{Side, SurfaceHops},
    surface_legs::{LegOffers, Settling},
    *,
};
use crate::{
    ballistics::TakeoffChoice,
    draw::Draw,
    graph::Effort,
    ground::DemGround,
    progress::{Meter, Stage},
    quantity::MapPoint,
    terrain::{Dem, GeoReference, Layer, LayerCondition, LayerRule, MapLayers, OutageLimit, OverlaidDem, Overlays, read_layer},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, LayerName, RestSlope, SurfaceProperties},
};

const SIDE: usize = 4;
const SETTLING_S: f64 = 0.7;
const PREPARATION_S: f64 = 0.2;
/// Sequences of more hops are not tried.
const HOPS_MAX: u32 = 4;

fn number(draw: &mut Draw, below: usize) -> u32 {
    u32::try_from(draw.below(below)).unwrap()
}

/// A layer of random cells, half of them shaded, that may be left for a while.
fn layer(draw: &mut Draw, name: &str) -> Layer {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("layer.asc");
    let cells: Vec<&str> = (0..64).map(|_| if draw.chance(0.45) { "0" } else { "1" }).collect();
    let rows: Vec<String> = cells.chunks(8).map(|row| row.join(" ")).collect();
    let head = "ncols 8\nnrows 8\nxllcorner 2\nyllcorner 35.5\ncellsize 0.7\n";
    std::fs::write(&file, format!("{head}{}\n", rows.join("\n"))).unwrap();
    let limit = OutageLimit {
        max_s: draw.chance(0.7).then(|| draw.uniform(0.5, 12.0)),
        hops_max: draw.chance(0.5).then(|| number(draw, 4)),
        exempt_targets: draw.chance(0.4),
    };
    let on_flight = draw.chance(0.3);
    let rule = LayerRule {
        name: LayerName::new(name).unwrap(),
        condition: LayerCondition { equals: Some(1.0), ..LayerCondition::default() },
        on_contact: !on_flight || draw.chance(0.5),
        on_flight,
        outage: Some(limit),
        cost: None,
    };
    read_layer(&file, rule, None).unwrap()
}

fn ground(draw: &mut Draw) -> DemGround {
    let names = if draw.chance(0.3) { &["link", "sun"][..] } else { &["sun"][..] };
    let layers = MapLayers::new(names.iter().map(|name| layer(draw, name)).collect());
    ground_under(draw, &[layers]).remove(0)
}

/// The same small random map under each of some sets of layers.
pub(super) fn ground_under(draw: &mut Draw, layers: &[MapLayers]) -> Vec<DemGround> {
    let relief_m = draw.log_uniform(0.1, 1.0);
    let heights = (0..SIDE * SIDE).map(|_| if draw.chance(0.04) { f64::NAN } else { draw.uniform(0.0, relief_m) }).collect();
    let dem = Dem::new(SIDE, SIDE, heights, GeoReference::local(MapPoint::new(3.0, 40.0), 1.0, 1.0).unwrap()).unwrap();
    let surface = SurfaceProperties {
        grip: Some(Grip::Friction(FrictionCone::new(draw.uniform(0.7, 1.5)).unwrap())),
        rest: RestSlope::Unlimited,
    };
    let times = HopperLimits {
        settling_time_s: Some(SETTLING_S),
        preparation_time_s: Some(PREPARATION_S),
        ..HopperLimits::with_speeds(2.2, 2.2)
    };
    let hopper = Hopper::new(times).unwrap();
    let under = |layers: &MapLayers| {
        let overlaid = OverlaidDem::new(dem.clone(), Overlays::default().with_layers(layers.clone()));
        DemGround::new(overlaid, &hopper, Gravity::new(2.1).unwrap(), &surface)
    };
    layers.iter().map(under).collect()
}

/// All hops between nodes, with what they take: of the first hop of a mission, and of later ones.
pub(super) struct AllHops {
    pub(super) places: Vec<MapPoint>,
    /// By node: the other node, and the amounts of the first hop and of a later one.
    pub(super) hops: Vec<Vec<(usize, [Amounts; 2])>>,
}

/// Gathers the legs of a node.
#[derive(Default)]
struct Gathered(Vec<(usize, Amounts)>);

impl LegVisitor for Gathered {
    fn visit(&mut self, leg: &Successor) {
        self.0.push((leg.node, leg.amounts));
    }
}

impl AllHops {
    pub(super) fn of(ground: &DemGround, nodes: &SurfaceNodes) -> Self {
        let surface = SurfaceHops::new(ground, nodes);
        let meter = Meter::new(&(), Stage::Search);
        let nowhere = MapPoint::new(-1e9, -1e9);
        let gathered = |node: usize, settling: Settling| {
            let offers = LegOffers::new(&surface, settling, (SearchedCommands::Chosen, TakeoffChoice::LeastSpeed), None);
            let mut visitor = Gathered::default();
            let of = (SurfaceNode::of_index(node), Side::Start);
            offers.visit(of, &|_| true, &mut visitor, None, &mut meter.counter()).unwrap();
            visitor.0
        };
        let hops = |node: usize| {
            let first = gathered(node, Settling::BeforeAllBut(SurfaceNode::of_index(node)));
            let later = gathered(node, Settling::BeforeAll);
            first.into_iter().zip(later).map(|((to, first), (_, later))| (to, [first, later])).collect()
        };
        let place = |node: usize| surface.position(SurfaceNode::of_index(node)).map_or(nowhere, |place| place.at);
        Self { places: (0..nodes.count()).map(place).collect(), hops: (0..nodes.count()).map(hops).collect() }
    }
}

/// A sequence of hops on its way.
#[derive(Clone)]
struct OnTheWay {
    at: usize,
    visited: u32,
    hops: u32,
    totals: Amounts,
    /// By layer: the time and the hops outside since its condition last held.
    clocks: Vec<(f64, u32)>,
}

/// Tries all sequences of hops from the start over the targets, for those of most targets, then the least by the objective.
struct Tried<'a> {
    all: &'a AllHops,
    layers: Vec<&'a Layer>,
    start: usize,
    targets: &'a [usize],
    returns: bool,
    objective: &'a Objective,
    best: Option<(u32, Vec<f64>)>,
}

impl Tried<'_> {
    fn is_outside(&self, layer: &Layer, at: MapPoint) -> bool {
        let rule = layer.rule();
        let is_target = self.targets.iter().any(|target| self.all.places[*target] == at);
        rule.on_contact && !layer.holds_at(at) && !(rule.outage.unwrap().exempt_targets && is_target)
    }

    /// The clocks after a hop; `None` if a stretch is too long.
    fn clocks(&self, way: &OnTheWay, to: usize, flight_s: f64) -> Option<Vec<(f64, u32)>> {
        let [from, to] = [way.at, to].map(|node| self.all.places[node]);
        let rest_s = if way.hops == 0 { PREPARATION_S } else { SETTLING_S + PREPARATION_S };
        let clock = |(layer, (time_s, hops)): (&&Layer, &(f64, u32))| {
            let [begins, ends] = [from, to].map(|at| self.is_outside(layer, at));
            let flies = begins || ends || (layer.rule().on_flight && !layer.holds_between(from, to));
            let (mut time_s, mut hops) = if begins { (*time_s + rest_s, *hops) } else { (0.0, 0) };
            if flies {
                (time_s, hops) = (time_s + flight_s, hops + 1);
            }
            let limit = layer.rule().outage.unwrap();
            let is_kept = match (limit.max_s, limit.hops_max) {
                (None, None) => hops == 0,
                (most_s, most) => {
                    most_s.is_none_or(|most_s| time_s <= most_s * (1.0 + 1e-9)) && most.is_none_or(|most| hops <= most)
                }
            };
            is_kept.then_some(if ends { (time_s, hops) } else { (0.0, 0) })
        };
        self.layers.iter().zip(&way.clocks).map(clock).collect()
    }

    fn go(&mut self, way: &OnTheWay) {
        if way.visited > 0 && (!self.returns || way.at == self.start) {
            let totals: Vec<f64> = self.objective.amounts().iter().map(|amount| way.totals.of(*amount)).collect();
            let count = way.visited.count_ones();
            let is_better = self
                .best
                .as_ref()
                .is_none_or(|(most, least)| count > *most || (count == *most && labels::by_objective(&totals, least).is_lt()));
            if is_better {
                self.best = Some((count, totals));
            }
        }
        if way.hops == HOPS_MAX {
            return;
        }
        for (to, amounts) in self.all.hops[way.at].clone() {
            let amounts = amounts[usize::from(way.hops > 0)];
            let Some(clocks) = self.clocks(way, to, amounts.of(Amount::FlightTime)) else { continue };
            let bit = self.targets.iter().position(|target| *target == to).map_or(0, |target| 1 << target);
            let next =
                OnTheWay { at: to, visited: way.visited | bit, hops: way.hops + 1, totals: way.totals.then(&amounts), clocks };
            self.go(&next);
        }
    }

    fn best(mut self) -> Option<(u32, Vec<f64>)> {
        let clocks = vec![(0.0, 0); self.layers.len()];
        self.go(&OnTheWay { at: self.start, visited: 0, hops: 0, totals: Amounts::NONE, clocks });
        self.best
    }
}

/// A start and targets on posts of a ground, with its nodes; `None` where one of them has no elevation.
pub(super) fn stops(draw: &mut Draw, ground: &DemGround, count: usize) -> Option<(Vec<MapPoint>, SurfaceNodes)> {
    let mut post = || MapPoint::new(3.0 + f64::from(number(draw, SIDE)), 40.0 - f64::from(number(draw, SIDE)));
    let stops: Vec<MapPoint> = (0..count).map(|_| post()).collect();
    let differ = stops.iter().enumerate().all(|(number, at)| !stops[..number].contains(at));
    if !differ || stops.iter().any(|at| ground.position(*at).is_none()) {
        return None;
    }
    let lattice = SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::of(1));
    let nodes = SurfaceNodes::new(ground, lattice, stops.iter().copied()).unwrap();
    Some((stops, nodes))
}

#[test]
fn routes_and_missions_under_outages_are_those_of_all_sequences_of_hops() {
    let draw = &mut Draw::seeded(2111);
    let (mut whole, mut some, mut around, mut without, mut through) = (0, 0, 0, 0, 0);
    for case in 0..260 {
        let ground = ground(draw);
        let targets = 1 + draw.below(2);
        let Some((stops, nodes)) = stops(draw, &ground, targets + 1) else { continue };
        let objective =
            if draw.chance(0.5) { Objective::hops_then(Effort::TakeoffSpeed) } else { Objective::of(Amount::MissionTime) };
        let (commands, takeoff) = (SearchedCommands::Chosen, TakeoffChoice::LeastSpeed);
        let question =
            RouteQuestion { objective: &objective, budgets: &Budgets::NONE, commands, errors: None, cap: LabelCap::default() };
        let returns = targets > 1 && draw.chance(0.3);
        let all = AllHops::of(&ground, &nodes);
        let at: Vec<usize> = stops.iter().map(|stop| nodes.place(*stop).unwrap().index()).collect();
        let tried = |layers: Vec<&Layer>| {
            Tried { all: &all, layers, start: at[0], targets: &at[1..], returns, objective: &objective, best: None }.best()
        };
        let expected = tried(ground.layers().iter().collect());
        let key = |totals: &Amounts| objective.amounts().iter().map(|amount| totals.of(*amount)).collect::<Vec<f64>>();
        let (visited, found, hops) = if targets == 1 {
            let goal = RouteGoal { start: stops[0], goal: stops[1], effort: Effort::TakeoffSpeed, takeoff };
            let route = free_route_by(&ground, &nodes, &goal, &question, &()).unwrap();
            let path = route.path.filter(|_| route.within);
            (u32::from(path.is_some()), path.as_ref().map(|path| key(&path.totals)), path.map_or(0, |path| path.choices.len()))
        } else {
            let question =
                TourQuestion { route: question, effort: Effort::TakeoffSpeed, takeoff, order: VisitOrder::Best, returns };
            let tour = tour(&ground, &nodes, &stops, &question, &()).unwrap();
            assert!(!tour.capped);
            let visited = u32::try_from(targets - tour.left_out.len()).unwrap();
            let hops = tour.legs.iter().map(|leg| leg.path.choices.len()).sum();
            (visited, (visited > 0).then(|| key(&tour.totals)), hops)
        };
        // What needs more hops than all sequences were tried for is no truth to compare with.
        let (most, least) = expected.clone().map_or((0, None), |(most, least)| (most, Some(least)));
        if hops > HOPS_MAX as usize {
            continue;
        }
        assert_eq!(visited, most, "case {case}: {objective}, {found:?}, expected {expected:?}");
        for (found, least) in found.iter().flatten().zip(least.iter().flatten()) {
            assert!((found - least).abs() <= 1e-9 * (1.0 + least), "case {case}: {objective}: {found}, {least}");
        }
        let free = tried(Vec::new());
        whole += u32::from(targets > 1 && visited as usize == targets);
        let is_outside = |at: &MapPoint| ground.layers().iter().any(|layer| layer.is_outside_at(*at, &stops[1..]));
        through += u32::from(targets > 1 && visited as usize == targets && stops[1..].iter().any(is_outside));
        some += u32::from(targets > 1 && visited == 1);
        around += u32::from(free.as_ref().is_some_and(|(most, _)| *most == visited) && free != expected && visited > 0);
        without += u32::from(free.is_some_and(|(most, _)| most > visited));
    }
    let counts = format!("{whole} whole, {some} in part, {around} other ways, {without} fewer targets, {through} through shade");
    assert!(whole > 20 && through > 10 && some > 5 && around > 10 && without > 20, "{counts}");
}
