//! Contacts drawn all over a mesh until there are enough, and what is reached over them.

use std::time::{Duration, Instant};

use super::{ContactHops, Way, contact_hops};
use crate::{
    ground::{MeshContact, MeshGround},
    planner::roadmap::{ContactSampler, DrawnContacts, RoadmapEnd, RoadmapLimits},
    progress::{Cancelled, Progress},
};

/// What is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpreadQuestion {
    /// The most hops out, and back.
    pub hops_max: Option<u32>,
    /// Whether the hops back to the start are searched as well.
    pub returns: bool,
}

/// What was reached over so many contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpreadRound {
    /// Contacts so far.
    pub contacts: usize,
    /// How many of them were reached.
    pub reached: usize,
    /// The most hops of any of them.
    pub farthest_hops: u32,
}

/// What is reached over contacts all over a mesh.
#[derive(Clone, Debug)]
pub struct Spread {
    /// The contacts. Contact 0 is the start, those that were given beside it come next.
    pub contacts: Vec<MeshContact>,
    /// The hops from the start.
    pub out: ContactHops,
    /// The hops back to the start, if they were asked for.
    pub back: Option<ContactHops>,
    /// The rounds of twice as many contacts each.
    pub history: Vec<SpreadRound>,
    /// Why there are no more contacts.
    pub end: RoadmapEnd,
    /// The contacts that were drawn and left out.
    pub drawn: DrawnContacts,
}

/// The contacts of the first round.
const FIRST: usize = 256;

/// A round of twice as many contacts tests four times as many pairs.
const LONGER: u32 = 4;

/// Draws contacts all over a mesh, twice as many in each round, and finds which of them are reached from the first of the given ones: how much
/// a round adds shows what further contacts may.
///
/// # Errors
/// [`Cancelled`].
pub fn spread(
    ground: &MeshGround,
    given: Vec<MeshContact>,
    sampler: &mut ContactSampler<'_>,
    question: SpreadQuestion,
    limits: RoadmapLimits,
    progress: &dyn Progress,
) -> Result<Spread, Cancelled> {
    let began = limits.time_max.map(|most| (Instant::now(), most));
    let mut contacts = given;
    let mut history = Vec::new();
    loop {
        let count = contacts.len();
        let wanted = limits.contacts_max.min((2 * count).max(FIRST));
        contacts.extend(sampler.all_over(wanted.saturating_sub(count), &|_| true));
        let round_began = Instant::now();
        let out = contact_hops(ground, &contacts, (0, Way::Out), question.hops_max, progress)?;
        history.push(SpreadRound { contacts: contacts.len(), reached: out.count(), farthest_hops: out.farthest() });
        let end = if contacts.len() >= limits.contacts_max {
            RoadmapEnd::Contacts
        } else if contacts.len() < wanted {
            RoadmapEnd::Exhausted
        } else if began.is_some_and(|(began, most)| !is_in_time(began.elapsed(), round_began.elapsed(), most)) {
            RoadmapEnd::Time
        } else {
            continue;
        };
        let back = question.returns.then(|| contact_hops(ground, &contacts, (0, Way::Back), question.hops_max, progress));
        return Ok(Spread { out, back: back.transpose()?, contacts, history, end, drawn: sampler.drawn() });
    }
}

/// Whether another round is done within a time.
fn is_in_time(passed: Duration, round: Duration, most: Duration) -> bool {
    round.checked_mul(LONGER).and_then(|next| passed.checked_add(next)).is_some_and(|ends| ends <= most)
}
