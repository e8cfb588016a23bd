//! What the best missions from a start to every node take, or from every node back to a start.

use super::{
    super::{
        Amount, Objective, RouteError, SurfaceNode, SurfaceNodes,
        labels::{NONE, Tracked},
        search::Run,
        surface_hops::{Side, SurfaceHops},
        surface_legs::{LegOffers, Settling},
    },
    MissionQuestion,
    drive_legs::DriveLegs,
    driven::driven,
    kept::Kept,
    legs::TravelLegs,
};
use crate::{
    ballistics::TakeoffChoice,
    drive::DriveGround,
    ground::{DemGround, MapPosition},
    progress::{Meter, Progress, Stage},
};

/// Which way the missions of a field lead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Toward {
    /// From the nearest start to every node.
    Nodes,
    /// From every node back to the nearest start, over the reversed graph: limits up, down and across differ, and so do both fields.
    Start,
}

/// The least totals of the best missions, by node.
#[derive(Clone, Debug, PartialEq)]
pub struct TravelField {
    /// The amounts whose totals are known: those of the objective, filled up with mission time, hops, energy and distance.
    amounts: Vec<Amount>,
    /// For each node as many totals; NaN without a mission.
    totals: Vec<f64>,
    /// Whether labels were left out.
    pub capped: bool,
}

impl TravelField {
    /// The amounts of the field of an objective: its own, then mission time, hops, energy and distance as far as there is room.
    pub fn objective(objective: &Objective) -> Objective {
        let more = [Amount::MissionTime, Amount::Hops, Amount::Energy, Amount::Distance];
        let more = more.into_iter().filter(|amount| !objective.amounts().contains(amount));
        // An amount that does not add up stays last, and alone.
        let room = if objective.amounts().iter().all(|amount| amount.adds_up()) { Objective::MOST } else { 0 };
        let all = objective.amounts().iter().copied().chain(more).take(room.max(objective.amounts().len())).collect();
        Objective::new(all).unwrap_or_else(|_| objective.clone())
    }

    /// The amounts whose totals are known.
    pub fn amounts(&self) -> &[Amount] {
        &self.amounts
    }

    /// The total of an amount for a node; `None` without a mission, or where the amount is not known.
    pub fn total(&self, node: SurfaceNode, amount: Amount) -> Option<f64> {
        let at = self.amounts.iter().position(|known| *known == amount)?;
        self.totals.get(node.index() * self.amounts.len() + at).copied().filter(|total| !total.is_nan())
    }

    /// Whether a mission leads to a node, or back from it.
    pub fn is_reached(&self, node: SurfaceNode) -> bool {
        self.total(node, self.amounts[0]).is_some()
    }
}

/// Finds the best missions between some starts and all nodes by an objective, within budgets. `takeoff`: the choice of take-off angle of hops
/// that offer no others.
///
/// A landing is followed by the time to settle, except at a single start where the missions end. Starts without ground are left out.
///
/// # Errors
/// [`RouteError`].
///
/// # Complexity
/// As [`travel`](super::travel) without a goal. Where a machine only drives between posts, without a price of turns and without budgets, and
/// mission time comes first: that of a [`DriveMap`](crate::drive::DriveMap).
pub fn travel_field(
    (ground, nodes): (&DemGround, &SurfaceNodes),
    starts: &[SurfaceNode],
    (question, takeoff, toward): (&MissionQuestion<'_>, TakeoffChoice, Toward),
    progress: &dyn Progress,
) -> Result<TravelField, RouteError> {
    let surface = SurfaceHops::new(ground, nodes);
    let meter = Meter::new(progress, Stage::Search);
    let starts: Vec<(SurfaceNode, MapPosition)> =
        starts.iter().filter_map(|node| Some((*node, nodes.position(ground, *node)?))).collect();
    let objective = TravelField::objective(question.route.objective);
    let amounts = objective.amounts().to_vec();
    let mut field = TravelField { totals: vec![f64::NAN; nodes.count() * amounts.len()], amounts, capped: false };
    let Some(first) = starts.first() else { return Ok(field) };
    if let Some(totals) = driven((ground, nodes), &starts, question, (&field.amounts, toward), progress)? {
        return Ok(TravelField { totals, ..field });
    }
    let (side, settling) = match toward {
        Toward::Nodes => (Side::Start, Settling::AfterAll),
        // Of several starts, where a mission may end, none is spared.
        Toward::Start if starts.len() > 1 => (Side::Goal, Settling::AfterAll),
        Toward::Start => (Side::Goal, Settling::AfterAllBut(first.1.at)),
    };
    let offered = (question.route.commands, takeoff);
    let kept = Kept::of((ground, nodes), question, (None, question.comes_again()));
    let offers = || LegOffers::new(&surface, settling, offered, question.route.errors).by_tables(kept.tables.as_ref());
    let hops = question.travel.hops().then(offers);
    let wheels = question.travel.drives().then(|| DriveGround::new(ground, question.rover));
    let edges = kept.edges(wheels.as_ref(), progress)?;
    let drive = wheels.as_ref().map(|wheels| DriveLegs::new(wheels, nodes, edges.as_ref()));
    let by = (hops.as_ref(), drive.as_ref());
    let legs = TravelLegs::new((ground, nodes), by, (side, *first, None), kept.pairs_bytes, &meter);
    let mut run = Run::new(&legs, legs.ends(), Tracked::new(&objective, question.route.budgets), question.route.cap);
    starts[1..].iter().for_each(|(node, _)| run.also_from(node.index()));
    run.until(false)?;
    let width = field.amounts.len();
    for state in 0..legs.ends().1 {
        for label in run.labels.of_node(state).filter(|label| *label != NONE) {
            let totals = &run.labels.totals(label)[..width];
            let best = &mut field.totals[legs.node_of(state).index() * width..][..width];
            if best[0].is_nan() || super::super::labels::by_objective(totals, best).is_lt() {
                best.copy_from_slice(totals);
            }
        }
    }
    field.capped = run.labels.capped;
    Ok(field)
}
