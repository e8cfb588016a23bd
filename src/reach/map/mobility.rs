//! How freely a hopper moves from each post: a map for the choice of landing sites.

use rayon::prelude::*;

use super::{MapError, Post, PostHops};
use crate::{
    ballistics::safety_range_m,
    ground::{Offset, Surface},
    progress::{Detail, Meter, PairCounter, Progress, Stage},
    world::tolerant_speed_m_s,
};

/// The number of equal sectors in which directions are counted; the first is centred on grid north.
pub const SECTORS: u8 = 16;

/// The results of single hops from every node.
#[derive(Clone, Debug, PartialEq)]
pub struct Mobility {
    /// The radius of the disc, m: the range of one hop over level ground.
    pub disc_radius_m: f64,
    /// For each node, the fraction of the other nodes in its disc (on the map and with an elevation) that one hop reaches, 0 to 1;
    /// NaN if the node has no elevation or its disc no other node.
    pub share: Vec<f32>,
    /// For each node, the number of the [`SECTORS`] directions in which its disc has a hop; NaN if it has no elevation.
    pub directions: Vec<f32>,
}

/// Tests every hop from every node within the disc and reports every block of nodes; the result does not depend on the number of
/// threads.
///
/// The disc is that of level ground, `v^2 / g` for the smaller of both speed limits of an arc, so that different terrains are comparable.
///
/// # Errors
/// [`MapError`]; of several, the one of the first block.
pub fn mobility(hops: &PostHops, progress: &dyn Progress) -> Result<Mobility, MapError> {
    let lattice = hops.lattice();
    let limits = hops.ground().hopper().limits();
    let range_m = |speed_m_s: f64| safety_range_m(0.0, tolerant_speed_m_s(speed_m_s), hops.ground().gravity_m_s2());
    let disc_radius_m = range_m(limits.takeoff_speed_max_m_s.min(limits.arc_landing_speed_max_m_s()));
    let disc: Vec<(usize, &Offset)> =
        hops.offsets().iter().enumerate().take_while(|(_, offset)| offset.run_m <= disc_radius_m).collect();
    let sectors: Vec<u16> = disc.iter().map(|(_, offset)| 1 << sector(offset)).collect();
    let (down, across) = lattice.blocks();
    let meter = Meter::with_total(progress, Stage::Mobility, (down * across) as u64);
    meter.report(Detail::None)?;
    let blocks: Vec<Result<Vec<OfNode>, MapError>> = (0..down * across)
        .into_par_iter()
        .map_init(
            || meter.counter(),
            |counter, block| {
                meter.check()?;
                let found = lattice
                    .nodes_of(block)
                    .filter(|&node| hops.has_ground(node))
                    .map(|node| {
                        from_node(hops, node, (&disc, &sectors), counter)
                            .map(|(share, directions)| (lattice.index(node), share, directions))
                    })
                    .collect::<Result<Vec<OfNode>, MapError>>()?;
                meter.complete_one()?;
                Ok(found)
            },
        )
        .collect();
    meter.check()?;
    let mut map = Mobility { disc_radius_m, share: vec![f32::NAN; lattice.count()], directions: vec![f32::NAN; lattice.count()] };
    for block in blocks {
        for (node, share, directions) in block? {
            map.share[node] = share;
            map.directions[node] = directions;
        }
    }
    Ok(map)
}

impl Mobility {
    /// The bytes that its search holds beside it for each node, at most: short lists grow to twice their length.
    pub(crate) const fn working_bytes_per_node() -> usize {
        3 * size_of::<OfNode>() + 2
    }
}

/// A node's number, its fraction and its directions.
type OfNode = (usize, f32, f32);

/// Fraction and directions of one node.
fn from_node(
    hops: &PostHops,
    node: Post,
    (disc, sectors): (&[(usize, &Offset)], &[u16]),
    counter: &mut PairCounter<'_>,
) -> Result<(f32, f32), MapError> {
    let usable = hops.usable(node);
    let (mut there, mut reached, mut directions) = (0u32, 0u32, 0u16);
    for (&(number, offset), sector) in disc.iter().zip(sectors) {
        let Some(landing) = hops.landing(node, number) else { continue };
        if !hops.has_ground(landing) {
            continue;
        }
        there += 1;
        if !usable || !hops.usable(landing) {
            continue;
        }
        counter.pair()?;
        if hops.lofts_where(node, offset, |_, _| true)?.is_some() {
            reached += 1;
            directions |= sector;
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "a share to 24 bits")]
    let share = if there == 0 { f32::NAN } else { reached as f32 / there as f32 };
    #[expect(clippy::cast_precision_loss, reason = "at most 16")]
    Ok((share, directions.count_ones() as f32))
}

/// The sector of an offset's heading.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and the number of sectors")]
fn sector(offset: &Offset) -> u8 {
    let turn = libm::atan2(offset.heading.x, offset.heading.y) / std::f64::consts::TAU;
    ((turn + 1.0) * f64::from(SECTORS)).round() as u8 % SECTORS
}
