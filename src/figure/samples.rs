//! Shared by the tests of all pictures: a general check of a picture, real terrain, and a folder for viewing pictures.

use std::path::PathBuf;

use super::{
    Picture,
    picture::PAGE_HEIGHT_MM,
    sheet::{Label, Mark},
};
use crate::terrain::{Dem, read_dem};

/// Checks that tags are balanced, attributes are quoted and special characters are escaped.
pub(super) fn check_well_formed(svg: &str) {
    let mut open = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        let text = &rest[..start];
        assert!(!text.contains('>'), "bare > in {text:?}");
        for (at, _) in text.match_indices('&') {
            let entity = ["&lt;", "&gt;", "&amp;", "&quot;", "&apos;"].iter().any(|known| text[at..].starts_with(known));
            assert!(entity, "bare & in {text:?}");
        }
        let end = start + rest[start..].find('>').unwrap();
        let tag = &rest[start + 1..end];
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else {
            assert!(tag.matches('"').count().is_multiple_of(2), "{tag}");
            if !tag.ends_with('/') {
                open.push(tag.split_whitespace().next().unwrap());
            }
        }
        rest = &rest[end + 1..];
    }
    assert!(open.is_empty() && rest.trim().is_empty(), "{open:?} left open");
}

/// Checks that a picture is well-formed, small and reproducible, that its texts are on the page without overlap, and that it
/// contains no NaN. With `CHTA_FIGURES_TO=folder` it is also written there as SVG and PNG, for viewing.
pub(super) fn check_picture(name: &str, draw: impl Fn() -> Picture) -> Picture {
    let picture = draw();
    let svg = picture.to_svg().unwrap();
    check_well_formed(&svg);
    assert!(svg.len() < 500_000, "{name}: {} bytes", svg.len());
    // The base64 text of an image may contain any letters.
    let without_images =
        svg.split("base64,").enumerate().map(|(i, part)| if i == 0 { part } else { &part[part.find('"').unwrap()..] });
    let numbers: String = without_images.collect();
    assert!(!numbers.contains("NaN") && !numbers.contains("inf\""), "{name}");
    let again = draw();
    assert_eq!(picture, again, "{name} is not reproducible");
    assert_eq!(svg, again.to_svg().unwrap());
    let pages = picture.pages();
    let high_mm = if pages.len() > 1 { PAGE_HEIGHT_MM } else { 400.0 };
    for page in &pages {
        assert!(page.height_mm.is_finite() && page.height_mm <= high_mm, "{name}: {} mm", page.height_mm);
        for label in labels(page) {
            let (_, top, _, bottom) = label.bounds_mm();
            assert!(top >= 0.3 && bottom <= page.height_mm, "{name}: {:?} leaves its page: {top} to {bottom}", label.text);
        }
    }
    if let Some(folder) = std::env::var_os("CHTA_FIGURES_TO").map(PathBuf::from) {
        std::fs::write(folder.join(name).with_extension("svg"), &svg).unwrap();
        std::fs::write(folder.join(name).with_extension("png"), picture.to_png().unwrap()).unwrap();
    }
    let labels = labels(&picture);
    for (i, label) in labels.iter().enumerate() {
        let (left, top, right, bottom) = label.bounds_mm();
        let inside = left >= 0.3 && right <= picture.width_mm - 0.3 && top >= 0.3 && bottom <= picture.height_mm;
        assert!(inside, "{name}: {:?} leaves the page: {left} to {right}, {top} to {bottom}", label.text);
        for other in &labels[i + 1..] {
            let (l, t, r, b) = other.bounds_mm();
            let apart = right <= l || r <= left || bottom <= t || b <= top;
            assert!(apart, "{name}: {:?} over {:?}", label.text, other.text);
        }
    }
    picture
}

/// The texts of a picture.
pub(super) fn labels(picture: &Picture) -> Vec<Label> {
    let label = |mark: &Mark| if let Mark::Label(label) = mark { Some(label.clone()) } else { None };
    picture.sheet.marks.iter().filter_map(label).collect()
}

/// The texts of a picture, one on each line.
pub(super) fn texts(picture: &Picture) -> String {
    labels(picture).into_iter().map(|label| label.text).collect::<Vec<_>>().join("\n")
}

/// A DEM of `../shared/dem`; prints a reason if it is absent.
#[expect(clippy::print_stderr, reason = "says why a test has nothing to look at")]
pub(super) fn real_dem(name: &str) -> Option<Dem> {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(name);
    if !file.exists() {
        eprintln!("skipped: {} is not there", file.display());
        return None;
    }
    Some(read_dem(&file).unwrap())
}
