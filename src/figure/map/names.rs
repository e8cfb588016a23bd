//! Label placement on a map: inside the panel, over no marker or other label, over as few landings as possible.

use super::super::{
    palette::SMALL_MM,
    sheet::{Anchor, Hang, Label, Place},
};

/// Margin of the light background around the letters.
const BESIDE_MM: f64 = 0.5;
const ABOVE_MM: f64 = 0.3;
const BELOW_MM: f64 = 0.4;
/// Distances between a marker and its label: near ones are tried first, far ones get a line to their marker.
const ROOMS_MM: [f64; 5] = [0.3, 2.5, 5.0, 8.5, 13.0];
/// Cost of hiding a landing, in rings of distance.
const RINGS_PER_LANDING: usize = 2;

/// A rectangle of the sheet, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Bounds {
    /// The square around a marker.
    pub(super) fn around((x, y): Place, half_mm: f64) -> Self {
        Self { left: x - half_mm, top: y - half_mm, right: x + half_mm, bottom: y + half_mm }
    }

    /// The background rectangle of a bold label, extended on the side away from the text's anchor, since bold letters are wider
    /// than those of [`Label::bounds_mm`].
    pub(super) fn of(label: &Label) -> Self {
        let (left, top, right, bottom) = label.bounds_mm();
        let wider_mm = if label.turned { 0.0 } else { bold_mm(&label.text, label.size_mm) - (right - left) };
        let (before_mm, after_mm) = match label.anchor {
            Anchor::Start => (0.0, wider_mm),
            Anchor::Middle => (0.5 * wider_mm, 0.5 * wider_mm),
            Anchor::End => (wider_mm, 0.0),
        };
        Self {
            left: left - before_mm - BESIDE_MM,
            top: top - ABOVE_MM,
            right: right + after_mm + BESIDE_MM,
            bottom: bottom + BELOW_MM,
        }
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    pub(super) fn is_within(&self, outer: &Self) -> bool {
        self.left >= outer.left && self.right <= outer.right && self.top >= outer.top && self.bottom <= outer.bottom
    }

    fn covers(&self, (x, y): Place) -> bool {
        self.left <= x && x <= self.right && self.top <= y && y <= self.bottom
    }

    /// The point of the rectangle nearest to a position.
    pub(super) fn nearest(&self, (x, y): Place) -> Place {
        (x.clamp(self.left, self.right), y.clamp(self.top, self.bottom))
    }

    /// The shift, right and down, that moves a rectangle into this one.
    fn pull(&self, inner: &Self) -> Place {
        let along = |low: f64, high: f64, from: f64, to: f64| (low - from).max(0.0) + (high - to).min(0.0);
        (along(self.left, self.right, inner.left, inner.right), along(self.top, self.bottom, inner.top, inner.bottom))
    }
}

/// A candidate position of a label.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Candidate {
    pub(super) label: Label,
    /// The ring: 0 next to its marker, larger farther away.
    pub(super) ring: usize,
}

/// Obstacles for labels.
#[derive(Clone, Debug, Default)]
pub(super) struct Taken {
    /// Markers and texts: never covered.
    pub(super) kept: Vec<Bounds>,
    /// Landings of paths: covered only if there is no better candidate.
    pub(super) spared: Vec<Place>,
}

/// Candidates around a marker: right, left, above, below and diagonal, near ones first, moved into the panel if they cross its
/// edge.
pub(super) fn candidates(text: &str, (x, y): Place, half_mm: f64, panel: &Bounds) -> Vec<Candidate> {
    let mut found = Vec::new();
    for (ring, room_mm) in ROOMS_MM.into_iter().enumerate() {
        let beside = half_mm + room_mm + BESIDE_MM;
        let up = half_mm + room_mm + 0.5 * SMALL_MM + ABOVE_MM.max(BELOW_MM);
        let (s, m, e) = (Anchor::Start, Anchor::Middle, Anchor::End);
        let around = [
            (beside, 0.0, s),
            (-beside, 0.0, e),
            (0.0, -up, m),
            (0.0, up, m),
            (beside, up, s),
            (beside, -up, s),
            (-beside, up, e),
            (-beside, -up, e),
        ];
        for (dx, dy, anchor) in around {
            let mut label = Label::new(text, (x + dx, y + dy), SMALL_MM).hung(anchor, Hang::Through);
            let (right, down) = panel.pull(&Bounds::of(&label));
            label.at = (label.at.0 + right, label.at.1 + down);
            found.push(Candidate { label, ring });
        }
    }
    found
}

/// The best candidate for a label: inside the panel and over no marker or text; among these the one that hides the fewest landings,
/// then the nearest, then the first. `None` if no candidate fits.
pub(super) fn choose<'a>(candidates: &'a [Candidate], panel: &Bounds, taken: &Taken) -> Option<&'a Candidate> {
    // A candidate moved into the panel lies on its edge up to rounding.
    let panel = Bounds { left: panel.left - 1e-6, top: panel.top - 1e-6, right: panel.right + 1e-6, bottom: panel.bottom + 1e-6 };
    let is_free = |candidate: &&Candidate| {
        let bounds = Bounds::of(&candidate.label);
        bounds.is_within(&panel) && !taken.kept.iter().any(|other| bounds.overlaps(other))
    };
    let cost = |candidate: &&Candidate| {
        let bounds = Bounds::of(&candidate.label);
        RINGS_PER_LANDING * taken.spared.iter().filter(|&&at| bounds.covers(at)).count() + candidate.ring
    };
    candidates.iter().filter(is_free).min_by_key(cost)
}

/// The greatest width of a bold label, mm.
pub(super) fn width_mm(text: &str) -> f64 {
    bold_mm(text, SMALL_MM) + 2.0 * BESIDE_MM
}

/// The width of a bold text in `DejaVu Sans Bold`, estimated by kinds of letters, mm.
fn bold_mm(text: &str, size_mm: f64) -> f64 {
    let ems = text.chars().map(|letter| match letter {
        'i' | 'j' | 'l' | '.' | ',' | ';' | ':' | ' ' | '-' | '\'' | '(' | ')' => 0.38,
        'f' | 'r' | 't' => 0.49,
        'm' | 'w' | 'M' | 'W' | '≤' | '≥' | '=' => 1.0,
        'A'..='Z' => 0.76,
        _ => 0.69,
    });
    ems.sum::<f64>() * size_mm
}

#[cfg(test)]
mod tests {
    use super::*;

    const PANEL: Bounds = Bounds { left: 17.0, top: 20.0, right: 166.0, bottom: 185.0 };
    const HALF_MM: f64 = 2.0;

    /// Places labels one after the other, as the map does.
    fn named(markers: &[(&str, Place)], spared: &[Place], panel: &Bounds) -> Vec<Option<Bounds>> {
        let kept = markers.iter().map(|&(_, at)| Bounds::around(at, HALF_MM)).collect();
        let mut taken = Taken { kept, spared: spared.to_vec() };
        let mut name = |&(text, at): &(&str, Place)| {
            let places = candidates(text, at, HALF_MM, panel);
            let bounds = Bounds::of(&choose(&places, panel, &taken)?.label);
            taken.kept.push(bounds);
            Some(bounds)
        };
        markers.iter().map(&mut name).collect()
    }

    #[test]
    fn with_room_a_label_is_right_of_its_marker() {
        let found = named(&[("goal: 26 hops", (90.0, 100.0))], &[], &PANEL)[0].unwrap();
        assert!(found.left > 92.0 && found.left < 93.0 && (found.top + found.bottom) * 0.5 > 99.5, "{found:?}");
    }

    #[test]
    fn labels_at_edges_and_corners_stay_inside_and_off_their_marker() {
        for x in [17.0, 17.5, 60.0, 165.0, 166.0] {
            for y in [20.0, 20.4, 100.0, 184.0, 185.0] {
                let found = named(&[("goal 12: not reached", (x, y))], &[], &PANEL)[0].unwrap();
                assert!(found.is_within(&Bounds::around((91.5, 102.5), 82.6)), "{found:?}");
                assert!(found.left > 16.99 && found.right < 166.01 && found.top > 19.99 && found.bottom < 185.01, "{found:?}");
                assert!(!found.overlaps(&Bounds::around((x, y), HALF_MM)), "{found:?} over ({x}, {y})");
            }
        }
    }

    #[test]
    fn labels_of_adjacent_markers_cover_neither_markers_nor_labels() {
        // Two goals 20 m apart on a map of 1.3 km, a start beside them, then a dense group.
        let close = [("start", (80.0, 90.0)), ("goal 1: 1 hop", (83.5, 90.5)), ("goal 2: 2 hops", (85.8, 91.0))];
        let crowd: Vec<(&str, Place)> =
            (0..12u8).map(|i| ("goal 10: 12 hops", (150.0 + f64::from(i % 4) * 4.0, 175.0 + f64::from(i / 4) * 4.0))).collect();
        for markers in [&close[..], &crowd[..]] {
            let found: Vec<Bounds> = named(markers, &[], &PANEL).into_iter().flatten().collect();
            assert!(found.len() >= markers.len().min(8), "{} of {} named", found.len(), markers.len());
            for (i, one) in found.iter().enumerate() {
                assert!(markers.iter().all(|&(_, at)| !one.overlaps(&Bounds::around(at, HALF_MM))));
                assert!(found[i + 1..].iter().all(|other| !one.overlaps(other)));
                assert!(one.right <= PANEL.right + 1e-6 && one.bottom <= PANEL.bottom + 1e-6);
            }
        }
    }

    #[test]
    fn a_label_avoids_the_path() {
        // The path comes in from the right.
        let path: Vec<Place> = (1..8).map(|i| (90.0 + 3.0 * f64::from(i), 100.0)).collect();
        let found = named(&[("goal: 7 hops", (90.0, 100.0))], &path, &PANEL)[0].unwrap();
        assert!(path.iter().all(|&at| !found.covers(at)), "{found:?}");
        assert!(found.right < 90.0, "left of it: {found:?}");
        // With landings everywhere the label is still placed.
        let everywhere: Vec<Place> = (0..4000).map(|i| (70.0 + f64::from(i % 60), 80.0 + f64::from(i / 60))).collect();
        assert!(named(&[("goal: 7 hops", (90.0, 100.0))], &everywhere, &PANEL)[0].is_some());
    }

    #[test]
    fn a_bold_text_is_as_wide_as_in_its_font() {
        let face = ttf_parser::Face::parse(include_bytes!("../../../data/fonts/DejaVuSans-Bold-subset.ttf"), 0).unwrap();
        for text in ["start", "goal", "start 2", "goal: 26 hops", "goal 12: not reached", "target 3: visit 4", "2: 1.0 hops", "14"]
        {
            let units: u32 =
                text.chars().map(|letter| u32::from(face.glyph_hor_advance(face.glyph_index(letter).unwrap()).unwrap())).sum();
            let ratio = bold_mm(text, 1.0) * f64::from(face.units_per_em()) / f64::from(units);
            assert!((0.97..=1.08).contains(&ratio), "{text}: {ratio}");
        }
    }

    #[test]
    fn a_panel_too_small_for_a_label_gets_none() {
        let tiny = Bounds { left: 80.0, top: 20.0, right: 88.0, bottom: 185.0 };
        assert_eq!(named(&[("goal: not reached", (84.0, 90.0))], &[], &tiny), [None]);
        assert!(width_mm("goal: not reached") > 8.0);
    }
}
