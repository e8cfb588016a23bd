//! Missions through stops in the shade: the ways that are searched one after the other against all ways of all legs at once.

use super::{
    super::{Budgets, LabelCap, Objective, SearchedCommands},
    legs::{LegQuestion, StopLegs},
    table::{VisitRules, most_visits},
    within::best_within,
    *,
};
use crate::{
    draw::Draw,
    graph::Effort,
    ground::DemGround,
    planner::{Amount, NodesPerPost, SurfaceLattice},
    terrain::{Dem, GeoReference, LayerCondition, LayerRule, MapLayers, OutageLimit, OverlaidDem, Overlays, read_layer},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, LayerName, RestSlope, SurfaceProperties},
};

/// A side of the random maps, in posts.
const SIDE: u32 = 11;

fn post(draw: &mut Draw) -> MapPoint {
    let mut number = || f64::from(u32::try_from(draw.below(SIDE as usize)).unwrap());
    MapPoint::new(number(), number())
}

/// A map with some relief, and with shade within some distance of places, which may be crossed for a while.
fn ground(draw: &mut Draw, side: u32, shade: &[(MapPoint, f64)], outage: Option<OutageLimit>) -> DemGround {
    let heights = (0..side * side).map(|_| draw.uniform(0.0, 0.4)).collect();
    let top = MapPoint::new(0.0, f64::from(side - 1));
    let dem = Dem::new(side as usize, side as usize, heights, GeoReference::local(top, 1.0, 1.0).unwrap()).unwrap();
    let cell = |row: u32, col: u32| {
        let at = MapPoint::new(f64::from(col), f64::from(side - 1 - row));
        if shade.iter().any(|(centre, radius_m)| (at - *centre).norm() <= *radius_m) { "0" } else { "1" }
    };
    let rows = (0..side).map(|row| (0..side).map(|col| cell(row, col)).collect::<Vec<_>>().join(" ")).collect::<Vec<_>>();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("light.asc");
    let head = format!("ncols {side}\nnrows {side}\nxllcenter 0\nyllcenter 0\ncellsize 1\n");
    std::fs::write(&file, format!("{head}{}\n", rows.join("\n"))).unwrap();
    let of_sun = |limit| LayerRule {
        name: LayerName::new("sun").unwrap(),
        condition: LayerCondition { equals: Some(1.0), ..LayerCondition::default() },
        on_contact: true,
        on_flight: false,
        outage: Some(limit),
        cost: None,
    };
    let layers = MapLayers::new(outage.into_iter().map(|limit| read_layer(&file, of_sun(limit), None).unwrap()).collect());
    let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(1.0).unwrap())), rest: RestSlope::Unlimited };
    let limits = HopperLimits { settling_time_s: Some(0.7), preparation_time_s: Some(0.2), ..HopperLimits::with_speeds(2.2, 2.2) };
    let overlaid = OverlaidDem::new(dem, Overlays::default().with_layers(layers));
    DemGround::new(overlaid, &Hopper::new(limits).unwrap(), Gravity::new(2.1).unwrap(), &surface)
}

fn nodes(ground: &DemGround, stops: &[MapPoint]) -> SurfaceNodes {
    let lattice = SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::of(1));
    SurfaceNodes::new(ground, lattice, stops.iter().copied()).unwrap()
}

#[test]
fn ways_searched_one_after_the_other_make_the_mission_of_all_ways() {
    let draw = &mut Draw::seeded(2131);
    let (mut whole, mut in_part, mut joined, mut others) = (0, 0, 0, 0);
    for case in 0..36 {
        let stops: Vec<MapPoint> = (0..3 + draw.below(2)).map(|_| post(draw)).collect();
        let shade: Vec<(MapPoint, f64)> = stops[1..].iter().map(|target| (*target, draw.uniform(0.4, 2.4))).collect();
        let of_time = draw.chance(0.7);
        let limit = OutageLimit {
            max_s: of_time.then(|| draw.uniform(4.0, 14.0)),
            hops_max: (!of_time || draw.chance(0.3)).then(|| 2 + u32::try_from(draw.below(4)).unwrap()),
            exempt_targets: false,
        };
        let ground = ground(draw, SIDE, &shade, Some(limit));
        if stops.iter().enumerate().any(|(number, at)| stops[..number].contains(at)) {
            continue;
        }
        let nodes = nodes(&ground, &stops);
        let objective =
            if draw.chance(0.5) { Objective::hops_then(Effort::TakeoffSpeed) } else { Objective::of(Amount::MissionTime) };
        let (commands, cap) = (SearchedCommands::Chosen, LabelCap::default());
        let route = RouteQuestion { objective: &objective, budgets: &Budgets::NONE, commands, errors: None, cap };
        let (order, returns, takeoff) = (VisitOrder::Best, draw.chance(0.5), TakeoffChoice::LeastSpeed);
        let question = TourQuestion { route, effort: Effort::TakeoffSpeed, takeoff, order, returns };
        let legs = StopLegs::new(&ground, &nodes, &stops, &()).unwrap();
        let fields = legs.fields(&question).unwrap();
        let found = best_within(&legs, &question, &fields).unwrap();
        let all = legs.legs(&question, &fields, |_| Some(LegQuestion::best(&objective).by_outages())).unwrap();
        let rules = VisitRules { order, returns, allowed: u16::MAX };
        let best = |costs| most_visits(&costs, rules, (&objective, &Budgets::NONE, cap)).unwrap();
        let (expected, is_capped) = best(all.costs());
        assert!(!is_capped && !all.capped && !found.capped, "case {case}");
        assert_eq!(found.visits.set().count_ones(), expected.set().count_ones(), "case {case}: {objective}");
        for amount in objective.amounts() {
            let [known, least] = [&found.visits, &expected].map(|visits| visits.totals.of(*amount));
            assert!((known - least).abs() <= 1e-9 * (1.0 + least), "case {case}: {amount}: {known}, {least}");
        }
        let first = objective.first();
        let (apart, _) = best(all.costs().apart());
        let is_whole = expected.set().count_ones() as usize + 1 == stops.len();
        whole += u32::from(is_whole);
        in_part += u32::from(!is_whole && expected.set() > 0);
        let is_alike = apart.set().count_ones() == expected.set().count_ones();
        joined += u32::from(is_alike && apart.totals.of(first) >= expected.totals.of(first));
        others += u32::from(!is_alike || apart.totals.of(first) < expected.totals.of(first));
    }
    let counts = format!("{whole} whole, {in_part} in part; {joined} of the best legs, {others} of others");
    assert!(whole > 8 && in_part > 2 && joined > 5 && others > 5, "{counts}");
}

/// What a search costs is what it looks at: with all ways of all legs, pairs of the whole map many times over.
#[test]
fn stops_in_the_shade_cost_few_more_pairs() {
    let at = |x, y| MapPoint::new(x, y);
    let stops = [at(3.0, 3.0), at(22.0, 6.0), at(8.0, 21.0)];
    let shade: Vec<(MapPoint, f64)> = stops[1..].iter().map(|target| (*target, 3.2)).collect();
    let objective = Objective::hops_then(Effort::TakeoffSpeed);
    let (commands, cap) = (SearchedCommands::Chosen, LabelCap::default());
    let route = RouteQuestion { objective: &objective, budgets: &Budgets::NONE, commands, errors: None, cap };
    let takeoff = TakeoffChoice::LeastSpeed;
    let question = TourQuestion { route, effort: Effort::TakeoffSpeed, takeoff, order: VisitOrder::Best, returns: false };
    let found = |outage: Option<u32>| {
        let limit = outage.map(|hops| OutageLimit { max_s: None, hops_max: Some(hops), exempt_targets: false });
        let ground = ground(&mut Draw::seeded(2132), 27, &shade, limit);
        tour(&ground, &nodes(&ground, &stops), &stops, &question, &()).unwrap()
    };
    let lit = found(None);
    assert!(lit.left_out.is_empty());
    let mut kept = Vec::new();
    for hops in [3, 4, 5, 12] {
        let through = found(Some(hops));
        let ratio = through.work.pairs_tested / lit.work.pairs_tested;
        assert!(ratio < 20, "{hops} hops: {} and {} pairs", through.work.pairs_tested, lit.work.pairs_tested);
        let more_hops = through.totals.of(Amount::Hops) - lit.totals.of(Amount::Hops);
        assert!(more_hops >= 0.0 || !through.left_out.is_empty(), "{hops} hops: {more_hops} more in all");
        kept.push(through.left_out.len());
    }
    assert!(kept.contains(&0) && kept.iter().any(|count| *count > 0), "{kept:?}");
}
