//! Colour scales for hop counts and other ordered values.

use plotters::style::RGBColor;

/// Few hops light, many dark (viridis, which colour-blind readers can distinguish and which prints well in grey).
const BANDS: [RGBColor; 6] = [
    RGBColor(253, 231, 37),
    RGBColor(122, 209, 81),
    RGBColor(34, 168, 132),
    RGBColor(42, 120, 142),
    RGBColor(65, 68, 135),
    RGBColor(68, 1, 84),
];

/// The greatest number of classes of equal width: more shades cannot be distinguished under a hillshade.
const MOST_EVEN: u64 = 8;

/// Classes of hop counts: the greatest count of each, in ascending order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct HopClasses(pub(super) Vec<u64>);

impl HopClasses {
    /// For hop counts up to `most`: one class for each count up to six, else classes whose ends grow by a common factor.
    pub(super) fn up_to(most: u64) -> Self {
        Self(classes(most))
    }

    /// For hop counts up to `most` over an area, most of which has high counts: one class for each count up to eight, else eight
    /// classes as equal in width as whole numbers allow.
    pub(super) fn even(most: u64) -> Self {
        let count = most.min(MOST_EVEN);
        // most * i / count, rounded up, without overflow of 64 bits.
        Self((1..=count).map(|i| most / count * i + (most % count * i).div_ceil(count)).collect())
    }

    /// The class of a hop count.
    pub(super) fn of(&self, hops: u64) -> usize {
        self.0.iter().position(|&most| hops <= most).unwrap_or(self.0.len().saturating_sub(1))
    }

    /// The colour of a class; the classes are spread over the whole colour scale.
    pub(super) fn colour(&self, class: usize) -> RGBColor {
        let steps = self.0.len().max(2) - 1;
        if steps >= BANDS.len() {
            #[expect(clippy::cast_precision_loss, reason = "at most eight classes")]
            return ramp(class as f64 / steps as f64);
        }
        BANDS[(class * (BANDS.len() - 1) / steps).min(BANDS.len() - 1)]
    }

    /// The legend texts of the classes.
    pub(super) fn texts(&self) -> Vec<String> {
        let mut least = 1;
        let text = |&most: &u64| {
            let range = if least >= most { most.to_string() } else { format!("{least} to {most}") };
            least = most + 1;
            format!("{range} hop{}", if most == 1 { "" } else { "s" })
        };
        self.0.iter().map(text).collect()
    }
}

/// The greatest hop count of each class.
fn classes(most: u64) -> Vec<u64> {
    let count = BANDS.len() as u64;
    if most <= count {
        return (1..=most).collect();
    }
    #[expect(clippy::cast_precision_loss, reason = "a count of hops for a legend")]
    let whole = most as f64;
    let mut ends: Vec<u64> = Vec::new();
    for i in 1..=count {
        #[expect(
            clippy::cast_precision_loss,
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and most"
        )]
        let end = libm::pow(whole, i as f64 / count as f64).round() as u64;
        let after_last = ends.last().map_or(1, |last| last + 1);
        ends.push(end.max(after_last));
    }
    if let Some(last) = ends.last_mut() {
        *last = most;
    }
    ends
}

/// The colour for a value from 0 (first band) to 1 (last band).
pub(super) fn ramp(share: f64) -> RGBColor {
    let last = BANDS.len() - 1;
    #[expect(clippy::cast_precision_loss, reason = "a handful of colours")]
    let at = share.clamp(0.0, 1.0) * last as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 5")]
    let below = (at.floor() as usize).min(last - 1);
    #[expect(clippy::cast_precision_loss, reason = "a handful of colours")]
    let part = at - below as f64;
    mixed(BANDS[below], BANDS[below + 1], part)
}

/// Linear interpolation between two colours, for a fraction from 0 to 1.
pub(super) fn mixed(from: RGBColor, to: RGBColor, share: f64) -> RGBColor {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates to a byte")]
    let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * share).round() as u8;
    RGBColor(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_rise_and_end_with_the_most() {
        assert!(classes(0).is_empty());
        assert_eq!(classes(4), [1, 2, 3, 4]);
        for most in 7..2000 {
            let ends = classes(most);
            assert!(ends.windows(2).all(|pair| pair[0] < pair[1]), "{ends:?}");
            assert_eq!((ends.len(), ends.last()), (6, Some(&most)));
        }
        assert_eq!(classes(u64::MAX).last(), Some(&u64::MAX));
    }

    #[test]
    fn every_hop_count_has_its_class_and_text() {
        let classes = HopClasses::up_to(100);
        for hops in 1..=100 {
            let class = classes.of(hops);
            assert!(hops <= classes.0[class] && (class == 0 || hops > classes.0[class - 1]));
        }
        assert_eq!(HopClasses::up_to(3).texts(), ["1 hop", "2 hops", "3 hops"]);
        assert_eq!(classes.texts().last().unwrap(), "47 to 100 hops");
    }

    #[test]
    fn even_classes_differ_by_at_most_one_hop_and_have_their_own_colours() {
        assert_eq!(HopClasses::even(7).0, [1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(HopClasses::even(30).0, [4, 8, 12, 15, 19, 23, 27, 30]);
        assert!(HopClasses::even(0).0.is_empty());
        for most in (9..500).chain([u64::MAX]) {
            let classes = HopClasses::even(most);
            assert_eq!((classes.0.len(), classes.0.last()), (8, Some(&most)));
            let widths: Vec<u64> = std::iter::once(&0).chain(&classes.0).zip(&classes.0).map(|(low, high)| high - low).collect();
            assert!(widths.iter().all(|width| (most / 8..=most.div_ceil(8)).contains(width)), "{widths:?}");
        }
        let classes = HopClasses::even(8);
        let mut colours: Vec<_> = (0..8).map(|class| classes.colour(class)).collect();
        assert_eq!((colours[0], colours[7]), (BANDS[0], BANDS[5]));
        colours.dedup();
        assert_eq!(colours.len(), 8);
    }

    #[test]
    fn the_ramp_darkens_steadily() {
        let light = |c: RGBColor| 0.3 * f64::from(c.0) + 0.59 * f64::from(c.1) + 0.11 * f64::from(c.2);
        let all: Vec<f64> = (0..=50).map(|i| light(ramp(f64::from(i) / 50.0))).collect();
        assert!(all.windows(2).all(|pair| pair[0] > pair[1]), "{all:?}");
        assert_eq!((ramp(0.0), ramp(1.0), ramp(7.0)), (BANDS[0], BANDS[5], BANDS[5]));
    }
}
