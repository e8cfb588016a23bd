//! Missions against free routes, against a plain Dijkstra over all pairs, and both ways.

use nalgebra::Vector2;

use super::{super::*, *};
use crate::{
    ballistics::TakeoffChoice,
    draw::Draw,
    drive::DriveGround,
    graph::Effort,
    ground::{DemGround, MapPosition, Surface},
    planner::search::LabelCap,
    quantity::{Angle, MapPoint},
    terrain::{Dem, GeoReference, OverlaidDem, Overlays},
    world::{
        FrictionCone, Gravity, Grip, Hopper, HopperLimits, Neighbours, RestSlope, Rover, RoverLimits, SlipCurve, SurfaceProperties,
    },
};

mod kept;

struct World {
    ground: DemGround,
    nodes: SurfaceNodes,
    ends: [MapPoint; 2],
    rover: Rover,
}

/// A rough ground with gaps, two places on it, and a machine whose hops take a while to prepare; `None` where a draw has no such places.
fn world(draw: &mut Draw, turn_s_per_deg: f64) -> Option<World> {
    let side = 6;
    let relief_m = draw.log_uniform(0.05, 1.0);
    let heights = (0..side * side).map(|_| if draw.chance(0.05) { f64::NAN } else { draw.uniform(0.0, relief_m) }).collect();
    let dem = Dem::new(side, side, heights, GeoReference::local(MapPoint::new(3.0, 40.0), 1.0, 1.3).ok()?).ok()?;
    let grip = Some(Grip::Friction(FrictionCone::new(draw.uniform(0.5, 1.5)).ok()?));
    let surface = SurfaceProperties { grip, rest: RestSlope::Unlimited };
    let limits = HopperLimits {
        preparation_time_s: Some(draw.uniform(0.0, 20.0)),
        settling_time_s: Some(draw.uniform(0.0, 5.0)),
        mass_kg: Some(5.0),
        ..HopperLimits::with_speeds(2.5, 2.5)
    };
    let gravity = Gravity::new(draw.log_uniform(1.5, 4.0)).ok()?;
    let ground = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &Hopper::new(limits).ok()?, gravity, &surface);
    let bounds = ground.terrain().dem().bounds();
    let ends = [0, 1].map(|_| MapPoint::new(draw.uniform(bounds.min.x, bounds.max.x), draw.uniform(bounds.min.y, bounds.max.y)));
    ends.iter().all(|at| ground.position(*at).is_some()).then_some(())?;
    let lattice = SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::of(1 + draw.below(2)));
    let nodes = SurfaceNodes::new(&ground, lattice, ends).ok()?;
    let limits = RoverLimits {
        slope_down_max: Some(Angle::from_degrees(draw.uniform(10.0, 60.0))),
        neighbours: Neighbours::ALL[draw.below(3)],
        turn_s_per_deg,
        rolling_resistance: 0.1,
        idle_power_w: 3.0,
        slip: SlipCurve::new(&[[0.0, 0.0], [30.0, 0.6]]).ok()?,
        failure_per_m: 1e-3,
        ..RoverLimits::new(draw.log_uniform(0.02, 0.5), Angle::from_degrees(draw.uniform(10.0, 60.0)))
    };
    Some(World { ground, nodes, ends, rover: Rover::new(limits, Some(5.0)).ok()? })
}

fn objective(amounts: &[Amount]) -> Objective {
    Objective::new(amounts.to_vec()).unwrap()
}

impl World {
    fn question<'q>(&'q self, objective: &'q Objective, budgets: &'q Budgets, means: Travel) -> MissionQuestion<'q> {
        let route =
            RouteQuestion { objective, budgets, commands: SearchedCommands::Distinct, errors: None, cap: LabelCap::default() };
        MissionQuestion { route, rover: &self.rover, travel: means, kept_bytes_max: MissionQuestion::KEPT_BYTES }
    }

    fn goal([start, goal]: [MapPoint; 2]) -> RouteGoal {
        RouteGoal { start, goal, effort: Effort::default(), takeoff: TakeoffChoice::LeastTime }
    }

    fn best(&self, amounts: &[Amount], means: Travel, ends: [MapPoint; 2]) -> Mission {
        let objective = objective(amounts);
        travel(&self.ground, &self.nodes, &Self::goal(ends), &self.question(&objective, &Budgets::NONE, means), &()).unwrap()
    }

    fn total(&self, amounts: &[Amount], means: Travel) -> Option<f64> {
        self.best(amounts, means, self.ends).path.map(|path| path.totals.of(amounts[0]))
    }

    fn with(&self, change: impl FnOnce(&mut RoverLimits)) -> Self {
        let mut limits = self.rover.limits().clone();
        change(&mut limits);
        let rover = Rover::new(limits, Some(5.0)).unwrap();
        Self { ground: self.ground.clone(), nodes: self.nodes.clone(), ends: self.ends, rover }
    }

    /// The places of all nodes.
    fn positions(&self) -> Vec<Option<MapPosition>> {
        (0..self.nodes.count()).map(|node| self.nodes.position(&self.ground, SurfaceNode::of_index(node))).collect()
    }

    /// Which straight lines there are, by the words of the documentation: to the neighbours of a node of the lattice, and between a place
    /// and all nodes in a square of two spacings about it.
    fn is_line(&self, [from, to]: [usize; 2], [here, there]: [&MapPosition; 2]) -> bool {
        let lattice = self.nodes.lattice();
        if from < lattice.count() && to < lattice.count() {
            let ((i, j), (k, l)) = (lattice.node(from), lattice.node(to));
            #[expect(clippy::cast_possible_wrap, clippy::cast_possible_truncation, reason = "small lattices")]
            let away = (k as i32 - i as i32, j as i32 - l as i32);
            return self.rover.limits().neighbours.offsets().contains(&away);
        }
        from != to && (there.at - here.at).amax() <= 2.0 * lattice.spacing_m()
    }

    /// The least mission time by driving alone, by settling all states in turn: a state is a node with the node before it.
    fn by_plain_dijkstra(&self) -> Option<f64> {
        let positions = self.positions();
        let drive = DriveGround::new(&self.ground, &self.rover);
        let [start, goal] = self.ends.map(|at| self.nodes.place(at).unwrap().index());
        let turns = self.rover.limits().turn_s_per_deg > 0.0;
        let mut legs = Vec::new();
        for (from, here) in positions.iter().enumerate() {
            for (to, there) in positions.iter().enumerate() {
                let (Some(here), Some(there)) = (here, there) else { continue };
                // With turning the search drives from and to places at the ends alone.
                let beside = [from, to].into_iter().any(|node| node >= self.nodes.lattice().count());
                if turns && beside && from != start && to != goal {
                    continue;
                }
                if self.is_line([from, to], [here, there])
                    && let Ok(leg) = drive.leg(here, there)
                {
                    legs.push(([from, to], leg.time_s, there.at - here.at));
                }
            }
        }
        let turn_s = |before: &Vector2<f64>, after: &Vector2<f64>| {
            let chord = (before.normalize() - after.normalize()).norm();
            self.rover.limits().turn_s_per_deg * (2.0 * libm::asin((0.5 * chord).min(1.0))).to_degrees()
        };
        // One state for each leg: it has just been driven.
        let mut least = vec![f64::INFINITY; legs.len()];
        let mut settled = vec![false; legs.len()];
        for (state, ([from, _], time_s, _)) in legs.iter().enumerate() {
            if *from == start {
                least[state] = *time_s;
            }
        }
        loop {
            let next = (0..legs.len()).filter(|state| !settled[*state]).min_by(|a, b| least[*a].total_cmp(&least[*b]))?;
            if least[next].is_infinite() {
                return None;
            }
            let ([_, at], _, before) = &legs[next];
            if *at == goal {
                return Some(least[next]);
            }
            settled[next] = true;
            for (state, ([from, _], time_s, after)) in legs.iter().enumerate() {
                if from == at {
                    let turned_s = if turns { turn_s(before, after) } else { 0.0 };
                    least[state] = least[state].min(least[next] + turned_s + time_s);
                }
            }
        }
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * (1.0 + a.abs().max(b.abs()))
}

#[test]
fn driving_alone_equals_a_plain_dijkstra_with_and_without_turns() {
    let draw = &mut Draw::seeded(1901);
    for turn_s_per_deg in [0.0, 0.3] {
        let mut found = 0;
        for case in 0..40 {
            let Some(world) = world(draw, turn_s_per_deg) else { continue };
            let best = world.total(&[Amount::MissionTime], Travel::Drive);
            let plain = world.by_plain_dijkstra();
            assert_eq!(best.is_some(), plain.is_some(), "case {case}, {turn_s_per_deg} s/deg");
            if let (Some(best), Some(plain)) = (best, plain) {
                assert!(close(best, plain), "case {case}, {turn_s_per_deg} s/deg: {best} s, plainly {plain} s");
                found += 1;
            }
        }
        assert!(found > 8, "only {found} missions");
    }
}

#[test]
fn hops_alone_are_those_of_free_routes() {
    let draw = &mut Draw::seeded(1902);
    let mut found = 0;
    for case in 0..60 {
        let Some(world) = world(draw, 0.0) else { continue };
        for amounts in [&[Amount::MissionTime][..], &[Amount::Hops, Amount::Energy], &[Amount::Distance]] {
            let objective = objective(amounts);
            let question = world.question(&objective, &Budgets::NONE, Travel::Hop);
            let mission = world.best(amounts, Travel::Hop, world.ends);
            let route = free_route_by(&world.ground, &world.nodes, &World::goal(world.ends), &question.route, &()).unwrap();
            assert_eq!(mission.path.is_some(), route.path.is_some(), "case {case}");
            let (Some(mission), Some(route)) = (mission.path, route.path) else { continue };
            for amount in amounts {
                let [a, b] = [mission.totals.of(*amount), route.totals.of(*amount)];
                assert!(close(a, b), "case {case}: {amount} {a} by missions, {b} by routes");
            }
            assert!(mission.moves.iter().all(|each| matches!(each, MissionMove::Hop(_))));
            found += 1;
        }
    }
    assert!(found > 30, "only {found} missions");
}

#[test]
fn more_means_neighbours_and_room_are_never_worse() {
    let draw = &mut Draw::seeded(1903);
    let no_worse = |better: Option<f64>, than: Option<f64>| match (better, than) {
        (_, None) => true,
        (None, Some(_)) => false,
        (Some(better), Some(than)) => better <= than * (1.0 + 1e-12),
    };
    let mut mixed = 0;
    for case in 0..150 {
        let Some(world) = world(draw, 0.0) else { continue };
        for amount in [Amount::MissionTime, Amount::Energy] {
            let [both, drive, hop] = [Travel::Both, Travel::Drive, Travel::Hop].map(|means| world.total(&[amount], means));
            assert!(no_worse(both, drive) && no_worse(both, hop), "case {case}, {amount}: {both:?}, {drive:?}, {hop:?}");
            let looser = world.with(|limits| {
                limits.slope_up_max = Angle::from_degrees(limits.slope_up_max.degrees() + 8.0);
                limits.cross_slope_max = limits.slope_down_max.map(|_| Angle::from_degrees(80.0));
            });
            let looser = looser.total(&[amount], Travel::Both);
            // A cross-slope limit that was that of climbs is wider now too.
            assert!(no_worse(looser, both), "case {case}, {amount}: {looser:?} with looser limits, {both:?}");
            let by_count =
                Neighbours::ALL.map(|count| world.with(|limits| limits.neighbours = count).total(&[amount], Travel::Drive));
            assert!(no_worse(by_count[1], by_count[0]) && no_worse(by_count[2], by_count[1]), "case {case}: {by_count:?}");
        }
        let mission = world.best(&[Amount::MissionTime], Travel::Both, world.ends);
        let moves = mission.path.map(|path| path.moves).unwrap_or_default();
        let drives = moves.iter().filter(|each| matches!(each, MissionMove::Drive)).count();
        mixed += u32::from(drives > 0 && drives < moves.len());
    }
    assert!(mixed > 3, "{mixed} mixed missions");
}

/// A ramp on which nothing rests but wheels climb, a shelf, and a step that only hops pass.
#[test]
fn driving_and_hops_together_pass_what_neither_passes_alone() {
    let heights = [0.0, 0.6, 1.2, 1.2, 1.2, 2.4, 2.4, 2.4].repeat(6);
    let dem = Dem::new(6, 8, heights, GeoReference::local(MapPoint::new(0.0, 5.0), 1.0, 1.0).unwrap()).unwrap();
    let grip = Some(Grip::Friction(FrictionCone::new(0.8).unwrap()));
    let surface = SurfaceProperties { grip, rest: RestSlope::AtMost(Angle::from_degrees(20.0)) };
    let hopper = Hopper::with_speeds(5.0, 5.0).unwrap();
    let ground = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, Gravity::new(3.7).unwrap(), &surface);
    let ends = [MapPoint::new(0.5, 2.5), MapPoint::new(6.5, 2.5)];
    let nodes = SurfaceNodes::new(&ground, SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::of(1)), ends).unwrap();
    let rover = Rover::new(RoverLimits::new(0.1, Angle::from_degrees(35.0)), None).unwrap();
    let world = World { ground, nodes, ends, rover };
    let found = [Travel::Drive, Travel::Hop, Travel::Both].map(|means| world.best(&[Amount::MissionTime], means, ends));
    assert!(found[0].path.is_none() && found[1].path.is_none());
    let moves = found[2].path.as_ref().unwrap().moves.clone();
    assert!(
        moves.first() == Some(&MissionMove::Drive) && moves.iter().any(|each| matches!(each, MissionMove::Hop(_))),
        "{moves:?}"
    );
    // What keeps the wheels from the shelf's far side is the step.
    let (nearest, refusals) = found[0].stopped.unwrap();
    assert!(nearest.at.x <= 4.0 && refusals.ranked()[0].0 == crate::drive::DriveLimit::SlopeUp, "{nearest:?} {refusals:?}");
}

#[test]
fn without_slopes_to_tell_both_ways_apart_a_way_back_takes_the_same() {
    let draw = &mut Draw::seeded(1904);
    let mut found = 0;
    for case in 0..60 {
        let Some(world) = world(draw, 0.1) else { continue };
        let same = world.with(|limits| limits.slope_down_max = None);
        let [there, back] = [same.ends, [same.ends[1], same.ends[0]]].map(|ends| {
            same.best(&[Amount::MissionTime], Travel::Drive, ends).path.map(|path| path.totals.of(Amount::MissionTime))
        });
        match (there, back) {
            (Some(there), Some(back)) => {
                assert!(close(there, back), "case {case}: {there} s there, {back} s back");
                found += 1;
            }
            other => assert_eq!(other, (None, None), "case {case}"),
        }
    }
    assert!(found > 10, "only {found} missions");
}

/// The field from a node, and that back to it over the reversed graph, against single missions.
#[test]
fn fields_equal_single_missions_both_ways() {
    let draw = &mut Draw::seeded(1905);
    let mut found = [0; 2];
    for case in 0..14 {
        let Some(world) = world(draw, 0.0) else { continue };
        let objective = objective(&[Amount::MissionTime]);
        let start = world.nodes.place(world.ends[0]).unwrap();
        for means in [Travel::Drive, Travel::Both] {
            let question = world.question(&objective, &Budgets::NONE, means);
            let field = |toward| {
                let asked = (&question, TakeoffChoice::LeastTime, toward);
                travel_field((&world.ground, &world.nodes), &[start], asked, &()).unwrap()
            };
            let fields = [field(Toward::Nodes), field(Toward::Start)];
            let goal = world.nodes.place(world.ends[1]).unwrap();
            for (number, field) in fields.iter().enumerate() {
                let ends = if number == 0 { world.ends } else { [world.ends[1], world.ends[0]] };
                let mission = world.best(&[Amount::MissionTime], means, ends).path;
                let total = field.total(goal, Amount::MissionTime);
                assert_eq!(mission.is_some(), total.is_some(), "case {case}, {means}");
                let (Some(mission), Some(total)) = (mission, total) else { continue };
                // A field counts the settling after a landing at the node, which a mission that ends there does not have.
                let settles = number == 0 && matches!(mission.moves.last(), Some(MissionMove::Hop(_)));
                let least = mission.totals.of(Amount::MissionTime);
                let settling_s = world.ground.hopper().limits().settling_s().unwrap_or(0.0);
                let holds = if settles { total >= least && total <= least + settling_s + 1e-9 } else { close(total, least) };
                assert!(holds, "case {case}, {means}, {number}: {total} s in the field, {least} s");
                found[number] += 1;
            }
        }
    }
    assert!(found.iter().all(|count| *count > 5), "{found:?}");
}

#[test]
fn budgets_are_kept_or_reported() {
    let draw = &mut Draw::seeded(1906);
    let (mut kept, mut unmet) = (0, 0);
    for case in 0..40 {
        let Some(world) = world(draw, 0.0) else { continue };
        let free = world.best(&[Amount::MissionTime], Travel::Both, world.ends);
        let Some(free) = free.path else { continue };
        let objective = objective(&[Amount::MissionTime]);
        for share in [0.5, 0.9, 1.0] {
            let most = free.totals.of(Amount::Energy) * share;
            let budgets = Budgets::NONE.with(Amount::Energy, most).unwrap();
            let mission = travel(
                &world.ground,
                &world.nodes,
                &World::goal(world.ends),
                &world.question(&objective, &budgets, Travel::Both),
                &(),
            )
            .unwrap();
            let path = mission.path.unwrap();
            if mission.within {
                assert!(path.totals.of(Amount::Energy) <= most * (1.0 + 1e-8), "case {case}");
                assert!(path.totals.of(Amount::MissionTime) >= free.totals.of(Amount::MissionTime) * (1.0 - 1e-12), "case {case}");
                kept += 1;
            } else {
                let least = world.total(&[Amount::Energy], Travel::Both).unwrap();
                assert!(least > most, "case {case}: {least} J/kg would do, {most} are allowed");
                assert!(close(mission.unmet[0].least, least), "case {case}");
                unmet += 1;
            }
        }
    }
    assert!(kept > 10 && unmet > 5, "{kept} kept, {unmet} unmet");
}

#[test]
fn a_front_has_the_best_within_every_number_of_hops() {
    let draw = &mut Draw::seeded(1907);
    let mut rows = 0;
    for case in 0..30 {
        let Some(world) = world(draw, [0.0, 0.05][case % 2]) else { continue };
        for amount in [Amount::MissionTime, Amount::Energy, Amount::Distance] {
            let objective = objective(&[amount]);
            let question = world.question(&objective, &Budgets::NONE, Travel::Both);
            let goal = World::goal(world.ends);
            let front = front_of_missions(&world.ground, &world.nodes, &goal, (amount, &question), &()).unwrap();
            let row = |path: &MissionPath| (path.totals.of(Amount::Hops), path.totals.of(amount));
            let front: Vec<(f64, f64)> = front.paths.iter().map(row).collect();
            rows += front.len();
            assert!(front.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 > pair[1].1), "case {case}: {front:?}");
            let most = front.last().map_or(2.0, |last| last.0 + 1.0);
            let mut hops = 0.0;
            while hops <= most {
                let budgets = Budgets::NONE.with(Amount::Hops, hops).unwrap();
                let within = travel(&world.ground, &world.nodes, &goal, &world.question(&objective, &budgets, Travel::Both), &());
                let best = within.unwrap();
                let best = best.path.filter(|_| best.within).map(|path| path.totals.of(amount));
                let of_front = front.iter().rfind(|row| row.0 <= hops).map(|row| row.1);
                assert_eq!(best.is_some(), of_front.is_some(), "case {case}: {hops} hops");
                assert!(best.zip(of_front).is_none_or(|(a, b)| close(a, b)), "case {case}: {hops} hops: {best:?}, {of_front:?}");
                hops += 1.0;
            }
        }
    }
    assert!(rows > 80, "{rows}");
}
