//! The risks-to-go of all posts, for replanning over a map.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::{MapError, Post, PostHops};
use crate::{
    ballistics::TakeoffChoice,
    flight::Uncertainty,
    graph::{MapJudge, PostRisks},
    ground::DemGround,
    progress::{Detail, Meter, PairCounter, Progress, Stage},
};

/// The weight of the most reliable path from every post to a goal, where a robot has these errors and this choice of take-offs.
///
/// The risk of a hop is estimated in closed form, from its window of angles, its landing speed and the facets around its landing: flown
/// draws of every pair would take hours.
///
/// Dijkstra's algorithm from the goal, against the direction of the hops, in batches: no hop weighs less than
/// 0.02, so that all labels within this of the least open one are final. The labels are least sums, whichever thread
/// finds them first.
///
/// # Errors
/// [`MapError`].
///
/// # Complexity
/// Every pair of posts within reach is tested once; 16 bytes for each post.
pub fn risks_to_go(
    hops: &PostHops,
    goal: Post,
    criterion: (&Uncertainty, TakeoffChoice),
    progress: &dyn Progress,
) -> Result<PostRisks, MapError> {
    risks_flown_over(hops, hops.ground(), goal, criterion, progress)
}

/// The same for hops that are planned under shares of the limits, and flown over a ground with the whole limits.
///
/// Of the closed form, the window of angles stays the one that planning may use.
///
/// # Errors
/// [`MapError`].
pub fn risks_flown_over(
    hops: &PostHops,
    flown: &DemGround,
    goal: Post,
    (errors, takeoff): (&Uncertainty, TakeoffChoice),
    progress: &dyn Progress,
) -> Result<PostRisks, MapError> {
    let meter = Meter::new(progress, Stage::Reliability);
    meter.report(Detail::None)?;
    let lattice = hops.lattice();
    let judge = MapJudge::new(flown, errors, takeoff).planned_within(hops.ground().envelope());
    // Of doubles that are not negative, the bits have the order of the values.
    let labels: Vec<AtomicU64> = (0..lattice.count()).map(|_| AtomicU64::new(f64::INFINITY.to_bits())).collect();
    labels[lattice.index(goal)].store(0, Ordering::Relaxed);
    let label = |index: usize| f64::from_bits(labels[index].load(Ordering::Relaxed));
    let mut done = 0.0;
    loop {
        let open = (0..labels.len()).into_par_iter().map(label).filter(|&label| label >= done);
        let least = open.reduce(|| f64::INFINITY, f64::min);
        if least == f64::INFINITY {
            break;
        }
        let end = least + MapJudge::EACH_HOP;
        let batch: Vec<usize> = (0..labels.len()).into_par_iter().filter(|&index| (least..end).contains(&label(index))).collect();
        let relax =
            |counter: &mut PairCounter<'_>, index: usize| Relaxed { hops, judge: &judge, labels: &labels }.from(index, counter);
        let relaxed: Vec<Result<(), MapError>> =
            batch.par_iter().map_init(|| meter.counter(), |counter, &index| relax(counter, index)).collect();
        meter.check()?;
        relaxed.into_iter().collect::<Result<(), _>>()?;
        meter.report(Detail::None)?;
        done = end;
    }
    let weights = labels.into_iter().map(|label| f64::from_bits(label.into_inner())).collect();
    Ok(PostRisks::new(lattice, weights, judge))
}

/// The labels while they are found.
struct Relaxed<'a> {
    hops: &'a PostHops,
    judge: &'a MapJudge,
    labels: &'a [AtomicU64],
}

impl Relaxed<'_> {
    /// Lowers the labels of the posts from which a hop leads to a post whose label is final.
    fn from(&self, index: usize, counter: &mut PairCounter<'_>) -> Result<(), MapError> {
        counter.check()?;
        let lattice = self.hops.lattice();
        let label = |index: usize| f64::from_bits(self.labels[index].load(Ordering::Relaxed));
        let (to, own) = (lattice.node(index), label(index));
        let Some(target) = self.hops.position(to) else { return Ok(()) };
        let within = self.hops.within_reach(lattice.block_of(to));
        for (number, offset) in self.hops.offsets()[..within].iter().enumerate() {
            let Some(from) = self.hops.takeoff(to, number) else { continue };
            let known = &self.labels[lattice.index(from)];
            if own + MapJudge::EACH_HOP >= label(lattice.index(from)) || !self.hops.usable(from) {
                continue;
            }
            counter.pair()?;
            let Some(lofts) = self.hops.lofts_where(from, offset, |_, _| true)? else { continue };
            let total = own + self.judge.estimate(&target, offset.heading, lofts);
            known.fetch_min(total.to_bits(), Ordering::Relaxed);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        draw::Draw,
        quantity::{Angle, MapPoint},
        terrain::{Dem, GeoReference, OverlaidDem, Overlays},
        world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
    };

    /// By rounds over all pairs until no label changes.
    #[test]
    fn batches_give_the_least_sums_over_all_paths() {
        let draw = &mut Draw::seeded(1611);
        let errors =
            Uncertainty { takeoff_speed_sigma_fraction: 0.03, takeoff_angle_sigma: Angle::from_degrees(1.5), ..Uncertainty::NONE };
        let (mut risky, mut cut_off) = (0, 0);
        for _ in 0..12 {
            let heights = (0..9 * 9).map(|_| if draw.chance(0.05) { f64::NAN } else { draw.uniform(0.0, 1.2) }).collect();
            let dem = Dem::new(9, 9, heights, GeoReference::local(MapPoint::new(2.0, 9.0), 1.0, 1.4).unwrap()).unwrap();
            let surface = SurfaceProperties {
                grip: Some(Grip::Friction(FrictionCone::new(draw.uniform(0.6, 1.5)).unwrap())),
                rest: RestSlope::AsFrictionHolds,
            };
            let hopper = Hopper::with_speeds(draw.uniform(1.8, 2.6), draw.uniform(1.8, 2.6)).unwrap();
            let ground = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, Gravity::new(1.6).unwrap(), &surface);
            let hops = PostHops::new(ground, 1).unwrap();
            let lattice = hops.lattice();
            let takeoff = TakeoffChoice::ALL[draw.below(4)];
            let Some(goal) = hops.nearest_usable(Post { row: 4, col: 4 }) else { continue };
            let found = risks_to_go(&hops, goal, (&errors, takeoff), &()).unwrap();
            let judge = MapJudge::new(hops.ground(), &errors, takeoff);
            let mut expected = vec![f64::INFINITY; lattice.count()];
            expected[lattice.index(goal)] = 0.0;
            loop {
                let before = expected.clone();
                for from in (0..lattice.count()).map(|index| lattice.node(index)) {
                    for number in 0..hops.offset_count() {
                        let Some(to) = hops.landing(from, number) else { continue };
                        let Some(lofts) = hops.lofts(from, number).unwrap() else { continue };
                        let weight = judge.estimate(&hops.position(to).unwrap(), hops.offsets()[number].heading, lofts);
                        assert!(weight >= MapJudge::EACH_HOP, "{weight}");
                        let label = &mut expected[lattice.index(from)];
                        *label = label.min(before[lattice.index(to)] + weight);
                    }
                }
                if expected == before {
                    break;
                }
            }
            for (index, &expected) in expected.iter().enumerate() {
                let found = found.of_post(lattice.node(index));
                assert!(found == expected, "post {index}: {found}, expected {expected}");
                risky += u32::from(expected.is_finite() && expected > 0.2);
                cut_off += u32::from(expected.is_infinite());
            }
        }
        assert!(risky > 100 && cut_off > 50, "{risky} posts with risk, {cut_off} cut off");
    }
}
