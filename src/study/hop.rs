//! One hop, limit by limit.

use super::{Case, CaseError, Commands, Extremes, constant_gravity_warnings, free_route::outages_not_counted};
use crate::{
    chain::Station,
    graph::{Edge, Leg},
    hop::{HopTest, TakeoffSet},
    path::{HopPath, PathError},
    report::{DeratingRecord, HopAnswer},
};

/// Why there is no answer. That the hop is not feasible is one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HopError {
    /// The case.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// Take-off and landing at the same point.
    #[error("take-off and landing are both x = {x_m} m, expected two different points of the chain")]
    SamePoint {
        /// Where, m.
        x_m: f64,
    },
}

/// One hop, with everything that its views need.
#[derive(Clone, Debug)]
pub struct Hopped {
    /// What was asked, for exact commands.
    pub case: Case,
    /// The hop test over its chain.
    pub test: HopTest,
    /// Take-off and landing.
    pub ends: (Station, Station),
    /// The answer as plain data.
    pub answer: HopAnswer,
    /// The warnings about the hop.
    pub warnings: Vec<String>,
}

/// Tests the one hop from the start of a case to its goal, for exact commands.
///
/// # Errors
/// [`HopError`].
pub fn hop(case: &Case) -> Result<Hopped, HopError> {
    let case = case.with_commands(Commands::Exact)?;
    let (test, (takeoff, landing)) = (case.hop_test(), case.ends()?);
    let same = HopError::SamePoint { x_m: takeoff.point.x_m };
    let answer = HopAnswer::new(&test, &takeoff, &landing, case.scenario.search.takeoff).ok_or(same)?;
    let extremes = answer.best.map_or_else(Extremes::default, |best| Extremes {
        range_m: (answer.to_x_m - answer.from_x_m).abs(),
        height_m: best.apex_height_m,
        speed_m_s: best.takeoff_speed_m_s.max(best.landing_speed_m_s),
    });
    let mut warnings = constant_gravity_warnings(&case.scenario.body, extremes);
    warnings.extend(outages_not_counted(&case.scenario));
    warnings.extend(DeratingRecord::of(&case.scenario.derating).map(|derating| derating.sentence()));
    Ok(Hopped { case, test, ends: (takeoff, landing), answer, warnings })
}

impl Hopped {
    /// The hop as a path; `None` if it is not feasible.
    ///
    /// # Errors
    /// As [`path::generate`](crate::path::generate).
    pub fn path(&self) -> Result<Option<HopPath>, PathError> {
        let (takeoff, landing) = self.ends;
        let search = &self.case.scenario.search;
        let set = self.test.takeoff_set(&takeoff, &landing);
        let Some(lofts) = set.as_ref().and_then(TakeoffSet::lofts) else { return Ok(None) };
        self.case.planning().path(&self.test, &[Leg { takeoff, landing, edge: Edge::Hop(lofts), loft: None }], search).map(Some)
    }
}
