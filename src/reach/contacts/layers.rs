//! Breadth-first search over contacts that tests a pair only where its hop may be the first to a contact.

use rayon::prelude::*;

use crate::{
    ground::{MeshBuffers, MeshContact, MeshGround},
    progress::{Cancelled, Detail, Meter, Progress, Stage},
};

/// From the first contact, or to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Hops lead from it to the others.
    Out,
    /// Hops lead from the others to it.
    Back,
}

/// The fewest hops between one contact and each of the others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ContactHops {
    /// The fewest hops, 0 of the first contact itself; `None` where none were found.
    pub hops: Vec<Option<u32>>,
    /// The contact next to each on its way: the one that the last hop comes from on the way out, the one that the first hop goes to on the way
    /// back. `None` of the first contact and where no way was found.
    pub next_to: Vec<Option<usize>>,
    /// Ordered pairs of contacts that were tested.
    pub pairs_tested: u64,
    /// Whether the search ended since it found no further contacts; else it ended at its greatest number of hops, and contacts without hops may
    /// be farther.
    pub is_complete: bool,
}

impl ContactHops {
    /// How many contacts have hops, the first one included.
    pub fn count(&self) -> usize {
        self.hops.iter().flatten().count()
    }

    /// The most hops of any contact.
    pub fn farthest(&self) -> u32 {
        self.hops.iter().flatten().copied().max().unwrap_or(0)
    }
}

/// The fewest hops between one of several contacts and each of the others, in at most `hops_max` hops, the same for any number of threads.
///
/// # Errors
/// [`Cancelled`].
///
/// # Complexity
/// Every ordered pair of a contact and one that is farther by at least a hop, at most once: a square root for most, the windows of those
/// that the greatest speeds may span.
pub fn contact_hops(
    ground: &MeshGround,
    contacts: &[MeshContact],
    (first, way): (usize, Way),
    hops_max: Option<u32>,
    progress: &dyn Progress,
) -> Result<ContactHops, Cancelled> {
    let meter = Meter::new(progress, Stage::Search);
    meter.report(Detail::None)?;
    let bounds = ground.speed_bounds();
    let points: Vec<_> = contacts.iter().map(MeshContact::point_m).collect();
    let count = contacts.len();
    let mut found = ContactHops { hops: vec![None; count], next_to: vec![None; count], pairs_tested: 0, is_complete: true };
    if first < count {
        found.hops[first] = Some(0);
    }
    let mut layer: Vec<usize> = (first..count).take(1).collect();
    let mut left: Vec<usize> = (0..count).filter(|contact| *contact != first).collect();
    for hops in 1.. {
        if layer.is_empty() || left.is_empty() {
            break;
        }
        if hops_max.is_some_and(|most| hops > most) {
            found.is_complete = false;
            break;
        }
        // The first contact of the layer with a hop, and how many were tried.
        let reached_from = |buffers: &mut MeshBuffers, contact: &usize| {
            let mut counter = meter.counter();
            for (number, &near) in layer.iter().enumerate() {
                counter.pair()?;
                let (from, to) = match way {
                    Way::Out => (near, *contact),
                    Way::Back => (*contact, near),
                };
                let away = points[to] - points[from];
                if !bounds.span(away.norm(), away.z) {
                    continue;
                }
                if ground.windows(&contacts[from], &contacts[to], buffers).is_some_and(|(_, windows)| !windows.is_empty()) {
                    return Ok((Some(near), number + 1));
                }
            }
            Ok((None, layer.len()))
        };
        let tried: Vec<(Option<usize>, usize)> =
            left.par_iter().map_init(MeshBuffers::default, reached_from).collect::<Result<_, Cancelled>>()?;
        meter.check()?;
        let mut next = Vec::new();
        for (&contact, (near, tests)) in left.iter().zip(&tried) {
            found.pairs_tested += *tests as u64;
            if near.is_some() {
                (found.hops[contact], found.next_to[contact]) = (Some(hops), *near);
                next.push(contact);
            }
        }
        left.retain(|contact| found.hops[*contact].is_none());
        layer = next;
    }
    Ok(found)
}
