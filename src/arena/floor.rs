//! An arena, valid by construction.

use super::{
    Jumper,
    keys::{ArenaKeys, BoxKeys},
    levels::Levels,
    problem::{ArenaProblem, Refusal},
};
use crate::quantity::MapPoint;

/// Coordinates closer than this are the same, m: far below any spacing, far above rounding at kilometres.
pub(super) const SAME_M: f64 = 1e-9;

/// A rise this far above the greatest is still allowed, m: heights such as 1.4 - 0.6 are no exact doubles.
pub(super) const RISE_TOLERANCE_M: f64 = 1e-9;

/// The longest side of a floor, m.
const LARGEST_M: f64 = 1e6;

/// A box with its inflation: an open rectangle with a height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArenaBox {
    /// The corner with the least coordinates.
    pub min: MapPoint,
    /// The corner with the greatest.
    pub max: MapPoint,
    /// Its height over the floor, m.
    pub height_m: f64,
}

impl ArenaBox {
    fn of(keys: &BoxKeys, inflation_m: f64) -> Self {
        let [x_m, y_m] = keys.centre_m;
        let [half_x_m, half_y_m] = keys.size_m.map(|size_m| 0.5 * size_m + inflation_m);
        Self {
            min: MapPoint::new(x_m - half_x_m, y_m - half_y_m),
            max: MapPoint::new(x_m + half_x_m, y_m + half_y_m),
            height_m: keys.height_m,
        }
    }

    /// Whether a point is inside, not on a face.
    pub fn contains(&self, point: MapPoint) -> bool {
        let within = |low: f64, at: f64, high: f64| low + SAME_M < at && at < high - SAME_M;
        within(self.min.x, point.x, self.max.x) && within(self.min.y, point.y, self.max.y)
    }

    /// Its smaller side, m.
    pub fn width_m(&self) -> f64 {
        (self.max.x - self.min.x).min(self.max.y - self.min.y)
    }

    fn overlaps(&self, other: &Self) -> bool {
        let apart = |a: (f64, f64), b: (f64, f64)| a.1 <= b.0 + SAME_M || b.1 <= a.0 + SAME_M;
        !apart((self.min.x, self.max.x), (other.min.x, other.max.x)) && !apart((self.min.y, self.max.y), (other.min.y, other.max.y))
    }
}

/// A flat floor with boxes, the robot, and where it goes.
///
/// # Examples
/// ```
/// use chta::arena::{Arena, ArenaKeys, any_angle_path};
/// let keys: ArenaKeys = serde_json::from_value(serde_json::json!({
///     "arena": { "size_m": [20, 20], "start_m": [2, 2], "goal_m": [18, 2] },
///     "jumper": { "speed_m_s": 2, "jump_time_s": 0.4, "rise_max_m": 0.8 },
///     "box": [{ "centre_m": [10, 2], "size_m": [2, 2], "height_m": 0.5 }],
/// }))?;
/// let arena = Arena::new(keys).map_err(|problems| problems[0].message.clone())?;
/// // Round the box, 2 sqrt(50) + 2 m at 2 m/s, rather than straight over it: 8.0 s and a jump.
/// assert!((any_angle_path(&arena, true)?.expect("a path").time_s - 8.0711).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Arena {
    keys: ArenaKeys,
    boxes: Vec<ArenaBox>,
    jumper: Jumper,
    levels: Levels,
    start: MapPoint,
    goal: MapPoint,
    heading: [f64; 2],
}

impl Arena {
    /// An arena of these keys.
    ///
    /// # Errors
    /// Every problem of the keys.
    pub fn new(keys: ArenaKeys) -> Result<Self, Vec<ArenaProblem>> {
        let problems = Problems::of(&keys);
        if !problems.0.is_empty() {
            return Err(problems.0);
        }
        let boxes: Vec<ArenaBox> = keys.boxes.iter().map(|one| ArenaBox::of(one, keys.arena.inflation_m)).collect();
        let place = |[x_m, y_m]: [f64; 2]| MapPoint::new(x_m, y_m);
        let (start, goal) = (place(keys.arena.start_m), place(keys.arena.goal_m));
        let problems = Problems::of_ends(&boxes, [start, goal]);
        if !problems.0.is_empty() {
            return Err(problems.0);
        }
        let heading = match keys.arena.start_heading_deg {
            None => (goal - start).normalize().into(),
            Some(clockwise_deg) => {
                let angle = clockwise_deg.to_radians();
                [libm::sin(angle), libm::cos(angle)]
            }
        };
        let levels = Levels::new(keys.arena.size_m, &boxes);
        Ok(Self { jumper: Jumper::of(&keys.jumper, keys.flight.as_ref()), keys, boxes, levels, start, goal, heading })
    }

    /// The keys that it was made of.
    pub const fn keys(&self) -> &ArenaKeys {
        &self.keys
    }

    /// The boxes with their inflation, in the order of the keys.
    pub fn boxes(&self) -> &[ArenaBox] {
        &self.boxes
    }

    /// The robot.
    pub const fn jumper(&self) -> &Jumper {
        &self.jumper
    }

    /// Where the way begins.
    pub const fn start(&self) -> MapPoint {
        self.start
    }

    /// Where the way ends.
    pub const fn goal(&self) -> MapPoint {
        self.goal
    }

    /// The heading at the start, as a unit vector along x and y.
    pub const fn heading(&self) -> [f64; 2] {
        self.heading
    }

    /// The size of the floor along x and y, m.
    pub const fn size_m(&self) -> [f64; 2] {
        self.keys.arena.size_m
    }

    /// The heights of the floor and the boxes over it.
    pub(super) const fn levels(&self) -> &Levels {
        &self.levels
    }

    /// Refuses flights of a robot that weakens.
    pub(super) fn refuse_flight_that_weakens(&self) -> Result<(), Refusal> {
        let factor = self.jumper.speed_factor_per_jump;
        if self.jumper.flight.is_some() && factor != 1.0 { Err(Refusal::FliesAndWeakens { factor }) } else { Ok(()) }
    }

    /// The same without its battery; `None` if it has none.
    pub(super) fn without_battery(&self) -> Option<Self> {
        let mut jumper = self.jumper;
        jumper.battery_j = f64::INFINITY;
        self.keys.jumper.battery_j.map(|_| Self { jumper, ..self.clone() })
    }

    /// The same without one of its limits each, beside the key of that limit: the battery, the rise of jumps where they are allowed, the
    /// inflation.
    pub(crate) fn lifted(&self, may_jump: bool) -> Vec<(&'static str, Self)> {
        let mut found = Vec::new();
        let mut lift = |key, is_limit: bool, change: &dyn Fn(&mut ArenaKeys)| {
            let mut keys = self.keys.clone();
            change(&mut keys);
            found.extend(is_limit.then(|| Self::new(keys).ok()).flatten().map(|arena| (key, arena)));
        };
        let highest_m = self.boxes.iter().map(|one| one.height_m).fold(0.0, f64::max);
        lift("jumper.battery_j", self.jumper.battery_j.is_finite(), &|keys| keys.jumper.battery_j = None);
        let flies = self.keys.flight.is_some();
        lift("jumper.rise_max_m", may_jump && highest_m > self.keys.jumper.rise_max_m, &|keys| keys.jumper.rise_max_m = highest_m);
        lift("flight", may_jump && flies, &|keys| keys.flight = None);
        lift("arena.inflation_m", self.keys.arena.inflation_m > 0.0, &|keys| keys.arena.inflation_m = 0.0);
        lift("jumper.ring_m", self.jumper.ring_m > 0.0, &|keys| keys.jumper.ring_m = 0.0);
        found
    }

    /// What an analyst should know of a valid arena: boxes of different heights that overlap.
    pub fn warnings(&self) -> Vec<String> {
        let mut found = Vec::new();
        for (i, one) in self.boxes.iter().enumerate() {
            for (j, other) in self.boxes.iter().enumerate().skip(i + 1) {
                if one.height_m != other.height_m && one.overlaps(other) {
                    found.push(format!(
                        "boxes {} and {} overlap and are {} m and {} m high: the higher one counts where both are",
                        i + 1,
                        j + 1,
                        one.height_m,
                        other.height_m
                    ));
                }
            }
        }
        found
    }
}

/// The problems of keys, as they are found.
struct Problems(Vec<ArenaProblem>);

impl Problems {
    /// What is wrong with single keys.
    fn of(keys: &ArenaKeys) -> Self {
        let mut problems = Self(Vec::new());
        let floor = &keys.arena;
        let is_floor = floor.size_m.iter().all(|size_m| *size_m > 0.0 && *size_m <= LARGEST_M);
        if !is_floor {
            problems.add(
                "arena",
                "size_m",
                &floor.size_m,
                "two lengths above 0 and up to 1e6 m",
                "say how long the floor is along x and y",
            );
        }
        for (name, place) in [("start_m", floor.start_m), ("goal_m", floor.goal_m)] {
            let is_on_floor = place.iter().zip(floor.size_m).all(|(at, size_m)| (0.0..=size_m).contains(at));
            if is_floor && !is_on_floor {
                let [x_m, y_m] = floor.size_m;
                problems.add(
                    "arena",
                    name,
                    &place,
                    &format!("a place on the floor, from 0, 0 to {x_m}, {y_m}"),
                    "move it onto the floor",
                );
            }
        }
        if floor.start_m.iter().zip(floor.goal_m).all(|(start, goal)| (start - goal).abs() <= SAME_M) {
            problems.add("arena", "goal_m", &floor.goal_m, "a place other than arena.start_m", "say where the way leads");
        }
        if let Some(found) = floor.start_heading_deg.filter(|heading_deg| !(-360.0..=360.0).contains(heading_deg)) {
            problems.number(
                "arena",
                "start_heading_deg",
                found,
                "an angle from -360 to 360",
                "leave it out to begin towards the goal",
            );
        }
        if !(0.0..=LARGEST_M).contains(&floor.inflation_m) {
            problems.number("arena", "inflation_m", floor.inflation_m, "a length of at least 0", "0 takes the boxes as drawn");
        }
        problems.of_jumper(keys);
        problems.of_flight(keys);
        problems.of_grid(keys);
        for (number, one) in keys.boxes.iter().enumerate() {
            problems.of_box(number, one, floor.size_m, floor.inflation_m);
        }
        problems
    }

    fn of_jumper(&mut self, keys: &ArenaKeys) {
        let jumper = &keys.jumper;
        if !(jumper.speed_m_s > 0.0 && jumper.speed_m_s <= 1e4) {
            self.number("jumper", "speed_m_s", jumper.speed_m_s, "a speed above 0", "say how fast it drives");
        }
        let at_least_zero = [
            ("jump_time_s", jumper.jump_time_s, "how long a jump takes"),
            ("rise_max_m", jumper.rise_max_m, "how high it jumps; 0: not at all"),
            ("ring_m", jumper.ring_m, "what landings keep from edges"),
            ("jump_edge_max_m", jumper.jump_edge_max_m, "the longest jump of RRT*"),
            ("drive_j_per_m", jumper.drive_j_per_m, "the energy of driving"),
            ("jump_j", jumper.jump_j, "the energy of a jump"),
            ("power_w", jumper.power_w, "the power drawn at all times"),
            ("turn_s_per_rad", jumper.turn_s_per_rad.unwrap_or(0.0), "how long turning takes, or leave it out"),
        ];
        for (name, found, help) in at_least_zero {
            if !(0.0..=1e9).contains(&found) {
                self.number("jumper", name, found, "a number of at least 0", &format!("say {help}"));
            }
        }
        for (name, found) in [("wheelbase_m", jumper.wheelbase_m), ("battery_j", jumper.battery_j)] {
            if let Some(found) = found.filter(|found| !(*found > 0.0 && *found <= 1e12)) {
                self.number("jumper", name, found, "a number above 0", "leave it out if it is not known");
            }
        }
        let factor = jumper.speed_factor_per_jump;
        if !(factor > 0.0 && factor <= 1.0) {
            self.number("jumper", "speed_factor_per_jump", factor, "a number above 0 and at most 1", "1: no jump slows the robot");
        }
        if jumper.battery_j.is_some() && jumper.drive_j_per_m == 0.0 && jumper.jump_j == 0.0 && jumper.power_w == 0.0 {
            let help = "give jumper.drive_j_per_m, jumper.jump_j or jumper.power_w, or leave the battery out";
            self.push("jumper", None, "battery_j", "jumper.battery_j bounds an energy that nothing takes".to_owned(), help);
        }
    }

    fn of_flight(&mut self, keys: &ArenaKeys) {
        let Some(flight) = &keys.flight else { return };
        for (name, found) in [("takeoff_speed_m_s", flight.takeoff_speed_m_s), ("gravity_m_s2", flight.gravity_m_s2)] {
            if !(found > 0.0 && found <= 1e4) {
                self.number("flight", name, found, "a number above 0", "remove [flight] to jump by rise and time alone");
            }
        }
        let angle_deg = flight.takeoff_angle_deg;
        if !(angle_deg > 0.0 && angle_deg < 90.0) {
            self.number("flight", "takeoff_angle_deg", angle_deg, "an angle above 0 and below 90", "it is measured from the floor");
        }
    }

    fn of_grid(&mut self, keys: &ArenaKeys) {
        for (name, found) in [("spacing_m", keys.grid.spacing_m), ("jump_length_m", keys.grid.jump_length_m)] {
            if !(found > 0.0 && found <= LARGEST_M) {
                self.number("grid", name, found, "a length above 0", "0.2 and 0.4 m are those of the paper");
            }
        }
    }

    fn of_box(&mut self, number: usize, one: &BoxKeys, floor_m: [f64; 2], inflation_m: f64) {
        let mut add = |name, found: String, expected: &str, help| {
            let message = format!("box {}: {name} is {found}, expected {expected}", number + 1);
            self.push("box", Some(number), name, message, help);
        };
        let is_sized = one.size_m.iter().all(|size_m| *size_m > 0.0 && *size_m <= LARGEST_M);
        if !is_sized {
            add("size_m", listed(&one.size_m), "two lengths above 0", "say how long it is along x and y, or remove the box");
        }
        if !(one.height_m > 0.0 && one.height_m <= LARGEST_M) {
            add("height_m", one.height_m.to_string(), "a height above 0", "say how high it is, or remove the box");
        }
        let near = one.centre_m.iter().zip(floor_m).zip(one.size_m).all(|((at, floor_m), size_m)| {
            let half_m = 0.5 * size_m + inflation_m;
            at + half_m > 0.0 && at - half_m < floor_m
        });
        if is_sized && !near {
            add(
                "centre_m",
                listed(&one.centre_m),
                "a box that is at least in part on the floor",
                "move it onto the floor, or remove it",
            );
        }
    }

    /// What is wrong with the ends among the boxes.
    fn of_ends(boxes: &[ArenaBox], ends: [MapPoint; 2]) -> Self {
        let mut problems = Self(Vec::new());
        for (name, end) in ["start_m", "goal_m"].into_iter().zip(ends) {
            if let Some(number) = boxes.iter().position(|one| one.contains(end)) {
                let expected = format!("a place outside of all boxes: it is in box {}", number + 1);
                problems.add("arena", name, &[end.x, end.y], &expected, "move it, or the box");
            }
        }
        problems
    }

    fn add(&mut self, table: &'static str, name: &'static str, found: &[f64], expected: &str, help: &str) {
        self.push(table, None, name, format!("{table}.{name} is {}, expected {expected}", listed(found)), help);
    }

    fn number(&mut self, table: &'static str, name: &'static str, found: f64, expected: &str, help: &str) {
        self.push(table, None, name, format!("{table}.{name} is {found}, expected {expected}"), help);
    }

    fn push(&mut self, table: &'static str, number: Option<usize>, name: &'static str, message: String, help: &str) {
        self.0.push(ArenaProblem { table, number, name, message, help: help.to_owned() });
    }
}

fn listed(numbers: &[f64]) -> String {
    numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
