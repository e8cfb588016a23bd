//! A robot with legs that stands: from the side, from above, and the directions in which it may take off.

use nalgebra::Vector3;
use plotters::style::RGBColor;

use super::{
    Caption, FigureError, Picture,
    axes::{BELOW_MM, Panel},
    keys::{self, Swatch},
    palette::{AXIS, BLACK, LEFT_MM, PURPLE, RIGHT_MM, SKY, SMALL_MM, TEXT_MM, WHITE},
    robot_view::{GROUND_PEN, LIMB_PEN, NORMAL_PEN, RobotMark, TRUNK, TRUNK_PEN, View},
    sheet::{Anchor, Hang, Label, Pen, Place, Sheet, text_width_mm},
};
use crate::{
    quantity::{Angle, SlopeInterval},
    report::{ElevationRecord, RoseRecord},
};

const KC_PEN: Pen = Pen { colour: PURPLE, width_mm: 0.5 };
const KC_PLUS_PEN: Pen = Pen { colour: BLACK, width_mm: 0.4 };
const KC_DASH_MM: (f64, f64) = (1.4, 0.8);
const KC_PLUS_DASH_MM: (f64, f64) = (0.4, 0.6);
/// Directions of take-off by the exact cone.
const CONE: RGBColor = SKY;
/// Between two panels.
const GAP_MM: f64 = 17.0;
/// The highest panel.
const HIGHEST_MM: f64 = 75.0;
/// Radius of the rose.
const ROSE_MM: f64 = 40.0;
/// Degrees to a straight piece of a curve of the rose.
const STEP_DEG: f64 = 2.0;

/// A robot that stands.
#[derive(Clone, Debug, PartialEq)]
pub struct StandingRobot {
    /// The robot, with the cut of the ground along the heading of the view from the side.
    pub robot: RobotMark,
    /// The heading of its forward axis, degrees clockwise from +y.
    pub facing_deg: f64,
    /// The heading of the view from the side, degrees clockwise from +y.
    pub heading_deg: f64,
    /// The take-off slopes in that heading by the exact cone.
    pub slopes: SlopeInterval,
}

/// What is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct StanceFigure<'a> {
    /// The caption.
    pub caption: Caption,
    /// The robot; `None`: contacts alone, or one that cannot stand.
    pub robot: Option<StandingRobot>,
    /// The rose; empty without a stance.
    pub rose: &'a [RoseRecord],
}

/// Draws a stance: the robot from the side in the plane of its widest beam and from above, and the take-off angles in every heading.
///
/// # Errors
/// None for a stance of finite numbers.
pub fn draw_stance(figure: &StanceFigure<'_>) -> Result<Picture, FigureError> {
    let mut sheet = Sheet::default();
    let head_mm = figure.caption.draw(&mut sheet);
    let mut top_mm = keys::draw(&mut sheet, &entries(figure), head_mm + 2.0) + 3.0;
    if let Some(robot) = &figure.robot {
        top_mm = views(&mut sheet, robot, top_mm) + 2.0;
    }
    if !figure.rose.is_empty() {
        top_mm = rose(&mut sheet, figure, top_mm + 6.0);
    }
    Ok(Picture::page(sheet, top_mm + 2.0))
}

/// Both views side by side; where they end.
fn views(sheet: &mut Sheet, robot: &StandingRobot, top_mm: f64) -> f64 {
    let (sine, cosine) = libm::sincos(robot.heading_deg.to_radians());
    let side = |at: Vector3<f64>| [at.x * sine + at.y * cosine, at.z];
    let above = |at: Vector3<f64>| [at.x, at.y];
    let size_m = robot.robot.size_m();
    let width_mm = 0.5 * (RIGHT_MM - LEFT_MM - GAP_MM);
    let high_mm = width_mm.min(HIGHEST_MM);
    // Room around the robot for the cone over it.
    let mm_per_m = 0.5 * high_mm / (1.6 * size_m);
    let panel = |left: f64| Panel { left, top: top_mm + 5.0, right: left + width_mm, bottom: top_mm + 5.0 + high_mm };
    let from_side = View { panel: panel(LEFT_MM), mm_per_m, middle: [0.0, 0.15 * size_m], flat: &side };
    title(sheet, &from_side.panel, &format!("From the side, along heading {:.0} deg", robot.heading_deg));
    from_side.ground(sheet, &robot.robot.cut);
    cone(sheet, &from_side, robot, 1.5 * size_m);
    from_side.robot(sheet, &robot.robot, size_m);
    from_side.axes(sheet, ["ahead of the root (m)", "over the root (m)"]);
    from_side.panel.outline(sheet);
    let from_above = View { panel: panel(LEFT_MM + width_mm + GAP_MM), mm_per_m, middle: [0.0; 2], flat: &above };
    title(sheet, &from_above.panel, "From above");
    from_above.robot(sheet, &robot.robot, size_m);
    for (heading_deg, pen, dash) in [(robot.facing_deg, TRUNK_PEN, None), (robot.heading_deg, KC_PLUS_PEN, Some(KC_DASH_MM))] {
        let (sine, cosine) = libm::sincos(heading_deg.to_radians());
        let ends = [from_above.at([0.0, 0.0]), from_above.at([1.45 * size_m * sine, 1.45 * size_m * cosine])];
        match dash {
            Some((dash_mm, gap_mm)) => sheet.dashed(&ends, dash_mm, gap_mm, pen),
            None => sheet.line(ends.to_vec(), pen),
        }
    }
    from_above.axes(sheet, ["east of the root, x (m)", "north of the root, y (m)"]);
    from_above.panel.outline(sheet);
    from_side.panel.bottom + BELOW_MM
}

fn title(sheet: &mut Sheet, panel: &Panel, text: &str) {
    let at = (f64::midpoint(panel.left, panel.right), panel.top - 1.2);
    sheet.label(Label { bold: true, ..Label::new(text, at, TEXT_MM).hung(Anchor::Middle, Hang::Above) });
}

/// The directions of take-off in the plane of the view, from the root.
fn cone(sheet: &mut Sheet, view: &View<'_>, robot: &StandingRobot, length_m: f64) {
    if robot.slopes.is_empty() {
        return;
    }
    let [low, high] = [robot.slopes.lower, robot.slopes.upper].map(|slope| Angle::from_slope(slope).radians());
    let steps = 24;
    let at = |step: i32| {
        let (sine, cosine) = libm::sincos(low + (high - low) * f64::from(step) / f64::from(steps));
        view.at([length_m * cosine, length_m * sine])
    };
    let rim = (0..=steps).map(at).filter(|place| view.shows(*place));
    sheet.area(std::iter::once(view.at([0.0, 0.0])).chain(rim).collect(), CONE, 0.35);
}

/// The rose: headings around, north up; straight up in the middle, lower take-off angles farther out.
struct Rose {
    centre: Place,
    /// The take-off angle at the rim, degrees.
    rim_deg: f64,
}

impl Rose {
    fn place(&self, heading_deg: f64, angle_deg: f64) -> Place {
        let radius_mm = ROSE_MM * (90.0 - angle_deg.max(self.rim_deg)) / (90.0 - self.rim_deg);
        let (sine, cosine) = libm::sincos(heading_deg.to_radians());
        (self.centre.0 + radius_mm * sine, self.centre.1 - radius_mm * cosine)
    }

    fn ring(&self, angle_deg: f64, from_deg: f64, to_deg: f64) -> Vec<Place> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 180 steps")]
        let steps = ((to_deg - from_deg) / STEP_DEG).ceil().max(1.0) as u32;
        (0..=steps).map(|step| self.place(from_deg + (to_deg - from_deg) * f64::from(step) / f64::from(steps), angle_deg)).collect()
    }
}

/// What one of the cones allows in a heading.
type CutOf = fn(&RoseRecord) -> Option<ElevationRecord>;

/// Draws the rose; where it ends.
fn rose(sheet: &mut Sheet, figure: &StanceFigure<'_>, top_mm: f64) -> f64 {
    let rows = figure.rose;
    let lowest_deg = rows.iter().filter_map(|row| row.k).map(|angles| angles.takeoff_angle_min_deg).fold(90.0, f64::min);
    // Round, and never above the horizontal, which orients the reader.
    let rim_deg = (lowest_deg / 30.0).floor().min(0.0) * 30.0;
    let rose = Rose { centre: (0.5 * (LEFT_MM + RIGHT_MM), top_mm + ROSE_MM + 5.0), rim_deg };
    #[expect(clippy::cast_precision_loss, reason = "at most 3600 headings")]
    let half_deg = 180.0 / rows.len() as f64;
    for row in rows {
        let (from_deg, to_deg) = (row.heading_deg - half_deg, row.heading_deg + half_deg);
        if let Some(angles) = row.k {
            let mut outline = rose.ring(angles.takeoff_angle_max_deg, from_deg, to_deg);
            let mut inner = rose.ring(angles.takeoff_angle_min_deg, from_deg, to_deg);
            inner.reverse();
            outline.extend(inner);
            sheet.area(outline, CONE, 0.7);
        }
    }
    let kinds: [(CutOf, Pen, (f64, f64)); 2] =
        [(|row| row.kc_plus, KC_PLUS_PEN, KC_PLUS_DASH_MM), (|row| row.kc, KC_PEN, KC_DASH_MM)];
    for (of, pen, (dash_mm, gap_mm)) in kinds {
        for end in [|a: &ElevationRecord| a.takeoff_angle_min_deg, |a: &ElevationRecord| a.takeoff_angle_max_deg] {
            let mut run: Vec<Place> = Vec::new();
            let mut around: Vec<Option<Place>> =
                rows.iter().map(|row| of(row).map(|angles| rose.place(row.heading_deg, end(&angles)))).collect();
            around.extend(around.first().copied());
            for place in around.into_iter().chain([None]) {
                match place {
                    Some(place) => run.push(place),
                    None if run.len() > 1 => sheet.dashed(&std::mem::take(&mut run), dash_mm, gap_mm, pen),
                    None => run.clear(),
                }
            }
        }
    }
    rings(sheet, &rose);
    rose.centre.1 + ROSE_MM + 8.0
}

/// Rings at round angles with their numbers, and the four directions.
fn rings(sheet: &mut Sheet, rose: &Rose) {
    let pen = Pen { colour: AXIS, width_mm: 0.15 };
    let mut angle_deg = 60.0;
    while angle_deg >= rose.rim_deg {
        sheet.dashed(&rose.ring(angle_deg, 0.0, 360.0), 0.8, 0.8, pen);
        let at = rose.place(45.0, angle_deg);
        let text = if angle_deg == rose.rim_deg && angle_deg < 0.0 {
            format!("{angle_deg:.0} deg and below")
        } else {
            format!("{angle_deg:.0} deg")
        };
        let half_mm = 0.5 * text_width_mm(&text, SMALL_MM) + 0.4;
        let tall_mm = 0.6 * SMALL_MM;
        let corners = [(-half_mm, -tall_mm), (half_mm, -tall_mm), (half_mm, tall_mm), (-half_mm, tall_mm)];
        sheet.area(corners.map(|(x, y)| (at.0 + x, at.1 + y)).to_vec(), WHITE, 0.8);
        sheet.label(Label::new(text, at, SMALL_MM).hung(Anchor::Middle, Hang::Through));
        angle_deg -= 30.0;
    }
    for (name, heading_deg) in [("N, +y", 0.0), ("E, +x", 90.0), ("S", 180.0), ("W", 270.0)] {
        let (x, y) = rose.place(heading_deg, rose.rim_deg);
        let (sine, cosine) = libm::sincos(f64::to_radians(heading_deg));
        let anchor = if sine > 0.5 {
            Anchor::Start
        } else if sine < -0.5 {
            Anchor::End
        } else {
            Anchor::Middle
        };
        sheet.label(Label::new(name, (x + 2.0 * sine, y - 3.0 * cosine), TEXT_MM).hung(anchor, Hang::Through));
    }
    let at = (rose.centre.0, rose.centre.1 - ROSE_MM - 7.0);
    let text = "Take-off angles in every heading: straight up in the middle";
    sheet.label(Label { bold: true, ..Label::new(text, at, TEXT_MM).hung(Anchor::Middle, Hang::Above) });
}

/// The legend: only what is drawn.
fn entries(figure: &StanceFigure<'_>) -> Vec<(Swatch, String)> {
    let mut found = Vec::new();
    if figure.robot.is_some() {
        found.push((Swatch::Fill(TRUNK), "trunk".to_owned()));
        found.push((Swatch::Line(LIMB_PEN), "limb".to_owned()));
        found.push((Swatch::Line(NORMAL_PEN), "normal of the ground at a foot".to_owned()));
        found.push((Swatch::Line(GROUND_PEN), "ground below the root, cut along the view from the side".to_owned()));
        found.push((Swatch::Line(TRUNK_PEN), "forward".to_owned()));
        found.push((Swatch::Dashed(KC_PLUS_PEN, KC_DASH_MM.0, KC_DASH_MM.1), "heading of the view from the side".to_owned()));
    }
    if figure.rose.iter().any(|row| row.k.is_some()) {
        found.push((Swatch::Fill(CONE), "take-offs without slipping, by the exact cone K".to_owned()));
    }
    if figure.rose.iter().any(|row| row.kc_plus.is_some()) {
        found.push((
            Swatch::Dashed(KC_PLUS_PEN, KC_PLUS_DASH_MM.0, KC_PLUS_DASH_MM.1),
            "their limits by the widest round cone inside it, Kc+".to_owned(),
        ));
    }
    if figure.rose.iter().any(|row| row.kc.is_some()) {
        found.push((
            Swatch::Dashed(KC_PEN, KC_DASH_MM.0, KC_DASH_MM.1),
            "their limits by the round cone of least friction, Kc".to_owned(),
        ));
    }
    found
}
