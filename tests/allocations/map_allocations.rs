//! The map's kernel allocates no memory except for one pair in thousands that needs the slice and the hop test.

#![allow(clippy::unwrap_used, reason = "a test that cannot set its scene should stop")]

use chta::{
    ground::DemGround,
    reach::map::{Post, PostHops},
    terrain::{OverlaidDem, Overlays, SyntheticTerrain, synthesise},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};
use stats_alloc::Region;

use crate::{ALLOCATOR, alone};

#[test]
fn rough_ground_needs_an_allocation_for_at_most_one_pair_in_a_thousand() {
    let _guard = alone();
    let dem = synthesise(&SyntheticTerrain { rows: 80, cols: 80, seed: 5, ..SyntheticTerrain::default() }).unwrap();
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(3.5, 3.5) }).unwrap();
    let friction = FrictionCone::new(0.6).unwrap();
    let surface = SurfaceProperties { grip: Some(Grip::Friction(friction)), rest: RestSlope::AsFrictionHolds };
    let terrain = OverlaidDem::new(dem, Overlays::default());
    let ground = DemGround::new(terrain, &hopper, Gravity::new(1.624).unwrap(), &surface);
    let hops = PostHops::new(ground, 1).unwrap();
    let (mut feasible, mut refused, mut exact) = (0u32, 0u32, 0u32);
    for row in 30..50 {
        for col in 30..50 {
            for offset in 0..hops.offset_count() {
                let region = Region::new(ALLOCATOR);
                let found = hops.lofts(Post { row, col }, offset).unwrap();
                exact += u32::from(region.change().allocations > 0);
                if found.is_some() { feasible += 1 } else { refused += 1 }
            }
        }
    }
    assert!(feasible > 10_000 && refused > 10_000, "the pairs are all alike: {feasible} feasible, {refused} refused");
    assert!(exact <= (feasible + refused) / 1000, "{exact} of {} pairs needed the exact code", feasible + refused);
}
