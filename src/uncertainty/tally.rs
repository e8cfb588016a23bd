//! Statistics that accumulate trial by trial in bounded memory, and merge exactly.

use std::ops::Range;

use nalgebra::Point2;
use serde::{Deserialize, Serialize};

use super::{
    LandingSummary, OutcomeCounts, Policy, QuantileSketch, Summary, TrialOutcome, TrialRecord, Wilson, landing_tally::LandingTally,
    rates::Rates, trial::Landing,
};

/// The statistics of the trials with some numbers, of one mission with its errors and options.
///
/// Tallies of other trials of the same mission [`merge`](Self::merge): any division of a run into ranges, merged in any order, gives the
/// summary of the whole run to the last bit, since counts are whole numbers and sums are exact. It is plain data for serde, so that the
/// parts may be flown by several processes or machines with the same version of this crate.
///
/// Memory does not grow with the number of trials. For every hop of a trial: the histogram of its distances, 2 kB for each factor of two
/// between the least and the greatest, and some 500 bytes of sums; for the rates of success at most 40 kB. In practice some 20 kB for
/// each hop.
///
/// # Examples
/// ```
/// use chta::uncertainty::{Simulation, Tally, TrialOptions};
/// /// Two halves, one of them by way of a text.
/// fn in_halves(simulation: &Simulation, trials: u64) -> Result<Tally, Box<dyn std::error::Error>> {
///     let half = TrialOptions { trials: trials / 2, ..TrialOptions::default() };
///     let rest = TrialOptions { first_trial: half.trials, trials: trials - half.trials, ..half };
///     let text = serde_json::to_string(&simulation.tally(&rest, &mut (), &())?)?;
///     let mut tally: Tally = serde_json::from_str(&text)?;
///     tally.merge(&simulation.tally(&half, &mut (), &())?)?;
///     Ok(tally)
/// }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tally {
    pub(super) of: Flights,
    pub(super) statistics: Statistics,
}

/// What all trials of a tally have in common.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Flights {
    /// SHA-256 of the path, the ground and the data for replanning.
    pub(super) mission: String,
    /// The standard deviations, as text.
    pub(super) errors: String,
    pub(super) seed: u64,
    pub(super) policy: Policy,
    pub(super) hop_limit: u32,
    pub(super) goal_tolerance_m: f64,
}

/// The statistics of all trials so far, in any order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Statistics {
    /// Half-open ranges of the numbers of all trials, ascending, with gaps between them.
    trials: Vec<Range<u64>>,
    outcomes: OutcomeCounts,
    /// By the number of the hop that ended the trial; 0: before any.
    ends: Vec<OutcomeCounts>,
    /// Of the trials that stopped off the goal: how far.
    missed_m: QuantileSketch,
    hops_flown: u64,
    landings: Vec<LandingTally>,
    rates: Rates,
    places: PlannedPlaces,
}

/// Where hops are planned to land: positions of rest are added up relative to them, so that large map coordinates do not cost digits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PlannedPlaces {
    /// By the number of the hop.
    pub(super) landings: Vec<[f64; 2]>,
    /// For the hops beyond.
    pub(super) goal: [f64; 2],
    /// Whether positions are those of a map.
    pub(super) on_a_map: bool,
}

/// Why two tallies do not merge.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MergeProblem {
    /// Trials of different missions, errors or options.
    #[error("the tallies have different {what}, {ours} and {theirs}: merge tallies of the same mission, errors, seed and options")]
    Differ {
        /// What differs.
        what: &'static str,
        /// In this tally.
        ours: String,
        /// In the other one.
        theirs: String,
    },
    /// Trials that both have.
    #[error("both tallies have the trials from {first} to {last}: fly each trial once, with first_trial behind the trials before")]
    Overlap {
        /// The first of them.
        first: u64,
        /// The last.
        last: u64,
    },
}

impl Tally {
    /// The ranges of the numbers of its trials, ascending, with gaps between them.
    pub fn trials(&self) -> &[Range<u64>] {
        &self.statistics.trials
    }

    /// Adds the trials of another part of the same run.
    ///
    /// # Errors
    /// [`MergeProblem`]: another mission, errors or options, or trials that both have; this tally is then unchanged.
    pub fn merge(&mut self, other: &Self) -> Result<(), MergeProblem> {
        let (ours, theirs) = (&self.of, &other.of);
        let differ = |what, ours: &dyn ToString, theirs: &dyn ToString| {
            let (ours, theirs) = (ours.to_string(), theirs.to_string());
            if ours == theirs { Ok(()) } else { Err(MergeProblem::Differ { what, ours, theirs }) }
        };
        differ("missions", &ours.mission, &theirs.mission)?;
        differ("errors", &ours.errors, &theirs.errors)?;
        differ("seeds", &ours.seed, &theirs.seed)?;
        differ("policies", &ours.policy, &theirs.policy)?;
        differ("hop limits", &ours.hop_limit, &theirs.hop_limit)?;
        differ("goal tolerances (m)", &ours.goal_tolerance_m, &theirs.goal_tolerance_m)?;
        self.statistics.merge(&other.statistics)
    }

    /// The statistics, without trajectories.
    pub fn summary(&self) -> Summary {
        self.statistics.summary(self.of.policy, self.of.seed)
    }
}

impl Statistics {
    /// No trials yet.
    pub(super) fn new(places: PlannedPlaces) -> Self {
        Self { places, ..Self::default() }
    }

    /// How many trials have reached the goal.
    pub(super) fn reached_goal(&self) -> u64 {
        self.outcomes.of(TrialOutcome::Reached)
    }

    pub(super) fn success(&self) -> Wilson {
        Wilson::of(self.reached_goal(), self.outcomes.total())
    }

    pub(super) fn trial(&mut self, record: &TrialRecord) {
        let TrialRecord { trial, outcome, hops, .. } = *record;
        match self.trials.last_mut() {
            Some(last) if last.end == trial => last.end += 1,
            _ => self.trials.push(trial..trial + 1),
        }
        self.outcomes.count(outcome);
        let ended = usize::try_from(record.last_hop()).unwrap_or(usize::MAX);
        if self.ends.len() <= ended {
            self.ends.resize(ended + 1, OutcomeCounts::default());
        }
        self.ends[ended].count(outcome);
        if outcome == TrialOutcome::Missed {
            self.missed_m.add(record.goal_distance_m);
        }
        self.hops_flown += u64::from(hops);
        self.rates.add(trial, outcome == TrialOutcome::Reached);
    }

    pub(super) fn landing(&mut self, landing: &Landing) {
        let hop = usize::try_from(landing.hop).unwrap_or(usize::MAX);
        while self.landings.len() <= hop {
            self.landings.push(LandingTally::default());
        }
        let planned = self.places.of(hop);
        if let Some(tally) = self.landings.get_mut(hop) {
            tally.add(landing, self.places.on_a_map.then_some(planned));
        }
    }

    fn merge(&mut self, other: &Self) -> Result<(), MergeProblem> {
        for (a, b) in self.trials.iter().flat_map(|a| other.trials.iter().map(move |b| (a, b))) {
            let (first, end) = (a.start.max(b.start), a.end.min(b.end));
            if first < end {
                return Err(MergeProblem::Overlap { first, last: end - 1 });
            }
        }
        self.trials.extend(other.trials.iter().cloned());
        self.trials.sort_by_key(|range| range.start);
        self.trials.dedup_by(|next, last| {
            let joins = last.end == next.start;
            if joins {
                last.end = next.end;
            }
            joins
        });
        self.outcomes += other.outcomes;
        self.ends.resize(self.ends.len().max(other.ends.len()), OutcomeCounts::default());
        for (mine, theirs) in self.ends.iter_mut().zip(&other.ends) {
            *mine += *theirs;
        }
        self.missed_m.merge(&other.missed_m);
        self.hops_flown = self.hops_flown.saturating_add(other.hops_flown);
        self.landings.resize_with(self.landings.len().max(other.landings.len()), LandingTally::default);
        for (mine, theirs) in self.landings.iter_mut().zip(&other.landings) {
            mine.merge(theirs);
        }
        self.rates.merge(&other.rates);
        Ok(())
    }

    /// All of it, without trajectories.
    pub(super) fn summary(&self, policy: Policy, seed: u64) -> Summary {
        Summary {
            policy,
            seed,
            first_trial: self.trials.first().map_or(0, |first| first.start),
            trials: self.outcomes.total(),
            outcomes: self.outcomes,
            ends: self.ends.clone(),
            missed_m: self.missed_m.clone(),
            success: self.success(),
            hops_flown: self.hops_flown,
            landings: self.landings(),
            convergence: self.rates.points(self.trials.last().map_or(0, |last| last.end)),
            trajectories: Vec::new(),
        }
    }

    /// The landings by the number of their hop.
    fn landings(&self) -> Vec<LandingSummary> {
        let of = |(hop, tally): (usize, &LandingTally)| {
            let planned = self.places.on_a_map.then(|| self.places.of(hop));
            tally.summary(u32::try_from(hop + 1).unwrap_or(u32::MAX), planned)
        };
        self.landings.iter().enumerate().filter_map(of).collect()
    }
}

impl PlannedPlaces {
    /// That of a hop, from 0.
    fn of(&self, hop: usize) -> Point2<f64> {
        let [x, y] = self.landings.get(hop).copied().unwrap_or(self.goal);
        Point2::new(x, y)
    }
}
