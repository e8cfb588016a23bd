//! Styles of map rasters for QGIS (`.qml`), in the colours of the pictures.

use std::fmt::Write as _;

use plotters::style::RGBColor;

use super::{
    super::{
        bands::{HopClasses, ramp},
        palette::{BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION},
        ticks::short,
    },
    data::{HOPS_NOT_SEARCHED, HOPS_UNREACHABLE},
    raster::tone,
    unreached::NOT_REACHED,
    values::Steps,
};

/// Posts beyond the hops that were searched.
const NOT_SEARCHED: RGBColor = RGBColor(170, 170, 170);

/// The colours of starts, in turn; colour-blind readers can distinguish them.
const STARTS: [RGBColor; 6] = [SKY, ORANGE, GREEN, PURPLE, BLUE, VERMILION];

/// The greatest number of starts that a style lists.
const MOST_STARTS: usize = 1000;

/// The style of a raster with one colour for each class of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterStyle {
    /// In ascending order: the greatest number of a class, its colour and its name.
    classes: Vec<(f64, RGBColor, String)>,
}

impl RasterStyle {
    /// The style of a raster of hop counts, in the classes and colours of the picture.
    pub fn hops(hops: &[i16]) -> Self {
        let most = hops.iter().filter_map(|&hops| u64::try_from(hops).ok()).max();
        let classes = HopClasses::up_to(most.map_or(0, |most| most.max(1)));
        let mut found = marks();
        found.push((0.0, tone(classes.colour(0)), "start".to_owned()));
        for ((index, &most), text) in classes.0.iter().enumerate().zip(classes.texts()) {
            #[expect(clippy::cast_precision_loss, reason = "a count of hops")]
            let most = most as f64;
            found.push((most, tone(classes.colour(index)), text));
        }
        Self { classes: found }
    }

    /// The style of a raster of a continuous value, in at most seven classes between round numbers, with its unit.
    pub fn values(values: &[f32], unit: &str) -> Self {
        let steps = Steps::of(values.iter().copied().map(f64::from));
        let ends = steps.ends.iter().skip(1).copied();
        let classes = ends.zip(steps.tones()).zip(steps.texts());
        Self { classes: classes.map(|((end, tone), text)| (end, tone, format!("{text} {unit}"))).collect() }
    }

    /// The style of a raster of the numbers of so many starts.
    pub fn starts(count: usize) -> Self {
        let mut found = marks();
        for (number, colour) in (1..=count.min(MOST_STARTS)).zip(STARTS.into_iter().cycle()) {
            #[expect(clippy::cast_precision_loss, reason = "at most a thousand")]
            let end = number as f64;
            found.push((end, tone(colour), format!("start {number}")));
        }
        Self { classes: found }
    }

    /// The style of a raster of predecessors among so many posts: sources apart from bands of posts.
    pub fn predecessors(posts: usize) -> Self {
        const BANDS: u32 = 8;
        let mut found = vec![(-1.0, RGBColor(0, 0, 0), "start".to_owned())];
        #[expect(clippy::cast_precision_loss, reason = "an index of a post")]
        let last = posts.saturating_sub(1) as f64;
        found.extend((1..=BANDS).map(|band| {
            let share = f64::from(band) / f64::from(BANDS);
            let end = (share * last).floor();
            (end, tone(ramp(share)), format!("from posts up to {}", short(end)))
        }));
        Self { classes: found }
    }

    /// The text of the style's file.
    pub fn qml(&self) -> String {
        let (least, most) = (self.classes.first().map_or(0.0, |class| class.0), self.classes.last().map_or(0.0, |class| class.0));
        let mut text = format!(
            "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n\
             <qgis version=\"3.28.0\" styleCategories=\"Symbology\">\n  <pipe>\n    \
             <rasterrenderer type=\"singlebandpseudocolor\" band=\"1\" opacity=\"1\" alphaBand=\"-1\" nodataColor=\"\" \
             classificationMin=\"{least}\" classificationMax=\"{most}\">\n      <rastershader>\n        \
             <colorrampshader colorRampType=\"DISCRETE\" classificationMode=\"1\" clip=\"0\" minimumValue=\"{least}\" \
             maximumValue=\"{most}\">\n"
        );
        for (end, RGBColor(r, g, b), label) in &self.classes {
            let label = escaped(label);
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "          <item value=\"{end}\" color=\"#{r:02x}{g:02x}{b:02x}\" alpha=\"255\" label=\"{label}\"/>"
            );
        }
        text.push_str("        </colorrampshader>\n      </rastershader>\n    </rasterrenderer>\n  </pipe>\n</qgis>\n");
        text
    }
}

/// The classes of the marks of posts without a path.
fn marks() -> Vec<(f64, RGBColor, String)> {
    vec![
        (f64::from(HOPS_NOT_SEARCHED), NOT_SEARCHED, "not searched".to_owned()),
        (f64::from(HOPS_UNREACHABLE), NOT_REACHED, "not reached".to_owned()),
    ]
}

/// Text within an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The attributes of every class of a style: value, colour and label.
    fn classes(style: &RasterStyle) -> Vec<(f64, String, String)> {
        let text = style.qml();
        let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
        let document = roxmltree::Document::parse_with_options(&text, options).unwrap();
        let items = document.descendants().filter(|node| node.has_tag_name("item"));
        let of = |node: roxmltree::Node<'_, '_>, name| node.attribute(name).unwrap().to_owned();
        items.map(|node| (of(node, "value").parse().unwrap(), of(node, "color"), of(node, "label"))).collect()
    }

    #[test]
    fn styles_are_well_formed_and_each_class_has_a_colour_and_a_name_of_its_own() {
        let styles = [
            RasterStyle::hops(&[0, 1, 2, 5, 12, 40, -1, i16::MIN]),
            RasterStyle::hops(&[i16::MIN]),
            RasterStyle::hops(&[0]),
            RasterStyle::values(&[0.5, 3.0, f32::NAN, 7.25], "m/s & \"<more>\""),
            RasterStyle::values(&[f32::NAN], "s"),
            RasterStyle::starts(3),
            RasterStyle::starts(1),
            RasterStyle::predecessors(5000),
        ];
        for style in &styles {
            let found = classes(style);
            assert_eq!(found.len(), style.classes.len());
            assert!(found.windows(2).all(|pair| pair[0].0 < pair[1].0), "the ends rise: {found:?}");
            let mut labels: Vec<_> = found.iter().map(|class| &class.2).collect();
            labels.sort();
            labels.dedup();
            assert_eq!(labels.len(), found.len(), "{found:?}");
        }
        let hops = classes(&styles[0]);
        assert_eq!(hops.iter().map(|class| class.0).collect::<Vec<_>>(), [-2.0, -1.0, 0.0, 10.0, 20.0, 30.0, 40.0]);
        assert_eq!(hops[1].2, "not reached");
        assert!(classes(&styles[3])[0].2.ends_with("m/s & \"<more>\""));
    }
}
