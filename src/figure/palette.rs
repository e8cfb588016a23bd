//! Colours that colour-blind readers can distinguish (Okabe and Ito 2008), and the sizes of lines and letters on a 170 mm page.

use plotters::style::RGBColor;

pub(super) const BLACK: RGBColor = RGBColor(0, 0, 0);
pub(super) const WHITE: RGBColor = RGBColor(255, 255, 255);
pub(super) const ORANGE: RGBColor = RGBColor(230, 159, 0);
pub(super) const SKY: RGBColor = RGBColor(86, 180, 233);
pub(super) const GREEN: RGBColor = RGBColor(0, 158, 115);
pub(super) const BLUE: RGBColor = RGBColor(0, 114, 178);
pub(super) const VERMILION: RGBColor = RGBColor(213, 94, 0);
pub(super) const PURPLE: RGBColor = RGBColor(154, 78, 122);
/// The body of the ground.
pub(super) const GROUND: RGBColor = RGBColor(232, 229, 224);
/// Its surface.
pub(super) const SURFACE: RGBColor = RGBColor(70, 66, 60);
/// Grid lines.
pub(super) const GRID: RGBColor = RGBColor(222, 222, 222);
/// Axes and secondary text.
pub(super) const AXIS: RGBColor = RGBColor(60, 60, 60);

/// Width of the page.
pub(super) const PAGE_WIDTH_MM: f64 = 170.0;
/// Left edge of the panels; axis numbers are left of it.
pub(super) const LEFT_MM: f64 = 17.0;
/// Right edge of the panels.
pub(super) const RIGHT_MM: f64 = 166.0;

/// 11 points.
pub(super) const TITLE_MM: f64 = 3.9;
/// 8 points.
pub(super) const TEXT_MM: f64 = 2.8;
/// 7 points.
pub(super) const SMALL_MM: f64 = 2.45;
