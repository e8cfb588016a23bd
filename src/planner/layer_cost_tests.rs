//! Routes, missions and fronts by what layers cost against all sequences of hops over tiny maps.

use super::{
    outage_tests::{AllHops, ground_under, stops},
    *,
};
use crate::{
    ballistics::TakeoffChoice,
    draw::Draw,
    graph::Effort,
    quantity::MapPoint,
    terrain::{Layer, LayerCondition, LayerCost, LayerRule, MapLayers, read_layer},
    world::LayerName,
};

/// Sequences of more hops are not tried.
const HOPS_MAX: usize = 4;

/// Cells of a layer, a side.
const CELLS: usize = 8;

/// Columns and rows of cells, each from one whole number to the next: borders lie on no post but in one row.
fn cell(at: MapPoint) -> [f64; 2] {
    [(at.x - 2.0) / 0.7, (35.5 + 8.0 * 0.7 - at.y) / 0.7]
}

/// A layer of small random values, some of them unknown, with a cost.
fn layer(draw: &mut Draw, name: &str) -> Layer {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("layer.asc");
    let unknown = if draw.chance(0.4) { 0.06 } else { 0.0 };
    let value = |draw: &mut Draw| if draw.chance(unknown) { "-9" } else { ["0", "0", "1", "2.5", "7"][draw.below(5)] };
    let cells: Vec<&str> = (0..CELLS * CELLS).map(|_| value(draw)).collect();
    let rows: Vec<String> = cells.chunks(CELLS).map(|row| row.join(" ")).collect();
    let head = "ncols 8\nnrows 8\nxllcorner 2\nyllcorner 35.5\ncellsize 0.7\nNODATA_value -9\n";
    std::fs::write(&file, format!("{head}{}\n", rows.join("\n"))).unwrap();
    let [per_contact, per_m] = [[1.5, 0.0], [0.0, 0.8], [0.4, 2.0]][draw.below(3)];
    let cost = Some(LayerCost { per_contact, per_m, total_max: None });
    let (name, condition) = (LayerName::new(name).unwrap(), LayerCondition::default());
    read_layer(&file, LayerRule { name, condition, on_contact: false, on_flight: false, outage: None, cost }, None).unwrap()
}

/// The greatest value of the cells that a place touches; `None` where one is unknown.
fn value_at(layer: &Layer, [col, row]: [f64; 2]) -> Option<f64> {
    let touches = |at: f64, cell: usize| {
        let low = f64::from(u32::try_from(cell).unwrap());
        low - 1e-9 <= at && at <= low + 1.0 + 1e-9
    };
    let cells = (0..CELLS).flat_map(|row| (0..CELLS).map(move |col| (row, col)));
    let touched = cells.filter(|(r, c)| touches(row, *r) && touches(col, *c));
    touched.map(|(row, col)| layer.raster().elevation(row, col)).try_fold(0.0, |most: f64, value| Some(most.max(value?)))
}

/// What a hop costs, from all borders that there are; `None` where a value is unknown.
fn cost(layer: &Layer, from: MapPoint, to: MapPoint) -> Option<f64> {
    let cost = layer.rule().cost.unwrap();
    let (a, b) = (cell(from), cell(to));
    let mut total = 0.0;
    if cost.per_contact > 0.0 {
        value_at(layer, a)?;
        total += cost.per_contact * value_at(layer, b)?;
    }
    if cost.per_m > 0.0 {
        let borders = (0..=8).flat_map(|border| [0, 1].map(|axis| (f64::from(border) - a[axis]) / (b[axis] - a[axis])));
        let mut cuts: Vec<f64> = borders.filter(|share| *share > 0.0 && *share < 1.0).chain([0.0, 1.0]).collect();
        cuts.sort_by(f64::total_cmp);
        for piece in cuts.windows(2) {
            let at = |share: f64| [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]));
            let value = value_at(layer, at(0.5 * (piece[0] + piece[1])))?;
            // Corners and borders that the track touches count as known or not, but have no length.
            value_at(layer, at(piece[1]))?;
            value_at(layer, at(piece[0]))?;
            total += cost.per_m * (to - from).norm() * (piece[1] - piece[0]) * value;
        }
    }
    Some(total)
}

/// All ways from a start over the targets, and back where the mission returns.
struct Tried<'a> {
    all: &'a AllHops,
    layers: Vec<&'a Layer>,
    start: usize,
    targets: &'a [usize],
    returns: bool,
    /// Those that visit something: the targets as bits, the hops, and what they take.
    found: Vec<(u32, usize, Amounts)>,
}

impl Tried<'_> {
    fn go(&mut self, (at, visited, hops): (usize, u32, usize), totals: &Amounts) {
        if visited > 0 && (!self.returns || at == self.start) {
            self.found.push((visited, hops, *totals));
        }
        if hops == HOPS_MAX {
            return;
        }
        for (to, amounts) in self.all.hops[at].clone() {
            let [from, landing] = [at, to].map(|node| self.all.places[node]);
            let costs: Option<Vec<f64>> = self.layers.iter().map(|layer| cost(layer, from, landing)).collect();
            let Some(costs) = costs else { continue };
            let mut next = totals.then(&amounts[usize::from(hops > 0)]);
            for (layer, cost) in self.layers.iter().zip(costs) {
                let amount = Amount::Layer(layer.rule().name);
                next = next.with(amount, totals.of(amount) + cost);
            }
            let bit = self.targets.iter().position(|target| *target == to).map_or(0, |target| 1 << target);
            self.go((to, visited | bit, hops + 1), &next);
        }
    }

    /// The best by an objective within budgets: of those over most targets.
    fn best(&self, objective: &Objective, budgets: &Budgets) -> Option<(u32, Vec<f64>)> {
        let key = |totals: &Amounts| objective.amounts().iter().map(|amount| totals.of(*amount)).collect::<Vec<f64>>();
        let within = self.found.iter().filter(|(.., totals)| budgets.exceeded_by(totals).next().is_none());
        within.map(|(visited, _, totals)| (visited.count_ones(), key(totals))).reduce(|best, next| {
            let is_better = next.0 > best.0 || (next.0 == best.0 && labels::by_objective(&next.1, &best.1).is_lt());
            if is_better { next } else { best }
        })
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * (1.0 + a.abs() + b.abs())
}

#[test]
fn routes_missions_and_fronts_by_layers_are_those_of_all_sequences_of_hops() {
    let draw = &mut Draw::seeded(2112);
    let (mut compared, mut bounded, mut other, mut missions, mut fronts) = (0, 0, 0, 0, 0);
    for case in 0..300 {
        let names = if draw.chance(0.4) { &["cold", "hazard"][..] } else { &["hazard"][..] };
        let layers = MapLayers::new(names.iter().map(|name| layer(draw, name)).collect());
        let grounds = ground_under(draw, &[layers, MapLayers::default()]);
        let [ground, bare] = grounds.as_slice() else { unreachable!() };
        let targets = 1 + draw.below(2);
        let Some((stops, nodes)) = stops(draw, ground, targets + 1) else { continue };
        // Whatever the layers say: what they refuse is found here by itself.
        let all = AllHops::of(bare, &nodes);
        let at: Vec<usize> = stops.iter().map(|stop| nodes.place(*stop).unwrap().index()).collect();
        let returns = targets > 1 && draw.chance(0.3);
        let known = ground.layers().iter().collect();
        let mut tried = Tried { all: &all, layers: known, start: at[0], targets: &at[1..], returns, found: Vec::new() };
        tried.go((at[0], 0, 0), &Amounts::NONE);
        let hazard = Amount::Layer(LayerName::new("hazard").unwrap());
        let objectives = [vec![hazard, Amount::Hops], vec![Amount::Hops, hazard], vec![Amount::Energy, hazard], vec![Amount::Hops]];
        let objective = Objective::new(objectives[draw.below(4)].clone()).unwrap();
        let free = tried.best(&objective, &Budgets::NONE);
        let most = tried.found.iter().map(|(.., totals)| totals.of(hazard)).fold(0.0, f64::max);
        let budgets =
            if draw.chance(0.6) { Budgets::NONE.with(hazard, draw.uniform(0.0, 0.6) * most).unwrap() } else { Budgets::NONE };
        let (commands, takeoff) = (SearchedCommands::Chosen, TakeoffChoice::LeastSpeed);
        let question = RouteQuestion { objective: &objective, budgets: &budgets, commands, errors: None, cap: LabelCap::default() };
        let goal = RouteGoal { start: stops[0], goal: stops[1], effort: Effort::TakeoffSpeed, takeoff };
        let key = |totals: &Amounts| objective.amounts().iter().map(|amount| totals.of(*amount)).collect::<Vec<f64>>();
        let (visited, found, hops) = if targets == 1 {
            let route = free_route_by(ground, &nodes, &goal, &question, &()).unwrap();
            let path = route.path.filter(|_| route.within);
            (u32::from(path.is_some()), path.as_ref().map(|path| key(&path.totals)), path.map_or(0, |path| path.choices.len()))
        } else {
            let question =
                TourQuestion { route: question, effort: Effort::TakeoffSpeed, takeoff, order: VisitOrder::Best, returns };
            let tour = tour(ground, &nodes, &stops, &question, &()).unwrap();
            assert!(!tour.capped);
            let visited = u32::try_from(targets - tour.left_out.len()).unwrap();
            (visited, (visited > 0).then(|| key(&tour.totals)), tour.legs.iter().map(|leg| leg.path.choices.len()).sum())
        };
        let expected = tried.best(&objective, &budgets);
        let (most_visited, least) = expected.clone().map_or((0, None), |(most, least)| (most, Some(least)));
        // What needs more hops than all sequences were tried for is no truth to compare with, but it is no worse.
        if hops > HOPS_MAX {
            let ahead = found.as_ref().zip(least.as_ref()).is_none_or(|(found, least)| found[0] <= least[0] + 1e-9);
            assert!(visited > most_visited || ahead, "case {case}: {objective}, {found:?}, {expected:?}");
            continue;
        }
        assert_eq!(visited, most_visited, "case {case}: {objective}, {found:?}, expected {expected:?}");
        for (found, least) in found.iter().flatten().zip(least.iter().flatten()) {
            assert!(close(*found, *least), "case {case}: {objective}: {found}, {least}");
        }
        compared += u32::from(visited > 0);
        missions += u32::from(visited > 1);
        bounded += u32::from(!budgets.are_none() && free != expected);
        if targets == 1 && visited == 1 {
            let front_hops = |_| HOPS_MAX as u64;
            let asked = (hazard, &RouteQuestion { budgets: &Budgets::NONE, ..question }, &front_hops as &dyn Fn(u64) -> u64);
            let front = front_of_routes(ground, &nodes, &goal, asked, &()).unwrap();
            let mut least = f64::INFINITY;
            let mut expected = Vec::new();
            for hops in 1..=HOPS_MAX {
                let ways = tried.found.iter().filter(|(_, count, _)| *count == hops).map(|(.., totals)| totals.of(hazard));
                let best = ways.fold(f64::INFINITY, f64::min);
                if best < least - 1e-9 {
                    least = best;
                    expected.push((hops, best));
                }
            }
            let found: Vec<_> = front.paths.iter().map(|path| (path.choices.len(), path.totals.of(hazard))).collect();
            assert_eq!(found.len(), expected.len(), "case {case}: {found:?}, {expected:?}");
            let alike = |(found, expected): (&(usize, f64), &(usize, f64))| found.0 == expected.0 && close(found.1, expected.1);
            assert!(found.iter().zip(&expected).all(alike), "case {case}: {found:?}, {expected:?}");
            fronts += u32::from(found.len() > 1);
        }
        other += u32::from(
            free.is_some_and(|free| !close(free.1[0], tried.best(&Objective::of(Amount::Hops), &Budgets::NONE).unwrap().1[0])),
        );
    }
    let counts = format!("{compared} compared, {bounded} bounded, {other} others, {missions} missions, {fronts} fronts");
    assert!(compared > 80 && bounded > 15 && missions > 10 && fronts > 8, "{counts}");
}
