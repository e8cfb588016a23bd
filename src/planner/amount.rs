//! What a path takes: amounts that add up over its hops, and one that is the greatest of them.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

use super::LayerTotals;
use crate::{
    ballistics::{Arc, delta_v_m_s},
    world::{HopperLimits, LayerName},
};

/// An amount of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Amount {
    /// The number of hops.
    Hops,
    /// The sum of take-off speeds, m/s.
    TakeoffSpeed,
    /// The delta-v, m/s: take-offs, brakes, overhead.
    DeltaV,
    /// The energy from the store per unit mass, J/kg.
    Energy,
    /// The sum of flight times, s.
    FlightTime,
    /// From the first preparation to the last landing, s: flights, bounces, preparation, settling.
    MissionTime,
    /// Horizontal distance over the ground, m.
    Distance,
    /// The length of the arcs flown, m.
    ArcLength,
    /// The sum of the weights by which reliability ranks hops.
    Risk,
    /// The greatest take-off speed, m/s.
    PeakSpeed,
    /// What a layer of the map costs, at landings and under flights, in its own unit.
    Layer(LayerName),
}

impl Amount {
    /// The number of amounts that every path has.
    pub const COUNT: usize = 10;

    /// All amounts that every path has: all but those of layers, which have any names.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Hops,
        Self::TakeoffSpeed,
        Self::DeltaV,
        Self::Energy,
        Self::FlightTime,
        Self::MissionTime,
        Self::Distance,
        Self::ArcLength,
        Self::Risk,
        Self::PeakSpeed,
    ];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hops => "hops",
            Self::TakeoffSpeed => "takeoff-speed",
            Self::DeltaV => "delta-v",
            Self::Energy => "energy",
            Self::FlightTime => "flight-time",
            Self::MissionTime => "mission-time",
            Self::Distance => "distance",
            Self::ArcLength => "arc-length",
            Self::Risk => "risk",
            Self::PeakSpeed => "peak-speed",
            Self::Layer(layer) => layer.as_limit(),
        }
    }

    /// The amount with a name; `None` for any other text.
    ///
    /// # Examples
    /// ```
    /// use chta::{planner::Amount, world::LayerName};
    /// assert_eq!(Amount::named("energy"), Some(Amount::Energy));
    /// assert_eq!(Amount::named("layer:hazard"), LayerName::new("hazard").map(Amount::Layer));
    /// assert_eq!(Amount::named("hazard"), None);
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        let of_layer = || name.strip_prefix(LayerName::PREFIX).and_then(LayerName::new).map(Self::Layer);
        Self::ALL.into_iter().find(|amount| amount.name() == name).or_else(of_layer)
    }

    /// The names of all amounts, for messages.
    pub fn all_names() -> String {
        format!("{} and {}NAME of a layer with a cost", Self::ALL.map(Self::name).join(", "), LayerName::PREFIX)
    }

    /// The symbol of its unit; empty for a count, for risk and for a layer.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Hops | Self::Risk | Self::Layer(_) => "",
            Self::TakeoffSpeed | Self::DeltaV | Self::PeakSpeed => "m/s",
            Self::Energy => "J/kg",
            Self::FlightTime | Self::MissionTime => "s",
            Self::Distance | Self::ArcLength => "m",
        }
    }

    /// The amount of a whole path in words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Hops => "number of hops",
            Self::TakeoffSpeed => "sum of take-off speeds",
            Self::DeltaV => "delta-v",
            Self::Energy => "energy per unit mass",
            Self::FlightTime => "flight time",
            Self::MissionTime => "mission time",
            Self::Distance => "horizontal distance",
            Self::ArcLength => "length of the arcs",
            Self::Risk => "risk",
            Self::PeakSpeed => "greatest take-off speed",
            Self::Layer(layer) => layer.as_limit(),
        }
    }

    /// Whether it adds up over hops; else the greatest of them counts.
    pub const fn adds_up(self) -> bool {
        !matches!(self, Self::PeakSpeed)
    }

    /// Whether it is the same for every arc between two places.
    pub const fn is_of_places(self) -> bool {
        matches!(self, Self::Hops | Self::Distance | Self::Layer(_))
    }

    /// The amount of two parts of a path together.
    #[inline]
    pub const fn join(self, first: f64, second: f64) -> f64 {
        if self.adds_up() { first + second } else { first.max(second) }
    }

    /// That of one hop along an arc, as [`Amounts::of_arc`] gives it: nothing of a layer, which depends on the places.
    pub fn of_arc(self, arc: &Arc, limits: &HopperLimits, is_first: bool) -> f64 {
        match self {
            Self::Hops => 1.0,
            Self::TakeoffSpeed | Self::PeakSpeed => arc.takeoff_speed_m_s(),
            Self::DeltaV => delta_v_m_s(arc, limits),
            Self::Energy => {
                let speed_m_s = arc.takeoff_speed_m_s();
                limits.store_energy_j_kg(0.5 * speed_m_s * speed_m_s, 1)
            }
            Self::FlightTime => arc.flight_time_s(),
            Self::MissionTime => {
                let settling_s = if is_first { 0.0 } else { limits.settling_s().unwrap_or(0.0) };
                settling_s + limits.preparation_time_s.unwrap_or(0.0) + arc.flight_time_s()
            }
            Self::Distance => arc.line_of_sight().run_m(),
            Self::ArcLength => arc.length_m(),
            Self::Risk | Self::Layer(_) => 0.0,
        }
    }

    /// The layer of which it is the cost.
    pub const fn layer(self) -> Option<LayerName> {
        if let Self::Layer(layer) = self { Some(layer) } else { None }
    }

    /// The place in [`ALL`](Self::ALL), or the layer.
    #[inline]
    pub(super) const fn place(self) -> Result<usize, LayerName> {
        Ok(match self {
            Self::Hops => 0,
            Self::TakeoffSpeed => 1,
            Self::DeltaV => 2,
            Self::Energy => 3,
            Self::FlightTime => 4,
            Self::MissionTime => 5,
            Self::Distance => 6,
            Self::ArcLength => 7,
            Self::Risk => 8,
            Self::PeakSpeed => 9,
            Self::Layer(layer) => return Err(layer),
        })
    }
}

impl std::fmt::Display for Amount {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.pad(self.name())
    }
}

impl Serialize for Amount {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Amount {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = Cow::<str>::deserialize(deserializer)?;
        Self::named(&text).ok_or_else(|| D::Error::custom(format!("found \"{text}\", expected one of {}", Self::all_names())))
    }
}

impl JsonSchema for Amount {
    fn schema_name() -> Cow<'static, str> {
        "Amount".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "anyOf": [{ "enum": Self::ALL.map(Self::name) }, { "pattern": LayerName::LIMIT_PATTERN }] })
    }
}

/// All amounts of a hop, of a leg or of a path.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Amounts {
    /// By their places in [`Amount::ALL`].
    own: [f64; Amount::COUNT],
    layers: LayerTotals,
}

impl Amounts {
    /// Those of a path without hops.
    pub const NONE: Self = Self { own: [0.0; Amount::COUNT], layers: LayerTotals::NONE };

    /// One hop, and nothing else of it.
    pub(super) const ONE_HOP: Self = {
        let mut own = [0.0; Amount::COUNT];
        own[0] = 1.0;
        Self { own, ..Self::NONE }
    };

    /// Those of one hop along an arc, for a hopper. Risk and layers are left at 0, and bounces are not counted.
    ///
    /// ```text
    ///     hops = 1,   energy = (v_t^2 / 2) / efficiency + preparation energy / mass,
    ///     mission time = settling (not before the first hop) + preparation + flight
    /// ```
    ///
    /// # Arguments
    /// `is_first`: whether the mission begins with it, so that the hopper need not settle before.
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::{Arc, LineOfSight}, planner::{Amount, Amounts}, world::HopperLimits};
    /// // 45 degrees over 10 m of flat ground at 10 m/s^2: 10 m/s, and sqrt(2) s of flight.
    /// let arc = Arc::new(LineOfSight::new(10.0, 0.0), 1.0, 10.0);
    /// let limits = HopperLimits { preparation_time_s: Some(3.0), settling_time_s: Some(4.0), ..HopperLimits::with_speeds(20.0, 20.0) };
    /// let [first, later] = [true, false].map(|is_first| Amounts::of_arc(&arc, &limits, is_first));
    /// assert!((first.of(Amount::Energy) - 50.0).abs() < 1e-12);
    /// assert!((first.of(Amount::MissionTime) - (3.0 + 2f64.sqrt())).abs() < 1e-12);
    /// assert!((later.of(Amount::MissionTime) - (7.0 + 2f64.sqrt())).abs() < 1e-12);
    /// ```
    pub fn of_arc(arc: &Arc, limits: &HopperLimits, is_first: bool) -> Self {
        Amount::ALL.into_iter().fold(Self::NONE, |amounts, amount| amounts.with(amount, amount.of_arc(arc, limits, is_first)))
    }

    /// One of them.
    #[inline]
    pub fn of(&self, amount: Amount) -> f64 {
        amount.place().map_or_else(|layer| self.layers.of(layer).unwrap_or(0.0), |place| self.own[place])
    }

    /// The same with another value of one of them.
    #[must_use]
    #[inline]
    pub fn with(mut self, amount: Amount, value: f64) -> Self {
        match amount.place() {
            Ok(place) => self.own[place] = value,
            Err(layer) => self.layers = self.layers.with(layer, value),
        }
        self
    }

    /// The same with what layers cost.
    #[must_use]
    #[inline]
    pub const fn with_layers(self, layers: LayerTotals) -> Self {
        Self { layers, ..self }
    }

    /// What layers cost.
    pub const fn layers(&self) -> &LayerTotals {
        &self.layers
    }

    /// Those of a path of which these are the first part.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let mut both = *self;
        for amount in Amount::ALL {
            both = both.with(amount, amount.join(self.of(amount), next.of(amount)));
        }
        both.with_layers(self.layers.then(&next.layers))
    }

    /// Those of so many equal hops; of none at all, nothing.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "hop counts stay below 2^53")]
    pub fn times(&self, hops: u64) -> Self {
        let mut all = *self;
        for amount in Amount::ALL.into_iter().filter(|amount| hops == 0 || amount.adds_up()) {
            all = all.with(amount, all.of(amount) * hops as f64);
        }
        all.with_layers(self.layers.times(hops as f64))
    }
}
