//! The answer for one pair, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{hop_margins::HopMarginsRecord, path_record::unsigned_zero};
use crate::{
    ballistics::{Arc, TakeoffChoice, delta_v_m_s},
    chain::Station,
    ground::Surface,
    hop::{Binding, Conflict, HopMargins, HopTest, LimitInterval, ReachAlongSight, SetWindow, Shortfall, TakeoffSet},
    path::heading_deg,
    quantity::{Angle, VertexId},
    world::{Direction, HopperLimits, Limit},
};

/// The answer of `chta hop`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HopAnswer {
    /// The take-off, m.
    pub from_x_m: f64,
    /// The landing, m.
    pub to_x_m: f64,
    /// On a map: the take-off, [easting, northing, height], m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub takeoff_m: Option<[f64; 3]>,
    /// On a map: the landing, [easting, northing, height], m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub landing_m: Option<[f64; 3]>,
    /// On a map: the heading, clockwise from grid north.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heading_deg: Option<f64>,
    /// Direction of travel.
    pub direction: Direction,
    /// Whether a single hop is feasible.
    pub feasible: bool,
    /// The least take-off angle of the window with the hop to fly.
    pub takeoff_angle_min_deg: Option<f64>,
    /// The greatest take-off angle of the window with the hop to fly.
    pub takeoff_angle_max_deg: Option<f64>,
    /// Straight-line distance.
    pub line_of_sight_m: f64,
    /// Elevation angle of the straight line.
    pub line_of_sight_angle_deg: f64,
    /// All windows of feasible take-off angles, ascending; empty if no hop is feasible.
    pub windows: Vec<WindowRecord>,
    /// Each limit separately.
    pub limits: Vec<LimitRecord>,
    /// The limits that set the two ends, or the limits that conflict.
    pub binding: BindingRecord,
    /// The hop to fly, by the scenario's choice of take-off angle.
    pub best: Option<BestRecord>,
    /// The hops of all three choices; empty if no hop is feasible.
    pub choices: Vec<BestRecord>,
    /// By how much the hop to fly keeps each limit; null if no hop is feasible.
    pub margins: Option<HopMarginsRecord>,
    /// The greatest reach towards the landing; null if the ground refuses the take-off or the landing.
    pub greatest_reach: Option<GreatestReachRecord>,
    /// The same at the nearest angle that the cones and the take-off mechanism allow; null if they allow none as well.
    pub greatest_reach_within_cones: Option<GreatestReachRecord>,
    /// Hops along the segment, if both points lie on the same one.
    pub segment_hops: Option<SegmentHopsRecord>,
}

/// One window of feasible take-off angles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WindowRecord {
    /// Its least take-off angle.
    pub takeoff_angle_min_deg: f64,
    /// Its greatest take-off angle.
    pub takeoff_angle_max_deg: f64,
    /// The limit that sets the least angle.
    pub lower: WindowEndRecord,
    /// The limit that sets the greatest angle.
    pub upper: WindowEndRecord,
}

/// The limit that sets one end of a window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WindowEndRecord {
    /// Its name.
    pub limit: Limit,
    /// For the terrain: the vertex that sets the end.
    pub vertex: Option<VertexRecord>,
    /// For the terrain: where between vertices the clearance sets the end, if it does, m along the chain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance_x_m: Option<f64>,
}

/// The take-off angles that one limit allows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LimitRecord {
    /// Its name.
    pub name: Limit,
    /// The least take-off angle it allows; null if it refuses every arc.
    pub min_deg: Option<f64>,
    /// The greatest take-off angle it allows; null if it refuses every arc.
    pub max_deg: Option<f64>,
    /// Between these two, the angles that it refuses: those of arcs slower than the least take-off speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refused_deg: Option<[f64; 2]>,
    /// For the terrain: the vertex that sets the limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertex: Option<VertexRecord>,
    /// For the terrain: where between vertices the clearance sets the limit, if it does, m along the chain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance_x_m: Option<f64>,
    /// The reason, if it refuses every arc.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refusal: Option<String>,
}

/// A vertex of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VertexRecord {
    /// Its number, from 1.
    pub number: usize,
    /// Its x, m.
    pub x_m: f64,
    /// Its height, m.
    pub z_m: f64,
}

/// The limits that set the ends of a feasible set, or the reason why it is empty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum BindingRecord {
    /// Feasible: the limit at either end.
    Ends {
        /// The limit that sets the least take-off angle.
        lower: Limit,
        /// The limit that sets the greatest take-off angle.
        upper: Limit,
        /// For the terrain: the vertex that sets the limit.
        #[serde(skip_serializing_if = "Option::is_none")]
        vertex: Option<VertexRecord>,
        /// For the terrain: where between vertices the clearance sets the limit, if it does, m along the chain.
        #[serde(skip_serializing_if = "Option::is_none")]
        clearance_x_m: Option<f64>,
    },
    /// Empty: one limit that refuses every arc, or two that conflict.
    Conflict {
        /// Their names.
        conflict: Vec<Limit>,
        /// By how many degrees, if the limits are on angles.
        gap_deg: Option<f64>,
        /// By how many m/s a speed falls short, if the limit is on a speed.
        #[serde(skip_serializing_if = "Option::is_none")]
        gap_m_s: Option<f64>,
        /// The vertex.
        #[serde(skip_serializing_if = "Option::is_none")]
        vertex: Option<VertexRecord>,
        /// For the terrain: where between vertices the clearance sets the limit, if it does, m along the chain.
        #[serde(skip_serializing_if = "Option::is_none")]
        clearance_x_m: Option<f64>,
        /// The conflict in one sentence.
        sentence: String,
    },
}

/// The hop to fly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BestRecord {
    /// The choice of take-off angle.
    pub choice: TakeoffChoice,
    /// Take-off angle.
    pub takeoff_angle_deg: f64,
    /// Take-off speed.
    pub takeoff_speed_m_s: f64,
    /// Landing angle.
    pub landing_angle_deg: f64,
    /// Landing speed.
    pub landing_speed_m_s: f64,
    /// Flight time.
    pub flight_time_s: f64,
    /// Highest point above the take-off.
    pub apex_height_m: f64,
    /// Delta-v: of the take-off, of the brakes and the overhead.
    pub delta_v_m_s: f64,
}

/// The greatest reach of one hop along the line of sight at a take-off angle, by the two greatest speeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GreatestReachRecord {
    /// Along the line of sight.
    pub reach_line_of_sight_m: f64,
    /// The same, horizontally.
    pub reach_horizontal_m: f64,
    /// Take-off angle of that hop.
    pub takeoff_angle_deg: f64,
    /// The speed limit that bounds it.
    pub limit: Limit,
    /// Along the line of sight, by the take-off speed.
    pub by_takeoff_speed_m: f64,
    /// Along the line of sight, by the landing speed; null if the hopper brakes, so that its landing speed limits no hop.
    pub by_landing_speed_m: Option<f64>,
}

/// Hops along one segment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SegmentHopsRecord {
    /// The least number of hops.
    pub hops: u64,
    /// The greatest range of one hop along the slope.
    pub reach_line_of_sight_m: f64,
    /// The same, horizontally.
    pub reach_horizontal_m: f64,
    /// Take-off angle of the hop of greatest range.
    pub takeoff_angle_deg: f64,
    /// The same, over the slope of the ground.
    pub takeoff_over_slope_deg: f64,
    /// The limit that bounds the range.
    pub limit: Limit,
}

impl HopAnswer {
    /// The answer for two stations; `None` where they share the same x.
    pub fn new(test: &HopTest, takeoff: &Station, landing: &Station, choice: TakeoffChoice) -> Option<Self> {
        let set = test.takeoff_set(takeoff, landing)?;
        let reach = test.reach_along_sight(takeoff, landing);
        let best = |choice| set.arc(choice, test.gravity_m_s2()).map(|arc| BestRecord::new(&arc, choice, test.hopper().limits()));
        let window = set.arc(choice, test.gravity_m_s2()).and_then(|arc| set.window_of(arc.loft()));
        let angles = window.and_then(|window| set.angles_of(window.lofts));
        let points = [takeoff, landing].map(|station| test.chain().contact_point(station));
        let [takeoff_m, landing_m] = points.map(|point| point.map().map(|at| [at.x, at.y, point.point_m.z]));
        let [from_map, to_map] = points.map(|point| point.map());
        Some(Self {
            from_x_m: takeoff.point.x_m,
            to_x_m: landing.point.x_m,
            takeoff_m,
            landing_m,
            heading_deg: from_map.zip(to_map).map(|(from, to)| heading_deg(from, to)),
            direction: set.direction(),
            feasible: angles.is_some(),
            takeoff_angle_min_deg: angles.map(|a| a.min.degrees()),
            takeoff_angle_max_deg: angles.map(|a| a.max.degrees()),
            line_of_sight_m: set.line_of_sight().length_m(),
            line_of_sight_angle_deg: unsigned_zero(set.line_of_sight().angle().degrees()),
            windows: set.windows().iter().filter_map(|window| WindowRecord::new(test, &set, window)).collect(),
            limits: set.limits().iter().map(|limit| LimitRecord::new(test, &set, limit)).collect(),
            binding: BindingRecord::new(test, &set, window.map(|window| window.binding)),
            best: best(choice),
            choices: TakeoffChoice::ALL.into_iter().filter_map(best).collect(),
            margins: set
                .arc(choice, test.gravity_m_s2())
                .and_then(|arc| HopMargins::of(test, takeoff, landing, &arc))
                .map(HopMarginsRecord),
            greatest_reach: reach.map(|(by_speeds, _)| by_speeds.into()),
            greatest_reach_within_cones: reach.and_then(|(_, within_cones)| within_cones).map(GreatestReachRecord::from),
            segment_hops: SegmentHopsRecord::new(test, takeoff, landing),
        })
    }
}

impl LimitRecord {
    fn new(test: &HopTest, set: &TakeoffSet, limit: &LimitInterval) -> Self {
        let angles = set.angles_of(limit.lofts);
        Self {
            name: limit.limit,
            min_deg: angles.map(|a| a.min.degrees()),
            max_deg: angles.map(|a| a.max.degrees()),
            refused_deg: limit.gap.and_then(|gap| set.angles_of(gap)).map(|a| [a.min.degrees(), a.max.degrees()]),
            vertex: limit.vertex.map(|vertex| VertexRecord::new(test, vertex)),
            clearance_x_m: limit.kink_x_m,
            refusal: limit.shortfall.map(|shortfall| shortfall.to_string()),
        }
    }
}

impl WindowRecord {
    fn new(test: &HopTest, set: &TakeoffSet, window: &SetWindow) -> Option<Self> {
        let angles = set.angles_of(window.lofts)?;
        let end = |limit: &LimitInterval| WindowEndRecord {
            limit: limit.limit,
            vertex: limit.vertex.map(|vertex| VertexRecord::new(test, vertex)),
            clearance_x_m: limit.kink_x_m,
        };
        Some(Self {
            takeoff_angle_min_deg: angles.min.degrees(),
            takeoff_angle_max_deg: angles.max.degrees(),
            lower: end(&window.binding.lower),
            upper: end(&window.binding.upper),
        })
    }
}

impl VertexRecord {
    fn new(test: &HopTest, vertex: VertexId) -> Self {
        let point = test.chain().geometry().vertices()[vertex.index()];
        Self { number: vertex.index() + 1, x_m: point.x_m, z_m: point.z_m }
    }
}

impl BindingRecord {
    fn new(test: &HopTest, set: &TakeoffSet, binding: Option<Binding>) -> Self {
        if let Some(binding) = binding {
            return Self::Ends {
                lower: binding.lower.limit,
                upper: binding.upper.limit,
                vertex: binding.lower.vertex.map(|vertex| VertexRecord::new(test, vertex)),
                clearance_x_m: binding.lower.kink_x_m,
            };
        }
        match set.conflict() {
            Some(conflict) => Self::of_conflict(test, &conflict),
            None => Self::Conflict {
                conflict: Vec::new(),
                gap_deg: None,
                gap_m_s: None,
                vertex: None,
                clearance_x_m: None,
                sentence: String::new(),
            },
        }
    }

    /// The record of a conflict.
    pub fn of_conflict(test: &HopTest, conflict: &Conflict) -> Self {
        Self::of_conflict_at(conflict, |limit| limit.vertex.map(|vertex| VertexRecord::new(test, vertex)))
    }

    /// The same with the vertex of a limit found by the caller.
    pub(super) fn of_conflict_at(conflict: &Conflict, vertex_of: impl Fn(&LimitInterval) -> Option<VertexRecord>) -> Self {
        let sentence = conflict.to_string();
        let (names, gap_deg, gap_m_s, at) = match conflict {
            Conflict::Alone(alone) => {
                let (gap_deg, gap_m_s) = match alone.shortfall {
                    Some(Shortfall::Ground { refusal, .. }) => (refusal.excess_deg(), None),
                    Some(Shortfall::Speed { needed_m_s, limit_m_s }) => (None, Some(needed_m_s - limit_m_s)),
                    Some(Shortfall::Height { .. } | Shortfall::Bend { .. } | Shortfall::Flight { .. }) | None => (None, None),
                };
                (vec![alone.limit], gap_deg, gap_m_s, alone)
            }
            Conflict::Pair { lower, upper, gap_deg } => (vec![lower.limit, upper.limit], Some(*gap_deg), None, lower),
            Conflict::Commands { limit, other, left_m_s: [least, greatest], nearest_m_s } => {
                (vec![*limit, other.limit], None, Some((least - nearest_m_s).max(nearest_m_s - greatest)), other)
            }
        };
        Self::Conflict { conflict: names, gap_deg, gap_m_s, vertex: vertex_of(at), clearance_x_m: at.kink_x_m, sentence }
    }
}

impl BestRecord {
    /// The hop of an arc.
    pub(super) fn new(arc: &Arc, choice: TakeoffChoice, limits: &HopperLimits) -> Self {
        Self {
            choice,
            takeoff_angle_deg: arc.takeoff_angle().degrees(),
            takeoff_speed_m_s: arc.takeoff_speed_m_s(),
            landing_angle_deg: arc.landing_angle().degrees(),
            landing_speed_m_s: arc.landing_speed_m_s(),
            flight_time_s: arc.flight_time_s(),
            apex_height_m: arc.apex_height_m(),
            delta_v_m_s: delta_v_m_s(arc, limits),
        }
    }
}

impl From<ReachAlongSight> for GreatestReachRecord {
    fn from(reach: ReachAlongSight) -> Self {
        Self {
            reach_line_of_sight_m: reach.reach_m(),
            reach_horizontal_m: reach.reach_horizontal_m(),
            takeoff_angle_deg: reach.takeoff_angle().degrees(),
            limit: reach.limit(),
            by_takeoff_speed_m: reach.by_takeoff_speed_m(),
            by_landing_speed_m: Some(reach.by_landing_speed_m()).filter(|reach_m| reach_m.is_finite()),
        }
    }
}

impl SegmentHopsRecord {
    fn new(test: &HopTest, takeoff: &Station, landing: &Station) -> Option<Self> {
        let hops = test.segment_hops(takeoff, landing)?;
        let reach = hops.reach();
        let takeoff_angle_deg = Angle::from_slope(reach.takeoff_slope()).degrees();
        Some(Self {
            hops: hops.hops(),
            reach_line_of_sight_m: reach.reach_line_of_sight_m(),
            reach_horizontal_m: reach.reach_m(),
            takeoff_angle_deg,
            takeoff_over_slope_deg: takeoff_angle_deg - Angle::from_slope(reach.sight_slope()).degrees(),
            limit: reach.limit(),
        })
    }
}
