//! The least capability with which free routes reach a goal over nodes that are the same for every value.

use super::{Case, RequireError, Required, journey_path::JourneyPath, require::Question};
use crate::{
    graph::proof::{CapabilityRange, Threshold},
    progress::{Detail, Meter, Progress, Stage},
    report::{DeratingRecord, HopRecord, RequireAnswer, RequireTry, TotalsRecord},
};

/// A free route at one value.
struct Tried {
    value: f64,
    case: Case,
    route: JourneyPath,
}

impl Tried {
    fn record(&self) -> RequireTry {
        let (verdict, lower_bound) = self.route.verdict();
        RequireTry { value: self.value, verdict, lower_bound, upper_bound: self.route.hops() }
    }
}

/// The least capable value, from the weakest on: over the same nodes a more capable value never takes a hop away, so that the goal is reached
/// from one value on. Values far above it are not tried, whose searches, with many nodes within a hop of each other, take longest.
///
/// # Errors
/// [`RequireError`].
pub(super) fn require_free(
    question: &Question<'_>,
    range: CapabilityRange,
    progress: &dyn Progress,
) -> Result<Required, RequireError> {
    let meter = Meter::new(progress, Stage::Requirement);
    meter.report(Detail::None)?;
    let mut tries: Vec<Tried> = Vec::new();
    let mut threshold = Threshold { unreachable_at: None, reachable_at: None };
    let mut attempt = |threshold: &mut Threshold, value: f64| {
        let case = question.at(value)?;
        let route = JourneyPath::of(&case, progress)?;
        let is_reached = route.hops().is_some();
        *(if is_reached { &mut threshold.reachable_at } else { &mut threshold.unreachable_at }) = Some(value);
        tries.push(Tried { value, case, route });
        meter.complete_one()?;
        Ok::<bool, RequireError>(is_reached)
    };
    let octaves = range.octaves();
    for i in 0..=octaves {
        if attempt(&mut threshold, range.at_share(f64::from(i) / f64::from(octaves)))? {
            break;
        }
    }
    while let Threshold { unreachable_at: Some(low), reachable_at: Some(high) } = threshold
        && !range.is_close(low, high)
    {
        attempt(&mut threshold, range.middle(low, high))?;
    }
    let first = &question.variation.first;
    let ends = first.ends()?;
    let reached = tries.iter().find(|tried| Some(tried.value) == threshold.reachable_at);
    let path = reached.and_then(|tried| tried.route.path(&tried.case));
    let projection = first.prepared.projection.as_ref();
    let answer = RequireAnswer {
        start_x_m: ends.0.point.x_m,
        goal_x_m: ends.1.point.x_m,
        vary: question.key().to_owned(),
        unreachable_at: None,
        reachable_at: threshold.reachable_at,
        not_reached_at: threshold.unreachable_at,
        route: question.route_record(),
        from: range.weakest.min(range.strongest),
        to: range.weakest.max(range.strongest),
        resolution: range.resolution,
        resolution_met: range.is_met(&threshold),
        never_binds: false,
        tries: tries.iter().map(Tried::record).collect(),
        hops: reached.and_then(|tried| tried.route.hops()),
        path: path.as_ref().map(|path| HopRecord::rows(path, projection)).unwrap_or_default(),
        totals: path.as_ref().map(|path| TotalsRecord::from(&path.totals)),
        success: None,
        within_budgets: None,
        derating: DeratingRecord::of(&first.scenario.derating),
        gap: None,
    };
    let value = reached.map_or(range.strongest, |tried| tried.value);
    Ok(question.required(question.at(value)?, value, answer))
}
