//! Fields of driving alone between posts, from drive maps.

use super::{
    super::{Amount, Budgets, RouteError, SurfaceNode, SurfaceNodes, labels::by_objective},
    MissionQuestion, Toward,
    drive_legs::drive_amounts,
};
use crate::{
    drive::{DriveAmount, DriveEdges, DriveError, DriveGround, DriveMap, DriveSense},
    ground::{DemGround, MapPosition, NodeLattice},
    progress::Progress,
    world::Rover,
};

/// The totals of these amounts for every node, NaN without a mission; `None` where the question is another one than a drive map answers: it
/// may hop, turns have a price, there are budgets, mission time does not come first, or nodes are not the posts alone.
///
/// Of ways of the same time, as numbers, the one counts whose further amounts are less, in their order.
pub(super) fn driven(
    (ground, nodes): (&DemGround, &SurfaceNodes),
    starts: &[(SurfaceNode, MapPosition)],
    question: &MissionQuestion<'_>,
    (amounts, toward): (&[Amount], Toward),
    progress: &dyn Progress,
) -> Result<Option<Vec<f64>>, RouteError> {
    let lattice = NodeLattice::new(ground.terrain().dem(), 1);
    let of_posts = nodes.lattice().nodes_per_post() == 1 && nodes.count() == lattice.count();
    let plain =
        !question.travel.hops() && question.rover.limits().turn_s_per_deg == 0.0 && *question.route.budgets == Budgets::NONE;
    let adds_up = amounts.first() == Some(&Amount::MissionTime) && amounts.iter().all(|amount| amount.adds_up());
    if !(of_posts && plain && adds_up) {
        return Ok(None);
    }
    let drive = DriveGround::new(ground, question.rover);
    let ends: Vec<usize> = starts.iter().map(|(node, _)| node.index()).collect();
    let sense = match toward {
        Toward::Nodes => DriveSense::From,
        Toward::Start => DriveSense::To,
    };
    let edges = match DriveEdges::new(&drive, lattice, DriveAmount::Time, progress) {
        Ok(edges) => edges,
        Err(error) => return unless_cancelled(&error),
    };
    let map = match DriveMap::new(&edges, &ends, sense, progress) {
        Ok(map) => map,
        Err(error) => return unless_cancelled(&error),
    };
    Ok(totals(&edges, (&map, &ends), (question.rover, amounts)))
}

/// A map too large for a drive map is left to the search.
fn unless_cancelled<T>(error: &DriveError) -> Result<Option<T>, RouteError> {
    match error {
        DriveError::Cancelled(cancelled) => Err(RouteError::Cancelled(*cancelled)),
        _ => Ok(None),
    }
}

/// The totals of all amounts along the quickest ways: node after node by time, over the legs that set its time. `None` if a leg takes no time
/// beside the time before it, so that this is no order of travel.
fn totals(edges: &DriveEdges<'_>, (map, ends): (&DriveMap, &[usize]), (rover, amounts): (&Rover, &[Amount])) -> Option<Vec<f64>> {
    let (costs, width) = (map.costs(), amounts.len());
    let mut order: Vec<usize> = (0..costs.len()).filter(|node| costs[*node].is_finite()).collect();
    order.sort_unstable_by(|a, b| costs[*a].total_cmp(&costs[*b]).then(a.cmp(b)));
    let into;
    let masks: &dyn Fn(usize) -> u32 = match map.sense() {
        DriveSense::From => {
            into = edges.masks_into();
            &|node| into[node]
        }
        DriveSense::To => &|node| edges.directions(node),
    };
    let mut totals = vec![f64::NAN; costs.len() * width];
    for end in ends {
        totals[end * width..][..width].fill(0.0);
    }
    let (mut best, mut found) = (vec![0.0; width], vec![0.0; width]);
    for node in order {
        if costs[node] == 0.0 {
            continue;
        }
        best.fill(f64::INFINITY);
        for direction in (0..edges.offsets().len()).filter(|direction| masks(node) >> direction & 1 == 1) {
            // The node before on the way, and the one from which the leg begins.
            let (before, begin) = match map.sense() {
                DriveSense::From => (edges.behind(node, direction), edges.behind(node, direction)),
                DriveSense::To => (edges.neighbour(node, direction), node),
            };
            let sets_it = costs[before] < costs[node] && costs[before] + edges.cost(begin, direction) == costs[node];
            let Some(leg) = edges.sums(begin, direction).filter(|_| sets_it) else { continue };
            let taken = drive_amounts(rover, &leg, 0.0);
            for ((found, amount), sum) in found.iter_mut().zip(amounts).zip(&totals[before * width..]) {
                *found = sum + taken.of(*amount);
            }
            found[0] = costs[node];
            if by_objective(&found, &best).is_lt() {
                best.copy_from_slice(&found);
            }
        }
        best[0].is_finite().then_some(())?;
        totals[node * width..][..width].copy_from_slice(&best);
    }
    Some(totals)
}

#[cfg(test)]
mod tests {
    use super::{
        super::{super::*, Travel, travel_field},
        *,
    };
    use crate::{
        ballistics::TakeoffChoice,
        draw::Draw,
        planner::search::LabelCap,
        quantity::{Angle, MapPoint},
        terrain::{Dem, GeoReference, OverlaidDem, Overlays},
        world::{Gravity, Hopper, Neighbours, RestSlope, Rover, RoverLimits, SlipCurve, SurfaceProperties},
    };

    /// A budget that binds nobody sends the same question to the search: the totals of all amounts are the same.
    #[test]
    fn fields_from_drive_maps_are_those_of_the_search() {
        let draw = &mut Draw::seeded(1910);
        let (mut reached, mut cut_off) = (0, 0);
        for _ in 0..24 {
            let relief_m = draw.log_uniform(0.1, 1.5);
            let heights = (0..72).map(|_| if draw.chance(0.06) { f64::NAN } else { draw.uniform(0.0, relief_m) }).collect();
            let map = GeoReference::local(MapPoint::new(3.0, 40.0), 1.0, 1.3).unwrap();
            let terrain = OverlaidDem::new(Dem::new(8, 9, heights, map).unwrap(), Overlays::default());
            let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
            let gravity = Gravity::new(draw.log_uniform(1e-3, 20.0)).unwrap();
            let ground = DemGround::new(terrain, &Hopper::with_speeds(1.0, 1.0).unwrap(), gravity, &surface);
            let limits = RoverLimits {
                slope_down_max: Some(Angle::from_degrees(draw.uniform(10.0, 60.0))),
                neighbours: Neighbours::ALL[draw.below(3)],
                rolling_resistance: 0.1,
                idle_power_w: 3.0,
                slip: SlipCurve::new(&[[0.0, 0.0], [30.0, 0.6]]).unwrap(),
                failure_per_m: 1e-3,
                ..RoverLimits::new(draw.log_uniform(0.02, 0.5), Angle::from_degrees(draw.uniform(10.0, 60.0)))
            };
            let rover = Rover::new(limits, Some(5.0)).unwrap();
            let lattice = SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::of(1));
            let nodes = SurfaceNodes::new(&ground, lattice, []).unwrap();
            let starts = [draw.below(72), draw.below(72)].map(SurfaceNode::of_index);
            let objective = Objective::new(vec![Amount::MissionTime, Amount::Risk]).unwrap();
            let free = Budgets::NONE.with(Amount::MissionTime, 1e300).unwrap();
            for toward in [Toward::Nodes, Toward::Start] {
                let [fast, searched] = [Budgets::NONE, free].map(|budgets| {
                    let (commands, cap) = (SearchedCommands::Chosen, LabelCap::default());
                    let route = RouteQuestion { objective: &objective, budgets: &budgets, commands, errors: None, cap };
                    let question = MissionQuestion { route, rover: &rover, travel: Travel::Drive, kept_bytes_max: 0 };
                    travel_field((&ground, &nodes), &starts, (&question, TakeoffChoice::LeastTime, toward), &()).unwrap()
                });
                assert_eq!(fast.amounts(), searched.amounts());
                for node in (0..72).map(SurfaceNode::of_index) {
                    for amount in fast.amounts() {
                        match (fast.total(node, *amount), searched.total(node, *amount)) {
                            (Some(fast), Some(searched)) => {
                                assert!((fast - searched).abs() <= 1e-9 * searched, "{amount:?} {fast} {searched}");
                                reached += 1;
                            }
                            (fast, searched) => {
                                assert_eq!(fast, searched, "{amount:?}");
                                cut_off += 1;
                            }
                        }
                    }
                }
            }
        }
        assert!(reached > 5000 && cut_off > 1000, "{reached} reached, {cut_off} cut off");
    }
}
