//! Marks as pixels: position, coverage and colour.

use sha2::{Digest as _, Sha256};

use super::*;
use crate::figure::{
    palette::BLACK,
    sheet::{Anchor, Hang, Label},
};

/// The rows of a small page after drawing some marks, as shares of black.
fn shares(canvas: &Canvas) -> Vec<f64> {
    canvas.pixels.bytes.chunks(3).map(|rgb| 1.0 - f64::from(rgb[0]) / 255.0).collect()
}

fn mm(pixels: f64) -> f64 {
    pixels / PIXELS_PER_MM
}

#[test]
fn areas_cover_their_measure() {
    let mut canvas = Canvas::new(40, 30);
    let (l, t, r, b) = (mm(4.25), mm(3.5), mm(20.75), mm(17.25));
    canvas.fill(&[vec![(l, t), (r, t), (r, b), (l, b)]], BLACK, 1.0);
    let all = shares(&canvas);
    let covered: f64 = all.iter().sum();
    assert!((covered - 16.5 * 13.75).abs() < 0.5, "{covered}");
    let (inside, edge, corner) = (all[10 * 40 + 10], all[10 * 40 + 4], all[3 * 40 + 4]);
    assert_eq!(inside, 1.0);
    assert!((edge - 0.75).abs() < 0.01 && (corner - 0.375).abs() < 0.01, "{edge} {corner}");
}

#[test]
fn lines_are_as_dark_at_their_joints_and_crossings_as_elsewhere() {
    let mut canvas = Canvas::new(60, 60);
    let line: Vec<Place> = [(5.0, 30.0), (50.0, 30.0), (50.0, 5.0), (30.0, 5.0), (30.0, 55.0)].map(|(x, y)| (mm(x), mm(y))).into();
    let pen = Pen { colour: BLACK, width_mm: mm(4.0) };
    canvas.fill(&stroke(&line, pen), BLACK, 1.0);
    let covered: f64 = shares(&canvas).iter().sum();
    // 45 + 25 + 20 + 50 long and 4 wide; the crossing counts once, the three outer corners are quarter discs.
    let expected = 4.0 * (45.0 + 25.0 + 20.0 + 50.0) - 16.0 - 3.0 * (4.0 - std::f64::consts::PI);
    assert!((covered - expected).abs() < 3.0, "{covered}, expected {expected}");
}

#[test]
fn marks_beyond_the_edge_are_clipped() {
    let mut canvas = Canvas::new(20, 20);
    canvas.fill(&[vec![(mm(-900.0), mm(5.0)), (mm(900.0), mm(5.0)), (mm(900.0), mm(9.0)), (mm(-900.0), mm(9.0))]], BLACK, 0.5);
    let all = shares(&canvas);
    assert!((all.iter().sum::<f64>() - 0.5 * 4.0 * 20.0).abs() < 0.2);
    assert_eq!(all[0], 0.0);
    canvas.fill(&[vec![(f64::NAN, 1.0), (2.0, 2.0)], vec![]], BLACK, 1.0);
}

#[test]
fn letters_have_their_width_position_and_direction() {
    let letters = Letters::new().unwrap();
    let label = |text: &str| Label::new(text, (100.0, 50.0), 10.0);
    let box_of = |label: &Label| {
        let all: Vec<Place> = letters.outlines(label).concat();
        let fold = |pick: fn(&Place) -> f64| all.iter().map(pick).fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
        (fold(|p| p.0), fold(|p| p.1))
    };
    // Capital letters of DejaVu are 0.729 em high, and H 0.752 em wide with 0.098 em before it.
    let ((left, right), (top, bottom)) = box_of(&label("H").hung(Anchor::Start, Hang::Below));
    assert!((bottom - 57.6).abs() < 0.01 && (bottom - top - 7.29).abs() < 0.01, "{top} {bottom}");
    assert!((left - 100.98).abs() < 0.01 && right < 107.52, "{left} {right}");
    let ((left, right), _) = box_of(&label("HHHH").hung(Anchor::End, Hang::Through));
    assert!(left > 69.0 && right < 100.0);
    let ((left, right), (top, bottom)) = box_of(&label("H").turned());
    assert!(right - left > 7.2 && bottom <= 50.0 && top > 42.0, "{left} {right} {top} {bottom}");
    for text in ["\u{b0}\u{b2}\u{2264}\u{2265}\u{d7}\u{b1}\u{3bc}\u{416}\u{e9}\u{2013}"] {
        for letter in text.chars() {
            assert!(letters.outlines(&label(&letter.to_string())) != letters.outlines(&label("\u{10ffff}")), "{letter} is missing");
        }
    }
}

#[test]
fn images_are_at_their_position() {
    let mut canvas = Canvas::new(40, 20);
    let pixels = Pixels { width: 2, height: 1, form: Form::Palette(vec![[0, 0, 0], [255, 0, 0]]), bytes: vec![0, 1] };
    let image = SheetImage { left_mm: mm(10.0), top_mm: mm(5.0), width_mm: mm(20.0), height_mm: mm(10.0), pixels };
    canvas.image(&image);
    let at = |x: usize, y: usize| canvas.pixels.colour(x, y);
    assert_eq!([at(10, 5), at(19, 14), at(20, 5), at(29, 14)], [[0; 3], [0; 3], [255, 0, 0], [255, 0, 0]]);
    assert_eq!([at(9, 5), at(30, 5), at(10, 4), at(10, 15)], [[255; 3]; 4]);
}

/// Every kind of mark: the checksum is that of the same bytes on every processor.
#[test]
fn a_picture_has_the_same_bytes_on_every_machine() {
    let mut sheet = Sheet::default();
    let pen = Pen { colour: RGBColor(0, 90, 160), width_mm: 0.3 };
    sheet.marks = vec![
        Mark::Area { points: vec![(1.0, 1.0), (19.3, 2.1), (11.7, 12.9)], colour: RGBColor(200, 120, 0), opacity: 0.4 },
        Mark::Line { points: vec![(2.0, 2.0), (9.5, 13.0), (12.1, 3.3), (12.1, 13.7)], pen },
        Mark::Dot { centre: (5.2, 5.1), radius_mm: 1.3, pen, filled: true },
        Mark::Dot { centre: (15.2, 5.1), radius_mm: 1.3, pen, filled: false },
        Mark::Label(Label::new("9 hops, 45\u{b0}", (3.0, 8.0), 2.5)),
        Mark::Label(Label::new("\u{2264} 2.5 m/s", (17.0, 13.0), 2.0).turned()),
    ];
    let image = Pixels { width: 2, height: 2, form: Form::Palette(vec![[0, 0, 0], [255, 0, 0]]), bytes: vec![0, 1, 1, 0] };
    sheet.images = vec![SheetImage { left_mm: 14.0, top_mm: 9.0, width_mm: 4.0, height_mm: 4.0, pixels: image }];
    let png = render(&sheet, 20.0, 15.0).unwrap();
    let mut decoder = ::png::Decoder::new(std::io::Cursor::new(&png)).read_info().unwrap();
    let mut bytes = vec![0; decoder.output_buffer_size().unwrap()];
    decoder.next_frame(&mut bytes).unwrap();
    let drawn = pixels(&sheet, 20.0, 15.0).unwrap();
    assert_eq!((drawn.width, drawn.height), (236, 177));
    assert!(bytes == drawn.bytes, "the decoded pixels are those that were drawn");
    let hex = |bytes: &[u8]| format!("{:x}", Sha256::digest(bytes));
    assert_eq!(hex(&drawn.bytes), "a2cbbbba3e2c9ea669b86cae6145aa798cf26f282cdc7f1f902fa7a451ce4743", "pixels");
    assert_eq!(hex(&png), "28e89aa2fd55da170f94a2a9d7cc224003fc228ee3b9ee330d7792aa52b420e0", "file of {} bytes", png.len());
}
