//! One straight leg over the exact slice of a triangulated DEM.

use nalgebra::Vector2;

use super::{DriveRefusal, wheels::Axles};
use crate::{
    ground::{DemGround, MapPosition, Surface},
    quantity::MapPoint,
    terrain::{FootprintFit, Profile, Surroundings, TerrainError, slice},
    world::Rover,
};

/// By how much a slope may exceed its limit, rad, and a height its own, as a share of the wheelbase: slopes, steps and fits are exact,
/// but they round, and a limit that touches is kept.
const TOLERANCE: f64 = 1e-9;

/// A DEM, with its keep-out zones, its gravity and a rover: judges and prices straight legs.
///
/// A leg consists of the pieces of its slice, one on each facet that it crosses. With the heading `h`, the unit vector `h'` to its left
/// and the gradient `p` of a facet, its slopes are the tangents
///
/// ```text
///     along   s = p . h      up where s > 0, down where s < 0
///     across  |p . h'| = |n . h'| / n_z,    n the normal of the facet
/// ```
///
/// A leg along the common edge of two facets obeys both: their slopes along it are the same, and the steeper one across it counts.
#[derive(Clone, Debug)]
pub struct DriveGround<'a> {
    ground: &'a DemGround,
    rover: &'a Rover,
    gravity_m_s2: f64,
    /// The greatest tangents up, down and across with their tolerance.
    ceilings: [f64; 3],
    /// The greatest step and residual with theirs, m; infinite where nothing limits them.
    heights_m: [f64; 2],
    /// The posts under the wheels, where the roughness is limited.
    posts: Option<Surroundings>,
}

/// A greatest value on a leg, and where: a distance along the leg from its beginning, m; of slopes, the middle of the piece.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Extreme {
    /// The value: the tangent of a slope, or a height in m.
    pub value: f64,
    /// Where, m along the leg.
    pub at_m: f64,
}

impl Extreme {
    /// Takes a greater value.
    pub(super) const fn raise(&mut self, value: f64, at_m: f64) {
        if value > self.value {
            *self = Self { value, at_m };
        }
    }
}

/// What a straight leg is and takes.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct DriveLeg {
    /// The horizontal length, m.
    pub run_m: f64,
    /// The length in three dimensions, the sum over all pieces, m.
    pub length_m: f64,
    /// All height gained, m.
    pub climb_m: f64,
    /// All height lost, m; positive.
    pub descent_m: f64,
    /// Time at the speed of each piece's slope, s.
    pub time_s: f64,
    /// Energy from the store per unit mass, J/kg, idle power while driving included and while turning before it left out.
    pub energy_j_kg: f64,
    /// The steepest climb, its tangent; 0 where nothing climbs.
    pub steepest_up: Extreme,
    /// The steepest descent, its tangent, positive; 0 where nothing descends.
    pub steepest_down: Extreme,
    /// The steepest slope across, its tangent; 0 on ground that is level across.
    pub steepest_across: Extreme,
    /// The greatest difference of height between the axles, m, where it is limited.
    pub step: Option<Extreme>,
    /// The greatest residual off the planes fitted at the two ends, m, where it is limited.
    pub roughness: Option<Extreme>,
}

impl<'a> DriveGround<'a> {
    /// The ground of a rover.
    ///
    /// `ground` gives the DEM with its keep-out zones, and gravity; its hopper and its friction have no effect.
    pub fn new(ground: &'a DemGround, rover: &'a Rover) -> Self {
        let limits = rover.limits();
        let tolerance = TOLERANCE + ground.slope_rounding();
        let ceilings = rover.slopes().map(|max| max + tolerance * (1.0 + max * max));
        let rounding_m = TOLERANCE * limits.wheelbase_m.unwrap_or(0.0) + 4.0 * ground.height_rounding_m();
        let height = |max_m: Option<f64>| max_m.map_or(f64::INFINITY, |max_m| max_m + rounding_m);
        Self {
            ground,
            rover,
            gravity_m_s2: ground.gravity().m_s2(),
            ceilings,
            heights_m: [height(limits.step_max_m), height(limits.roughness_max_m)],
            posts: limits.roughness_max_m.map(|_| Surroundings::whole(ground.terrain().shared_dem())),
        }
    }

    /// The ground with its zones and gravity.
    pub const fn ground(&self) -> &'a DemGround {
        self.ground
    }

    /// The rover.
    pub const fn rover(&self) -> &'a Rover {
        self.rover
    }

    /// The straight leg from one position to another over the exact slice of the triangulated DEM. A leg without length takes nothing.
    ///
    /// # Errors
    /// [`DriveRefusal`]: the first limit, in the order of [`DriveLimit`](super::DriveLimit), that the leg exceeds.
    ///
    /// # Examples
    /// ```
    /// use chta::{drive::DriveGround, ground::DemGround, quantity::{Angle, MapPoint}, terrain::{Dem, GeoReference, OverlaidDem, Overlays}, world::{Gravity, Hopper, RestSlope, Rover, RoverLimits, SurfaceProperties}};
    /// // A plane that rises by 1 in 5 to the east.
    /// let posts = (0..36).map(|post| 0.2 * f64::from(post % 6)).collect();
    /// let dem = Dem::new(6, 6, posts, GeoReference::local(MapPoint::new(0.0, 5.0), 1.0, 1.0)?)?;
    /// let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
    /// let ground = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &Hopper::with_speeds(1.0, 1.0)?, Gravity::new(1.62)?, &surface);
    /// let limits = RoverLimits { slope_down_max: Some(Angle::from_degrees(5.0)), ..RoverLimits::new(0.1, Angle::from_degrees(12.0)) };
    /// let rover = Rover::new(limits, None)?;
    /// let drive = DriveGround::new(&ground, &rover);
    /// let [west, east] = [1.0, 4.0].map(|x_m| ground.position(MapPoint::new(x_m, 2.0)).unwrap());
    /// let leg = drive.leg(&west, &east)?;
    /// assert!((leg.climb_m - 0.6).abs() < 1e-12 && (leg.time_s - 10.0 * 3.0f64.hypot(0.6)).abs() < 1e-9);
    /// assert_eq!(drive.leg(&east, &west).unwrap_err().name(), "slope-down");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn leg(&self, from: &MapPosition, to: &MapPosition) -> Result<DriveLeg, DriveRefusal> {
        let Some((run_m, heading)) = self.ground.course(from, to) else { return self.standing(from.at) };
        let mut profile = self.slice(from.at, to.at, 0.0)?;
        self.keep_out(&mut profile)?;
        self.layers(from.at, to.at)?;
        let mut leg = self.along(&profile);
        leg.run_m = run_m;
        self.check_slopes(&leg)?;
        leg.step = self.step(from.at, to.at, heading)?;
        leg.roughness = self.roughness(from, to, run_m)?;
        Ok(leg)
    }

    /// A leg without length.
    fn standing(&self, at: MapPoint) -> Result<DriveLeg, DriveRefusal> {
        if self.ground.position(at).is_none() {
            return Err(DriveRefusal::NoGround { at_m: 0.0 });
        }
        if self.ground.terrain().overlays().keeps_out(at) {
            return Err(DriveRefusal::KeepOut { at_m: 0.0 });
        }
        self.layers(at, at)?;
        Ok(DriveLeg::default())
    }

    /// The slice of the DEM without overlays; places on it are counted from `before_m` before the leg's beginning.
    fn slice(&self, from: MapPoint, to: MapPoint, before_m: f64) -> Result<Profile, DriveRefusal> {
        slice(self.ground.terrain().dem(), from, to).map_err(|error| {
            let at_m = match error {
                TerrainError::NoData { distance_m, .. } => distance_m,
                TerrainError::OffTheMap { which: "to", .. } => (to - from).norm(),
                _ => 0.0,
            };
            DriveRefusal::NoGround { at_m: at_m - before_m }
        })
    }

    /// Lays the keep-out zones over a slice and refuses one that enters them.
    fn keep_out(&self, profile: &mut Profile) -> Result<(), DriveRefusal> {
        for zones in self.ground.terrain().overlays().zones() {
            // A mask that does not cover the leg says nothing of it: what is not known is not allowed.
            zones.mark(profile).map_err(|_| DriveRefusal::KeepOut { at_m: 0.0 })?;
        }
        match profile.facets.iter().position(|facet| facet.keep_out) {
            Some(piece) => Err(DriveRefusal::KeepOut { at_m: profile.points[piece].x_m }),
            None => Ok(()),
        }
    }

    /// Refuses a leg along which a layer does not hold: wheels touch the ground all the way.
    fn layers(&self, from: MapPoint, to: MapPoint) -> Result<(), DriveRefusal> {
        let refusing = self.ground.terrain().overlays().layers().refusing_wheels(from, to);
        refusing.map_or(Ok(()), |layer| Err(DriveRefusal::Layer { layer }))
    }

    /// Whether a layer refuses the leg.
    pub(super) fn is_refused_by_layer(&self, from: &MapPosition, to: &MapPosition) -> bool {
        self.layers(from.at, to.at).is_err()
    }

    /// Whether the leg has ground and enters a keep-out zone.
    pub(super) fn is_kept_out(&self, from: &MapPosition, to: &MapPosition) -> bool {
        self.slice(from.at, to.at, 0.0).is_ok_and(|mut profile| self.keep_out(&mut profile).is_err())
    }

    /// The greatest tangents up, down and across with their tolerance.
    pub(super) const fn ceilings(&self) -> [f64; 3] {
        self.ceilings
    }

    /// The greatest step and residual with their tolerance, m; infinite where nothing limits them.
    pub(super) const fn heights_m(&self) -> [f64; 2] {
        self.heights_m
    }

    /// Gravity, m/s^2.
    pub(super) const fn gravity_m_s2(&self) -> f64 {
        self.gravity_m_s2
    }

    /// What the pieces of a slice take together.
    fn along(&self, profile: &Profile) -> DriveLeg {
        let mut leg = DriveLeg::default();
        let heading = profile.heading;
        for (ends, facet) in profile.points.windows(2).zip(&profile.facets) {
            let (run_m, middle_m) = (ends[1].x_m - ends[0].x_m, 0.5 * (ends[0].x_m + ends[1].x_m));
            // The slopes of the facet, not of the piece, which may be so short that its heights round.
            let gradient = Vector2::new(-facet.normal.x, -facet.normal.y) / facet.normal.z;
            let slope = gradient.dot(&heading);
            let across = gradient.perp(&heading).abs();
            let length_m = run_m * (1.0 + slope * slope).sqrt();
            leg.length_m += length_m;
            leg.climb_m += run_m * slope.max(0.0);
            leg.descent_m += run_m * (-slope).max(0.0);
            leg.time_s += length_m / self.rover.speed_m_s(slope);
            leg.energy_j_kg += length_m * self.rover.energy_j_kg_m(slope, self.gravity_m_s2);
            leg.steepest_up.raise(slope, middle_m);
            leg.steepest_down.raise(-slope, middle_m);
            leg.steepest_across.raise(across, middle_m);
        }
        leg
    }

    fn check_slopes(&self, leg: &DriveLeg) -> Result<(), DriveRefusal> {
        let [up, down, across] = self.ceilings;
        let [max_up, max_down, max_across] = self.rover.slopes();
        let Extreme { value: slope, at_m } = leg.steepest_up;
        if slope > up {
            return Err(DriveRefusal::SlopeUp { slope, max: max_up, at_m });
        }
        let Extreme { value: slope, at_m } = leg.steepest_down;
        if slope > down {
            return Err(DriveRefusal::SlopeDown { slope, max: max_down, at_m });
        }
        let Extreme { value: slope, at_m } = leg.steepest_across;
        if slope > across {
            return Err(DriveRefusal::CrossSlope { slope, max: max_across, at_m });
        }
        Ok(())
    }

    /// The greatest step while both axles are within the leg, extended by half a wheelbase at each end.
    fn step(&self, from: MapPoint, to: MapPoint, heading: Vector2<f64>) -> Result<Option<Extreme>, DriveRefusal> {
        let limits = self.rover.limits();
        let (Some(max_m), Some(base_m)) = (limits.step_max_m, limits.wheelbase_m) else { return Ok(None) };
        let half_m = 0.5 * base_m;
        let profile = self.slice(from - heading * half_m, to + heading * half_m, half_m)?;
        let (x_m, z_m): (Vec<f64>, Vec<f64>) = profile.points.iter().map(|point| (point.x_m - half_m, point.z_m)).unzip();
        let step = Axles::new(&x_m, base_m).map(|axles| axles.greatest(&z_m)).unwrap_or_default();
        if step.value > self.heights_m[0] {
            return Err(DriveRefusal::Step { step_m: step.value, max_m, at_m: step.at_m });
        }
        Ok(Some(step))
    }

    /// The greatest residual at the two ends.
    fn roughness(&self, from: &MapPosition, to: &MapPosition, run_m: f64) -> Result<Option<Extreme>, DriveRefusal> {
        let Some(max_m) = self.rover.limits().roughness_max_m else { return Ok(None) };
        let mut greatest = Extreme::default();
        for (end, at_m) in [(from, 0.0), (to, run_m)] {
            let residual_m = self.residual_m(end).ok_or(DriveRefusal::NoGround { at_m })?;
            greatest.raise(residual_m, at_m);
        }
        if greatest.value > self.heights_m[1] {
            return Err(DriveRefusal::Roughness { residual_m: greatest.value, max_m, at_m: greatest.at_m });
        }
        Ok(Some(greatest))
    }

    /// The greatest distance of the ground from the plane fitted over a disc of the wheelbase, m; `None` where a part of that is not known.
    pub(super) fn residual_m(&self, position: &MapPosition) -> Option<f64> {
        let (posts, base_m) = (self.posts.as_ref()?, self.rover.limits().wheelbase_m?);
        let fit: Result<FootprintFit, _> = posts.fit(position.at, position.z_m, base_m);
        fit.ok().map(|fit| fit.residual_m)
    }
}
