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

/// The greatest number of classes: more shades cannot be distinguished under a hillshade.
pub(super) const MOST_CLASSES: u64 = 7;

/// Classes of hop counts: the greatest count of each, in ascending order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct HopClasses(pub(super) Vec<u64>);

impl HopClasses {
    /// For hop counts up to `most`: at most seven classes of equal width, which is a round number of hops; the last ends with `most`.
    pub(super) fn up_to(most: u64) -> Self {
        let width = round_width(most.div_ceil(MOST_CLASSES).max(1));
        let count = most.div_ceil(width);
        Self((1..=count).map(|i| width.saturating_mul(i).min(most)).collect())
    }

    /// The class of a hop count.
    pub(super) fn of(&self, hops: u64) -> usize {
        self.0.iter().position(|&most| hops <= most).unwrap_or(self.0.len().saturating_sub(1))
    }

    /// The colour of a class; the classes are spread over the whole colour scale.
    pub(super) fn colour(&self, class: usize) -> RGBColor {
        let steps = self.0.len().max(2) - 1;
        if steps >= BANDS.len() {
            #[expect(clippy::cast_precision_loss, reason = "at most seven classes")]
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

/// The least of 1, 2, 3, 4, 5 and of 10, 15, 20, 25, 30, 40, 50 times a power of ten that is at least the given number.
fn round_width(least: u64) -> u64 {
    const TENS: [u64; 7] = [10, 15, 20, 25, 30, 40, 50];
    if least <= 5 {
        return least;
    }
    let powers = std::iter::successors(Some(1u64), |power| power.checked_mul(10));
    powers.flat_map(|power| TENS.map(|ten| ten.saturating_mul(power))).find(|width| *width >= least).unwrap_or(u64::MAX)
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
    fn every_hop_count_has_its_class_and_text() {
        let classes = HopClasses::up_to(100);
        for hops in 1..=100 {
            let class = classes.of(hops);
            assert!(hops <= classes.0[class] && (class == 0 || hops > classes.0[class - 1]));
        }
        assert_eq!(HopClasses::up_to(3).texts(), ["1 hop", "2 hops", "3 hops"]);
        assert_eq!(
            classes.texts(),
            ["1 to 15 hops", "16 to 30 hops", "31 to 45 hops", "46 to 60 hops", "61 to 75 hops", "76 to 90 hops", "91 to 100 hops"]
        );
    }

    #[test]
    fn at_most_seven_classes_of_one_round_width_end_with_the_most_in_their_own_colours() {
        assert_eq!(HopClasses::up_to(7).0, [1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(HopClasses::up_to(8).0, [2, 4, 6, 8]);
        assert_eq!(HopClasses::up_to(30).0, [5, 10, 15, 20, 25, 30]);
        assert_eq!(HopClasses::up_to(215).0, [40, 80, 120, 160, 200, 215]);
        assert!(HopClasses::up_to(0).0.is_empty());
        for most in (1..3000).chain([u64::MAX, u64::MAX - 1, 123_456_789]) {
            let HopClasses(ends) = HopClasses::up_to(most);
            assert!(ends.len() <= 7 && ends.last() == Some(&most), "{ends:?}");
            let widths: Vec<u64> = std::iter::once(&0).chain(&ends).zip(&ends).map(|(low, high)| high - low).collect();
            let last = widths.len() - 1;
            assert!(widths[..last].iter().all(|width| *width == widths[0]) && (1..=widths[0]).contains(&widths[last]), "{ends:?}");
            // One or two digits beside zeros: a round number.
            let digits = widths[0].to_string();
            assert!(last == 0 || digits.trim_end_matches('0').len() <= 2, "{ends:?}");
        }
        let classes = HopClasses::up_to(7);
        let mut colours: Vec<_> = (0..7).map(|class| classes.colour(class)).collect();
        assert_eq!((colours[0], colours[6]), (BANDS[0], BANDS[5]));
        colours.dedup();
        assert_eq!(colours.len(), 7);
    }

    #[test]
    fn the_ramp_darkens_steadily() {
        let light = |c: RGBColor| 0.3 * f64::from(c.0) + 0.59 * f64::from(c.1) + 0.11 * f64::from(c.2);
        let all: Vec<f64> = (0..=50).map(|i| light(ramp(f64::from(i) / 50.0))).collect();
        assert!(all.windows(2).all(|pair| pair[0] > pair[1]), "{all:?}");
        assert_eq!((ramp(0.0), ramp(1.0), ramp(7.0)), (BANDS[0], BANDS[5], BANDS[5]));
    }
}
