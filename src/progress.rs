//! Progress of long work, and its cancellation: one trait, whose answer says whether the work goes on.
//!
//! Every stage that may take long is given a [`Progress`] and reports to it: at its beginning, at least once every [`PAIRS_PER_REPORT`]
//! tested pairs, and whenever a layer, a round, a batch, a heading or a cell of a grid is complete. A report answered with a break ends
//! the stage with an error that holds [`Cancelled`]; nothing partial is returned as an answer. Answers do not depend on what is reported.
//!
//! `()` reports nothing and never cancels.
//!
//! ```
//! use std::{ops::ControlFlow, sync::atomic::{AtomicU64, Ordering}};
//! use chta::progress::{Progress, Step};
//!
//! /// Cancels the work after so many reports.
//! struct AtMost(AtomicU64);
//!
//! impl Progress for AtMost {
//!     fn report(&self, _: &Step) -> ControlFlow<()> {
//!         let left = self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1));
//!         if left.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
//!     }
//! }
//! ```

use std::{
    fmt,
    ops::ControlFlow,
    sync::atomic::{AtomicBool, AtomicU64, Ordering},
};

/// At most so many pairs are tested between two reports of a stage, by all threads together.
pub const PAIRS_PER_REPORT: u64 = 100_000;

/// Receives the reports of long work, and may cancel it.
///
/// Reports come from whichever thread does the work, also from several at once.
pub trait Progress: Sync {
    /// How far a stage is. A break cancels it.
    fn report(&self, step: &Step) -> ControlFlow<()>;
}

/// Reports are ignored, and nothing is cancelled.
impl Progress for () {
    fn report(&self, _: &Step) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// A stage of work that may take long.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Stage {
    /// The search for a path over a chain; counted in pairs of nodes.
    Search,
    /// The hops from a start to every node of a chain; counted in pairs of nodes.
    Reachability,
    /// The cost-to-go of every node; counted in pairs of nodes.
    CostToGo,
    /// The most reliable paths or successors; counted in hops tested and risks estimated.
    Reliability,
    /// The bounds on the fewest hops; counted in pairs of cells or of points in them.
    Proof,
    /// The least capability; counted in values tried.
    Requirement,
    /// The layers of a hop map; counted in posts reached.
    MapLayers,
    /// The layers of a map of return journeys; counted in posts reached.
    ReturnLayers,
    /// The mobility of every post; counted in blocks of posts.
    Mobility,
    /// The ranking of landing sites; counted in candidates.
    Sites,
    /// Slices in all directions; counted in headings.
    Fan,
    /// Trials of a mission; counted in trials.
    Trials,
    /// A grid of scenarios; counted in cells.
    Trade,
    /// The drive legs from every node; counted in rows of nodes.
    DriveLegs,
    /// The least cost of driving to every node; counted in nodes.
    DriveMap,
}

/// The unit of the stages that are counted in tested pairs.
const PAIRS: &str = "pairs";

impl Stage {
    /// All of them.
    pub const ALL: [Self; 15] = [
        Self::Search,
        Self::Reachability,
        Self::CostToGo,
        Self::Reliability,
        Self::Proof,
        Self::Requirement,
        Self::MapLayers,
        Self::ReturnLayers,
        Self::Mobility,
        Self::Sites,
        Self::Fan,
        Self::Trials,
        Self::Trade,
        Self::DriveLegs,
        Self::DriveMap,
    ];

    /// The name in messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Search => "search",
            Self::Reachability => "reachability search",
            Self::CostToGo => "cost-to-go",
            Self::Reliability => "reliability ranking",
            Self::Proof => "proof",
            Self::Requirement => "search for the least capability",
            Self::MapLayers => "hop map",
            Self::ReturnLayers => "return hop map",
            Self::Mobility => "mobility map",
            Self::Sites => "ranking of sites",
            Self::Fan => "fan",
            Self::Trials => "simulation",
            Self::Trade => "trade grid",
            Self::DriveLegs => "judging of drive legs",
            Self::DriveMap => "drive map",
        }
    }

    /// What [`Step::done`] counts.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Search | Self::Reachability | Self::CostToGo | Self::Reliability | Self::Proof => PAIRS,
            Self::Requirement => "values",
            Self::MapLayers | Self::ReturnLayers => "posts",
            Self::Mobility => "blocks",
            Self::Sites => "candidates",
            Self::Fan => "headings",
            Self::Trials => "trials",
            Self::Trade => "cells",
            Self::DriveLegs => "rows",
            Self::DriveMap => "nodes",
        }
    }

    /// Whether the stage is counted in pairs.
    fn counts_pairs(self) -> bool {
        self.unit() == PAIRS
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How far a stage is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Step {
    /// Which stage.
    pub stage: Stage,
    /// How much is done, in the unit of the stage.
    pub done: u64,
    /// Of how much, where that is known.
    pub of: Option<u64>,
    /// How many pairs the stage has tested; a little fewer than they are, since every thread counts by itself in between.
    pub pairs: u64,
    /// What else there is to tell.
    pub detail: Detail,
}

/// What a stage tells beside its counts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Detail {
    /// Nothing: the stage goes on with what it said last.
    None,
    /// A search begins with so many points inside each segment.
    PointsPerSegment(u32),
    /// A search begins with nodes at most so far apart, m.
    NodeSpacingM(f64),
    /// A round of a proof is complete.
    ProofRound {
        /// The cells it has.
        cells: usize,
        /// Which round, from 1.
        round: u32,
    },
    /// A layer of a hop map is complete.
    Layer {
        /// Its number of hops.
        hops: i16,
    },
    /// A batch of trials is complete.
    Trials {
        /// How many trials have reached the goal so far.
        reached_goal: u64,
    },
}

/// A stage was cancelled: it has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the {stage} was cancelled after {done} {}", stage.unit())]
pub struct Cancelled {
    /// Which stage.
    pub stage: Stage,
    /// How much was done, in the unit of the stage.
    pub done: u64,
    /// How many pairs were tested, those between the report that was answered with a break and the end of the work included.
    pub pairs: u64,
}

/// No known total.
const UNKNOWN: u64 = u64::MAX;

/// Counts the work of one stage, for all of its threads, and reports it.
pub(crate) struct Meter<'p> {
    progress: &'p dyn Progress,
    stage: Stage,
    done: AtomicU64,
    of: AtomicU64,
    pairs: AtomicU64,
    /// Pairs that one thread counts by itself.
    batch: u64,
    cancelled: AtomicBool,
}

impl<'p> Meter<'p> {
    /// Before any work.
    pub(crate) fn new(progress: &'p dyn Progress, stage: Stage) -> Self {
        // So many for each thread of the pool, and as many waiting in the common counter, are no more than allowed between two reports.
        let counters = rayon::current_num_threads() as u64 + 2;
        Self {
            progress,
            stage,
            done: AtomicU64::new(0),
            of: AtomicU64::new(UNKNOWN),
            pairs: AtomicU64::new(0),
            batch: (PAIRS_PER_REPORT / counters).clamp(1, 8192),
            cancelled: AtomicBool::new(false),
        }
    }

    /// The same, with so much to do.
    pub(crate) fn with_total(progress: &'p dyn Progress, stage: Stage, of: u64) -> Self {
        let meter = Self::new(progress, stage);
        meter.of.store(of, Ordering::Relaxed);
        meter
    }

    /// Sets how much is done, and of how much.
    pub(crate) fn set_done(&self, done: u64, of: u64) {
        self.done.store(done, Ordering::Relaxed);
        self.of.store(of, Ordering::Relaxed);
    }

    /// One more is done: reports it.
    ///
    /// # Errors
    /// [`Cancelled`], now or before.
    pub(crate) fn complete_one(&self) -> Result<(), Cancelled> {
        self.done.fetch_add(1, Ordering::Relaxed);
        self.report(Detail::None)
    }

    /// Reports how far the stage is.
    ///
    /// # Errors
    /// [`Cancelled`], now or before.
    pub(crate) fn report(&self, detail: Detail) -> Result<(), Cancelled> {
        self.check()?;
        let of = Some(self.of.load(Ordering::Relaxed)).filter(|of| *of != UNKNOWN);
        let step = Step { stage: self.stage, done: self.done(), of, pairs: self.pairs.load(Ordering::Relaxed), detail };
        if self.progress.report(&step).is_break() {
            self.cancelled.store(true, Ordering::Relaxed);
        }
        self.check()
    }

    /// Whether the stage goes on, without a report.
    ///
    /// # Errors
    /// [`Cancelled`], where a report was answered so.
    pub(crate) fn check(&self) -> Result<(), Cancelled> {
        if self.cancelled.load(Ordering::Relaxed) {
            return Err(Cancelled { stage: self.stage, done: self.done(), pairs: self.pairs.load(Ordering::Relaxed) });
        }
        Ok(())
    }

    /// The same after so many pairs of earlier stages of the same work.
    pub(crate) fn after(self, pairs: u64) -> Self {
        self.pairs.store(pairs, Ordering::Relaxed);
        self
    }

    /// Whether the stage goes on: to be asked before each of many pieces of work that count no pairs. It reports now and then.
    ///
    /// # Errors
    /// [`Cancelled`], now or before.
    pub(crate) fn check_piece(&self, number: usize) -> Result<(), Cancelled> {
        const PIECES_PER_REPORT: usize = 256;
        if number.is_multiple_of(PIECES_PER_REPORT) { self.report(Detail::None) } else { self.check() }
    }

    /// A counter of one thread's pairs.
    pub(crate) const fn counter(&self) -> PairCounter<'_> {
        PairCounter { meter: self, pending: 0 }
    }

    fn done(&self) -> u64 {
        if self.stage.counts_pairs() { self.pairs.load(Ordering::Relaxed) } else { self.done.load(Ordering::Relaxed) }
    }

    /// Adds the pairs of one thread, and reports whenever another batch of them is full.
    #[cold]
    fn add(&self, pairs: u64) -> Result<(), Cancelled> {
        let before = self.pairs.fetch_add(pairs, Ordering::Relaxed);
        if before / self.batch == (before + pairs) / self.batch { self.check() } else { self.report(Detail::None) }
    }
}

impl fmt::Debug for Meter<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Meter").field("stage", &self.stage).field("pairs", &self.pairs).finish_non_exhaustive()
    }
}

/// Counts the pairs that one thread tests. Dropped, it hands on what it has not reported; a stage checks its [`Meter`] after that.
#[derive(Debug)]
pub(crate) struct PairCounter<'m> {
    meter: &'m Meter<'m>,
    pending: u64,
}

impl PairCounter<'_> {
    /// One pair is about to be tested.
    ///
    /// # Errors
    /// [`Cancelled`], seen after a batch of pairs.
    #[inline]
    pub(crate) fn pair(&mut self) -> Result<(), Cancelled> {
        self.pending += 1;
        if self.pending < self.meter.batch { Ok(()) } else { self.hand_on() }
    }

    /// Whether the stage goes on: to be asked before each of many small pieces of work, none of which fills a batch.
    ///
    /// # Errors
    /// [`Cancelled`], where a report was answered so.
    #[inline]
    pub(crate) fn check(&self) -> Result<(), Cancelled> {
        self.meter.check()
    }

    #[cold]
    fn hand_on(&mut self) -> Result<(), Cancelled> {
        self.meter.add(std::mem::take(&mut self.pending))
    }
}

impl Drop for PairCounter<'_> {
    fn drop(&mut self) {
        if self.pending > 0 {
            // The stage checks the meter.
            let _ = self.hand_on();
        }
    }
}
