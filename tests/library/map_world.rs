//! Random worlds for hop maps: a DEM with overlays, a robot, and the direct method for their hops.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]

use std::error::Error;

use chta::{
    chain::{ConstrainedChain, PolygonalChain},
    ground::DemGround,
    hop::HopTest,
    quantity::{Angle, AngleInterval, MapPoint, SlopeInterval, VertexId},
    reach::map::{Journey, NO_GROUND, Post, UNREACHED},
    terrain::{Dem, FrictionRaster, GeoReference, KeepOut, OverlaidDem, Overlays, Profile, Surroundings, slice},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

use crate::support::Draw;

/// A terrain with overlays, and a robot.
pub(crate) struct World {
    pub(crate) dem: Dem,
    pub(crate) hopper: Hopper,
    pub(crate) surface: SurfaceProperties,
    pub(crate) gravity_m_s2: f64,
    pub(crate) friction: Option<FrictionRaster>,
    pub(crate) keep_out: Option<KeepOut>,
}

impl World {
    pub(crate) fn new(dem: Dem, hopper: Hopper, surface: SurfaceProperties, gravity_m_s2: f64) -> Self {
        Self { dem, hopper, surface, gravity_m_s2, friction: None, keep_out: None }
    }

    /// The changes that `chta slice` and the reading of its chain make to a profile.
    pub(crate) fn chain(&self, mut profile: Profile) -> Result<ConstrainedChain, Box<dyn Error + Send + Sync>> {
        let constant = match self.surface.grip {
            Some(Grip::Friction(cone)) => Some(cone),
            _ => None,
        };
        if let Some(raster) = &self.friction {
            raster.lay(&mut profile, constant)?;
        }
        if let Some(zones) = &self.keep_out {
            zones.mark(&mut profile)?;
        }
        let geometry = PolygonalChain::from_profile(&profile, constant)?;
        let (dem, gravity) = (Surroundings::whole(self.dem.clone().into()), Gravity::new(self.gravity_m_s2).unwrap());
        Ok(ConstrainedChain::on_dem(dem.into(), geometry, &self.hopper, gravity, &self.surface)?)
    }

    /// The ground for the fast form.
    pub(crate) fn ground(&self) -> DemGround {
        let overlays = Overlays::new(self.friction.clone(), self.keep_out.clone());
        let terrain = OverlaidDem::new(self.dem.clone(), overlays);
        DemGround::new(terrain, &self.hopper, Gravity::new(self.gravity_m_s2).unwrap(), &self.surface)
    }

    /// The direct method: slice, chain, hop test.
    pub(crate) fn lofts(&self, from: Post, to: Post) -> Option<SlopeInterval> {
        let map = self.dem.georeference();
        let profile = slice(&self.dem, map.post(from.row, from.col), map.post(to.row, to.col)).ok()?;
        let chain = self.chain(profile).unwrap();
        let test = HopTest::new(chain.clone());
        let geometry = chain.geometry();
        test.lofts(&geometry.vertex_station(VertexId(0)), &geometry.vertex_station(VertexId(geometry.segment_count()))).ok()
    }

    /// Whether a pair lies within the parabolas of safety of both speeds, slightly widened; beyond them only speed matters.
    pub(crate) fn within_safety(&self, from: Post, to: Post) -> bool {
        let map = self.dem.georeference();
        let height = |post: Post| self.dem.elevation(post.row, post.col).unwrap_or(f64::NAN);
        let (run_m, rise_m) = ((map.post(to.row, to.col) - map.post(from.row, from.col)).norm(), height(to) - height(from));
        let reaches = |speed: f64, rise_m: f64| self.gravity_m_s2 * (rise_m + run_m.hypot(rise_m)) <= speed * speed * 1.001;
        reaches(self.hopper.limits().takeoff_speed_max_m_s, rise_m) && reaches(self.hopper.limits().landing_speed_max_m_s, -rise_m)
    }

    pub(crate) fn posts(&self, stride: usize) -> Vec<Post> {
        let rows = (0..self.dem.rows()).step_by(stride);
        rows.flat_map(|row| (0..self.dem.cols()).step_by(stride).map(move |col| Post { row, col })).collect()
    }

    /// Fewest hops by the direct method over all pairs within the parabolas of safety (the test of random grids takes all pairs).
    pub(crate) fn plain_map(&self, start: Post, stride: usize, journey: Journey) -> Vec<i16> {
        let posts = self.posts(stride);
        let no_ground = |post: &Post| self.dem.elevation(post.row, post.col).is_none();
        let mut hops: Vec<i16> = posts.iter().map(|post| if no_ground(post) { NO_GROUND } else { UNREACHED }).collect();
        hops[posts.iter().position(|&post| post == start).unwrap()] = 0;
        for layer in 0.. {
            let layer_posts: Vec<usize> = (0..posts.len()).filter(|&i| hops[i] == layer).collect();
            if layer_posts.is_empty() {
                break;
            }
            for to in 0..posts.len() {
                let joins = |&from: &usize| {
                    let (from, to) = if journey == Journey::Outbound { (posts[from], posts[to]) } else { (posts[to], posts[from]) };
                    self.within_safety(from, to) && self.lofts(from, to).is_some()
                };
                if hops[to] == UNREACHED && layer_posts.iter().any(joins) {
                    hops[to] = layer + 1;
                }
            }
        }
        hops
    }
}

pub(crate) fn friction(mu: f64) -> SurfaceProperties {
    SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(mu).unwrap())), rest: RestSlope::AsFrictionHolds }
}

/// Ground for tests: rough or of steps on round numbers, with or without holes.
pub(crate) fn random_dem(draw: &mut Draw, side: usize) -> Dem {
    let stepped = draw.chance(0.4);
    let relief_m = draw.log_uniform(0.02, 6.0);
    let holes = if draw.chance(0.4) { 0.06 } else { 0.0 };
    let tilt = draw.uniform(-0.4, 0.4);
    let mut heights = Vec::new();
    for row in 0..side {
        for _ in 0..side {
            let rough = if stepped { f64::from(u8::try_from(draw.below(3)).unwrap()) * 0.5 } else { draw.unit() * relief_m };
            let plane = if stepped { 0.0 } else { tilt * f64::from(u8::try_from(row).unwrap()) };
            heights.push(if draw.chance(holes) { f64::NAN } else { rough + plane });
        }
    }
    let (dx_m, dy_m) = if draw.chance(0.3) { (1.0, 1.7) } else { (1.0, 1.0) };
    let north_west = if draw.chance(0.3) { MapPoint::new(-98_765.4, 1.0e6 + 0.3) } else { MapPoint::new(0.0, 0.0) };
    Dem::new(side, side, heights, GeoReference::local(north_west, dx_m, dy_m).unwrap()).unwrap()
}

pub(crate) fn random_hopper(draw: &mut Draw) -> (Hopper, f64) {
    let gravity = draw.log_uniform(0.05, 10.0);
    let speed = (gravity * draw.uniform(2.0, 9.0)).sqrt();
    let mut limits = HopperLimits {
        clearance_m: if draw.chance(0.5) { 0.0 } else { draw.log_uniform(0.001, 1.0) },
        clearance_rule: draw.clearance_rule(),
        ..HopperLimits::with_speeds(speed, speed * draw.uniform(0.7, 1.4))
    };
    if draw.chance(0.25) {
        limits.apex_height_max_m = Some(draw.uniform(0.3, 4.0));
    }
    if draw.chance(0.25) {
        limits.flight_time_max_s = Some(draw.uniform(0.5, 3.0) * speed / gravity);
    }
    if draw.chance(0.25) {
        limits.takeoff_angle_min = Some(Angle::from_degrees(draw.uniform(0.0, 50.0)));
        limits.takeoff_angle_max = Some(Angle::from_degrees(draw.uniform(50.0, 90.0)));
    }
    if draw.chance(0.2) {
        limits.footprint_m = Some(draw.log_uniform(0.1, 4.0));
        limits.roughness_max_m = draw.chance(0.6).then(|| draw.log_uniform(0.01, 1.0));
    }
    draw.commands(&mut limits, speed);
    (Hopper::new(limits).unwrap(), gravity)
}

pub(crate) fn random_surface(draw: &mut Draw) -> SurfaceProperties {
    let rest = match draw.below(3) {
        0 => RestSlope::Unlimited,
        1 => RestSlope::AtMost(Angle::from_degrees(draw.uniform(5.0, 50.0))),
        _ => RestSlope::AsFrictionHolds,
    };
    let grip = if draw.chance(0.3) {
        Grip::FromSlope {
            takeoff: AngleInterval::from_degrees(draw.uniform(-100.0, 60.0), draw.uniform(60.0, 100.0)),
            landing: AngleInterval::from_degrees(draw.uniform(-100.0, -60.0), draw.uniform(-60.0, 100.0)),
        }
    } else {
        Grip::Friction(FrictionCone::new(draw.log_uniform(0.1, 3.0)).unwrap())
    };
    SurfaceProperties { grip: Some(grip), rest }
}
