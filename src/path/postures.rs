//! The key postures of a hop of a robot with legs: take-off, last contact, apex, first contact, landing.
//!
//! ```text
//!      take-off   last contact        apex        first contact   landing
//!        [==]        [==]             [==]            [==]          [==]
//!        /  \        /  |             ^  ^            |  \          /  \
//!     --o----o------o---o-----------------------------o---o--------o----o--
//! ```
//!
//! As the trunk leaves along the arc, each foot stays at its foothold for as long as its limb reaches it: that is the stroke which the legs have. Before
//! the landing each foot finds its foothold as soon as its limb reaches it.
//!
//! Source: Campana and others 2016, section 5.

use nalgebra::{Point3, Vector3};

use super::Hop;
use crate::{
    ground::{Foothold, Pose, Stance, StanceGround},
    world::Contact,
};

/// Steps in which a limb is followed, as shares of the longest leg.
const STEP: f64 = 0.02;

/// Halvings between a step at which a foot reaches its foothold and the next, at which it does not.
const HALVINGS: u32 = 20;

/// A hop from stance to stance in time.
#[derive(Clone, Copy, Debug)]
pub struct StanceFlight<'a> {
    ground: &'a StanceGround,
    ends: [&'a Stance; 2],
    from_m: Point3<f64>,
    liftoff_m_s: Vector3<f64>,
    time_s: f64,
}

/// One of the five key postures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PostureKind {
    /// The stance of the take-off.
    Takeoff,
    /// The last instant at which a foot reaches its foothold of the take-off.
    LastContact,
    /// The highest point of the flight; of a flight that only rises or falls, its end that is higher.
    Apex,
    /// The first instant at which a foot reaches its foothold of the landing.
    FirstContact,
    /// The stance of the landing.
    Landing,
}

impl PostureKind {
    /// All, in their order.
    pub const ALL: [Self; 5] = [Self::Takeoff, Self::LastContact, Self::Apex, Self::FirstContact, Self::Landing];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Takeoff => "take-off",
            Self::LastContact => "last contact",
            Self::Apex => "apex",
            Self::FirstContact => "first contact",
            Self::Landing => "landing",
        }
    }
}

/// The trunk at an instant of a hop, and the feet that reach their footholds.
#[derive(Clone, Debug, PartialEq)]
pub struct Posture {
    /// Which.
    pub kind: PostureKind,
    /// After the take-off, s.
    pub time_s: f64,
    /// The trunk.
    pub pose: Pose,
    /// The limbs whose feet reach their footholds, by their numbers, and where those are, m.
    pub feet: Vec<(usize, Point3<f64>)>,
}

/// Until when, or from when, the feet of a stance reach their footholds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootTime {
    /// The limb, by its number.
    pub limb: usize,
    /// Of the stance of the take-off: how long after it, s. Of the stance of the landing: how long before it, s.
    pub reaches_for_s: f64,
    /// The way of the root in that time, m: how far the limb stretches.
    pub way_m: f64,
}

impl<'a> StanceFlight<'a> {
    /// A hop between two stances.
    pub fn new(ground: &'a StanceGround, ends: [&'a Stance; 2], hop: &Hop) -> Self {
        let (sine, cosine) = libm::sincos(hop.takeoff_angle.radians());
        let away = ends[1].pose().root_m - ends[0].pose().root_m;
        let along = away.xy().try_normalize(0.0).unwrap_or_else(nalgebra::Vector2::x);
        let liftoff_m_s = Vector3::new(along.x * cosine, along.y * cosine, sine) * hop.takeoff_speed_m_s;
        Self { ground, ends, from_m: ends[0].pose().root_m, liftoff_m_s, time_s: hop.flight_time_s }
    }

    /// The trunk after a time from 0 to that of the flight, s: the root on the arc, turned evenly from the one stance to the other.
    pub fn pose_at(&self, time_s: f64) -> Pose {
        if time_s >= self.time_s {
            return *self.ends[1].pose();
        }
        let fall = Vector3::new(0.0, 0.0, -0.5 * self.ground.mesh().envelope().gravity_m_s2() * time_s * time_s);
        let turn = self.ends[0].pose().turned_towards(self.ends[1].pose(), time_s / self.time_s);
        Pose { root_m: self.from_m + self.liftoff_m_s * time_s + fall, turn }
    }

    /// The velocity of the root at take-off, and the reverse of that at landing, m/s: the pushes.
    pub fn pushes_m_s(&self) -> [Vector3<f64>; 2] {
        let g = self.ground.mesh().envelope().gravity_m_s2();
        [self.liftoff_m_s, Vector3::z() * (g * self.time_s) - self.liftoff_m_s]
    }

    /// For how long the feet of the stance of the take-off still reach their footholds, or those of the landing do already.
    pub fn foot_times(&self, contact: Contact) -> Vec<FootTime> {
        let stance = self.ends[usize::from(contact == Contact::Landing)];
        stance.footholds().iter().map(|foot| self.foot_time(contact, foot)).collect()
    }

    /// The key postures in their order.
    pub fn postures(&self) -> [Posture; 5] {
        let [left, found] = [Contact::Takeoff, Contact::Landing].map(|contact| {
            let times = self.foot_times(contact).into_iter();
            times.map(|foot| foot.reaches_for_s).fold(0.0, f64::max)
        });
        let g = self.ground.mesh().envelope().gravity_m_s2();
        let apex_s = (self.liftoff_m_s.z / g).clamp(0.0, self.time_s);
        let at = |kind, time_s: f64, contact: Option<Contact>| {
            let pose = self.pose_at(time_s);
            let stance = contact.map(|contact| self.ends[usize::from(contact == Contact::Landing)]);
            let feet = stance.map_or(&[][..], Stance::footholds).iter();
            let feet = feet.filter(|foot| self.ground.foot_reaches(&pose, foot.limb, &foot.point_m));
            Posture { kind, time_s, pose, feet: feet.map(|foot| (foot.limb, foot.point_m)).collect() }
        };
        [
            at(PostureKind::Takeoff, 0.0, Some(Contact::Takeoff)),
            at(PostureKind::LastContact, left, Some(Contact::Takeoff)),
            at(PostureKind::Apex, apex_s, None),
            at(PostureKind::FirstContact, self.time_s - found, Some(Contact::Landing)),
            at(PostureKind::Landing, self.time_s, Some(Contact::Landing)),
        ]
    }

    fn foot_time(&self, contact: Contact, foot: &Foothold) -> FootTime {
        let at = |since_s: f64| match contact {
            Contact::Takeoff => self.pose_at(since_s),
            Contact::Landing => self.pose_at(self.time_s - since_s),
        };
        let reaches = |since_s: f64| self.ground.foot_reaches(&at(since_s), foot.limb, &foot.point_m);
        let speeds = self.pushes_m_s().map(|velocity| velocity.norm());
        let step_s = STEP * self.ground.robot().leg_length_m() / speeds[0].max(speeds[1]).max(f64::MIN_POSITIVE);
        let mut reached_s = 0.0;
        let mut left_s = None;
        if reaches(0.0) {
            while left_s.is_none() && reached_s < self.time_s {
                let next_s = (reached_s + step_s).min(self.time_s);
                if next_s <= reached_s {
                    break;
                }
                if reaches(next_s) { reached_s = next_s } else { left_s = Some(next_s) }
            }
        }
        if let Some(mut left_s) = left_s {
            for _ in 0..HALVINGS {
                let middle_s = f64::midpoint(reached_s, left_s);
                if reaches(middle_s) { reached_s = middle_s } else { left_s = middle_s }
            }
        }
        FootTime { limb: foot.limb, reaches_for_s: reached_s, way_m: (at(reached_s).root_m - at(0.0).root_m).norm() }
    }
}
