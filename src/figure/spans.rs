//! Stretches of ground by the contacts that they allow.

use crate::{
    chain::{ConstrainedChain, FootprintRefusal, GroundRefusal, SegmentConstraints, Station},
    quantity::{ChainPoint, SegmentId},
    world::{Contact, Direction},
};

/// Why a stretch of ground allows neither take-off nor landing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Closure {
    /// A keep-out zone.
    KeepOut,
    /// A layer of the map does not hold.
    Layer,
    /// Too steep to rest on.
    RestSlope,
    /// The plane fitted over the footprint is too steep, or the ground under the footprint is not known.
    FootprintSlope,
    /// The ground under the footprint is too rough.
    Roughness,
    /// The cones contain no direction of travel: the plane misses the friction cone, or the cone lies beyond the vertical.
    Cones,
    /// A speed limit of zero.
    SpeedZero,
    /// The chain states no limits.
    NoLimits,
}

impl Closure {
    /// All closures, in the order of the legend.
    pub const ALL: [Self; 8] = [
        Self::KeepOut,
        Self::Layer,
        Self::RestSlope,
        Self::FootprintSlope,
        Self::Roughness,
        Self::Cones,
        Self::SpeedZero,
        Self::NoLimits,
    ];

    /// The legend text.
    pub const fn text(self) -> &'static str {
        match self {
            Self::KeepOut => "no contact: keep-out zone",
            Self::Layer => "no contact: a layer does not hold",
            Self::RestSlope => "no contact: too steep to rest on",
            Self::FootprintSlope => "no contact: too steep under the footprint",
            Self::Roughness => "no contact: too rough",
            Self::Cones => "no contact: no grip in the plane of travel",
            Self::SpeedZero => "no contact: speed limit 0",
            Self::NoLimits => "no contact: none stated",
        }
    }

    const fn of(refusal: &GroundRefusal) -> Self {
        match refusal {
            GroundRefusal::KeepOut => Self::KeepOut,
            GroundRefusal::Layer(_) => Self::Layer,
            GroundRefusal::TooSteep { .. } => Self::RestSlope,
            GroundRefusal::Footprint(FootprintRefusal::TooRough { .. }) => Self::Roughness,
            GroundRefusal::Footprint(_) => Self::FootprintSlope,
            GroundRefusal::CrossSlope { .. }
            | GroundRefusal::NothingAhead { .. }
            | GroundRefusal::FacesDown { .. }
            | GroundRefusal::FacetsDisagree { .. } => Self::Cones,
            // A landing alone: such ground allows take-offs, or is closed for their reason.
            GroundRefusal::TouchdownSlope { .. } | GroundRefusal::TouchdownCone { .. } | GroundRefusal::TouchdownSpeed { .. } => {
                Self::Cones
            }
            GroundRefusal::SpeedZero => Self::SpeedZero,
            GroundRefusal::NoGround => Self::NoLimits,
        }
    }
}

/// The contacts that a stretch of ground allows in any direction of travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GroundUse {
    /// Take-off and landing.
    Both,
    /// Landing, but no take-off.
    LandingOnly,
    /// Take-off, but no landing.
    TakeoffOnly,
    /// Neither, with the reason.
    Closed(Closure),
}

/// A stretch of ground with the same use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundSpan {
    /// Its left end, m.
    pub from_x_m: f64,
    /// Its right end, m.
    pub to_x_m: f64,
    /// Its use.
    pub allows: GroundUse,
}

/// The use of the ground around a station that a segment rules: that of the segment, unless a layer or the hopper's footprint closes it.
fn use_at(chain: &ConstrainedChain, station: &Station, id: SegmentId, of_segment: GroundUse) -> GroundUse {
    if of_segment == GroundUse::Closed(Closure::KeepOut) || of_segment == GroundUse::Closed(Closure::NoLimits) {
        return of_segment;
    }
    chain.refusal_at(station, id).map_or(of_segment, |refusal| GroundUse::Closed(Closure::of(&refusal)))
}

/// The x that divide a stretch so finely that the use of each part is that of its middle, m: where a layer begins or ends to hold, and with
/// a footprint quarters of it, but no more than a picture shows.
fn divided(chain: &ConstrainedChain, (from, to): (f64, f64), of_m: f64) -> Vec<f64> {
    /// More parts than this over the whole picture cannot be told apart in it.
    const PARTS: f64 = 2000.0;
    let step_m = chain.footprint().map_or(f64::INFINITY, |footprint| (0.25 * footprint.diameter_m).max(of_m / PARTS));
    let inner = (1..).map(|i| from + f64::from(i) * step_m).take_while(|x_m| *x_m < to);
    let mut divided: Vec<f64> = std::iter::once(from).chain(inner).chain([to]).collect();
    if let Some(layers) = chain.geometry().layers() {
        divided.extend(layers.contact_ends_m().filter(|x_m| from < *x_m && *x_m < to));
        divided.sort_by(f64::total_cmp);
    }
    divided
}

/// The use of one segment. The reason of a closed one is that for the journey's direction, unless the chain states no limits for
/// that direction.
fn use_of(segment: &SegmentConstraints, towards: Direction) -> GroundUse {
    let allowed = |contact| Direction::BOTH.into_iter().any(|direction| segment.allowed(contact, direction).is_some());
    match (allowed(Contact::Takeoff), allowed(Contact::Landing)) {
        (true, true) => GroundUse::Both,
        (false, true) => GroundUse::LandingOnly,
        (true, false) => GroundUse::TakeoffOnly,
        (false, false) => {
            let away = if towards == Direction::Forward { Direction::Reverse } else { Direction::Forward };
            let refusals =
                [towards, away].into_iter().filter_map(|direction| segment.check_contact(Contact::Takeoff, direction).err());
            let refusal = refusals.min_by_key(|refusal| matches!(refusal, GroundRefusal::NoGround));
            GroundUse::Closed(refusal.as_ref().map_or(Closure::NoLimits, Closure::of))
        }
    }
}

/// The stretches of ground within a range of x, from left to right; neighbours of the same use are merged.
pub(super) fn spans(chain: &ConstrainedChain, (from_x_m, to_x_m): (f64, f64), towards: Direction) -> Vec<GroundSpan> {
    let vertices = chain.geometry().vertices();
    let mut found: Vec<GroundSpan> = Vec::new();
    for (i, ends) in vertices.windows(2).enumerate() {
        let (from, to) = (ends[0].x_m.max(from_x_m), ends[1].x_m.min(to_x_m));
        let Some(segment) = chain.segments().get(SegmentId(i).index()).filter(|_| from < to) else { continue };
        let of_segment = use_of(segment, towards);
        for part in divided(chain, (from, to), to_x_m - from_x_m).windows(2) {
            let middle = chain.geometry().station_inside(SegmentId(i), 0.5 * (part[0] + part[1]));
            let allows = use_at(chain, &middle, SegmentId(i), of_segment);
            match found.last_mut() {
                Some(last) if last.allows == allows => last.to_x_m = part[1],
                _ => found.push(GroundSpan { from_x_m: part[0], to_x_m: part[1], allows }),
            }
        }
    }
    found
}

/// The chain between two x of its extent: its vertices there, and the points at the two ends.
pub(super) fn stretch(chain: &ConstrainedChain, from_x_m: f64, to_x_m: f64) -> Vec<ChainPoint> {
    let geometry = chain.geometry();
    let vertices = geometry.vertices();
    let first = vertices.partition_point(|v| v.x_m <= from_x_m);
    let end = vertices.partition_point(|v| v.x_m < to_x_m).max(first);
    let at = |x_m| geometry.station(x_m).ok().map(|station| station.point);
    at(from_x_m).into_iter().chain(vertices[first..end].iter().copied()).chain(at(to_x_m)).collect()
}
