//! Maps of real and synthetic terrain: contents, texts and legibility.

use super::{
    super::{
        Caption, Picture,
        bitmap::Form,
        samples::{check_picture, real_dem, texts},
    },
    landings::rim,
    raster::Window,
    *,
};
use crate::{
    quantity::MapPoint,
    terrain::{Dem, GeoReference},
};

const MARS: &str = "hirise_DTEEC_010228_1490_crop_120x70.tif";
const MOON: &str = "lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif";

/// Waves on a local map, with a hole.
fn made_up(rows: usize, cols: usize, spacing_m: f64) -> Dem {
    let map = GeoReference::local(MapPoint::new(-120.5, 80.0), spacing_m, spacing_m).unwrap();
    let height = |i: usize| {
        let (row, col) = ((i / cols) as f64, (i % cols) as f64);
        let hole = (i / cols) * 7 / rows == 3 && (i % cols) * 9 / cols == 2;
        let waves = libm::sin(row * 40.0 / rows as f64) + libm::cos(col * 25.0 / cols as f64);
        if hole { f64::NAN } else { spacing_m * 0.01 * rows as f64 * waves }
    };
    Dem::new(rows, cols, (0..rows * cols).map(height).collect(), map).unwrap()
}

/// Hop counts that grow with the distance from a post; steep posts and far ones are not reached.
fn made_up_hops(posts: &MapPosts<'_>, start: (usize, usize), posts_per_hop: f64, most: f64) -> Vec<i16> {
    let (rows, cols) = posts.size();
    let hops = |i: usize| {
        let (row, col) = (i / cols * posts.stride, i % cols * posts.stride);
        let Some(light) = hillshade::brightness(posts.dem, row, col) else { return HOPS_NO_DATA };
        let away = libm::hypot(row as f64 - start.0 as f64, col as f64 - start.1 as f64) / posts_per_hop;
        if light < 0.4 || away.ceil() > most { HOPS_UNREACHABLE } else { away.ceil() as i16 }
    };
    (0..rows * cols).map(hops).collect()
}

fn hop_map<'a>(posts: MapPosts<'a>, hops: &'a [i16], can_return: Option<&'a [bool]>) -> HopMapFigure<'a> {
    let at = |row: usize, col: usize| posts.dem.georeference().post(row * posts.dem.rows() / 100, col * posts.dem.cols() / 100);
    let goals = vec![GoalMark { at: at(20, 80), hops: Some(7) }, GoalMark { at: at(88, 30), hops: None }];
    let path = vec![at(50, 50), at(44, 55), at(40, 62), at(31, 66), at(25, 72), at(20, 80)];
    let caption = Caption::new("A map", "Moon, g = 1.624 m/s²; take-off speed ≤ 10 m/s; friction coefficient 0.6");
    HopMapFigure { caption, posts, hops, can_return, refused: Vec::new(), starts: vec![at(50, 50)], goals, paths: vec![path] }
}

fn drawn(name: &str, posts: MapPosts<'_>, per_hop: f64, most: f64, with_return: bool) -> Picture {
    let middle = (posts.dem.rows() / 2, posts.dem.cols() / 2);
    let hops = made_up_hops(&posts, middle, per_hop, most);
    let back: Vec<bool> = (0..hops.len()).map(|i| i % posts.size().1 > posts.size().1 / 3).collect();
    let picture = check_picture(name, || draw_hop_map(&hop_map(posts, &hops, with_return.then_some(&back))).unwrap());
    let lettering = texts(&picture);
    let is_bar =
        |line: &str| line.strip_suffix(" m").is_some_and(|length| length.parse::<f64>().is_ok_and(|length_m| length_m > 0.0));
    assert!(lettering.lines().any(is_bar), "the scale bar's length: {lettering}");
    // Every post is in exactly one entry of the legend.
    let counts = texts(&picture)
        .lines()
        .filter(|line| !line.contains("to the start"))
        .filter_map(|line| {
            let (_, count) = line.rsplit_once(": ")?;
            count.strip_suffix(" posts").or(count.strip_suffix(" post"))?.parse::<usize>().ok()
        })
        .sum::<usize>();
    assert_eq!(counts, hops.len(), "{}", texts(&picture));
    picture
}

#[test]
fn hop_maps_of_real_terrain_are_complete() {
    for (name, file, per_hop, most) in [("hops-mars", MARS, 6.0, 7.0), ("hops-moon", MOON, 5.0, 30.0)] {
        let Some(dem) = real_dem(file) else { continue };
        let picture = drawn(name, MapPosts { dem: &dem, stride: 1, per_post: 1 }, per_hop, most, name == "hops-moon");
        assert_eq!(picture.sheet.images.len(), 1, "one raster");
        let texts = texts(&picture);
        for words in
            ["map x, east (m)", "map y, north (m)", "N (grid)", "start", "goal 1: 7 hops", "goal 2: not reached", "not reached: "]
        {
            assert!(texts.contains(words), "{words:?} is missing in {texts}");
        }
        assert_eq!(texts.contains("no path back"), name == "hops-moon");
    }
}

#[test]
fn maps_with_a_stride_with_holes_and_with_many_posts_are_complete_and_say_so() {
    let small = made_up(31, 47, 2.5);
    let picture = drawn("hops-stride", MapPosts { dem: &small, stride: 4, per_post: 1 }, 3.0, 300.0, false);
    let lettering = texts(&picture);
    assert!(lettering.contains("no data: ") && lettering.contains("one post in 4 each way, 10 m apart"), "{lettering}");
    let large = made_up(2100, 300, 5.0);
    let picture = drawn("hops-large", MapPosts { dem: &large, stride: 1, per_post: 1 }, 12.0, 1000.0, false);
    assert!(texts(&picture).contains("Drawn: one post in 2 each way"));
    let image = &picture.sheet.images[0].pixels;
    assert_eq!((image.width, image.height), (150, 1050));
    assert!((picture.sheet.images[0].height_mm / picture.sheet.images[0].width_mm - 2100.0 / 300.0).abs() < 1e-9, "one scale");
}

#[test]
fn pixels_show_the_class_of_their_post() {
    let dem = made_up(12, 20, 1.0);
    let posts = MapPosts { dem: &dem, stride: 1, per_post: 1 };
    let hops: Vec<i16> =
        (0..240).map(|i| if dem.elevation(i / 20, i % 20).is_none() { HOPS_NO_DATA } else { (i % 4) as i16 - 1 }).collect();
    let picture = draw_hop_map(&hop_map(posts, &hops, None)).unwrap();
    let image = &picture.sheet.images[0].pixels;
    let Form::Palette(colours) = &image.form else { panic!("a palette") };
    let (up, shades) = (image.width / 20, (colours.len() - 2) / 3);
    for (i, &hops) in hops.iter().enumerate() {
        // A pixel off the stripes of posts that are not reached.
        for corner in [2, up - 2] {
            let index = usize::from(image.bytes[(i / 20 * up + corner) * image.width + i % 20 * up + corner]);
            if index == 1 {
                assert_eq!(hops, HOPS_UNREACHABLE, "a pattern over post {i}");
                continue;
            }
            // The start's class is that of one hop; classes of 1 and 2 hops, then not reached.
            let class = match hops {
                HOPS_NO_DATA => {
                    assert_eq!(index, 0);
                    continue;
                }
                HOPS_UNREACHABLE => 2,
                hops => hops.max(1) as usize - 1,
            };
            assert_eq!((index - 2) / shades, class, "post {i} with {hops} hops");
        }
    }
}

#[test]
fn nothing_reached_only_the_start_and_very_many_hops_are_drawn() {
    let dem = made_up(9, 30, 1.0);
    let posts = MapPosts { dem: &dem, stride: 1, per_post: 1 };
    for (name, value) in
        [("hops-none", HOPS_UNREACHABLE), ("hops-start", 0), ("hops-most", i16::MAX), ("hops-no-data", HOPS_NO_DATA)]
    {
        let hops = vec![value; 270];
        check_picture(name, || draw_hop_map(&hop_map(posts, &hops, Some(&[true; 270]))).unwrap());
    }
    let error = draw_hop_map(&hop_map(posts, &[0; 269], None)).unwrap_err();
    assert_eq!(error, FigureError::RasterSize { what: "hop map", found: 269, rows: 9, cols: 30 });
    assert!(draw_hop_map(&hop_map(posts, &[0; 270], Some(&[true; 3]))).is_err());
}

#[test]
fn keep_out_posts_are_a_separate_class_and_zero_posts_without_return_path_are_stated() {
    let dem = made_up(12, 20, 1.0);
    let posts = MapPosts { dem: &dem, stride: 1, per_post: 1 };
    let at = |i: usize| dem.elevation(i / 20, i % 20);
    let hops: Vec<i16> = (0..240)
        .map(|i| match at(i) {
            None => HOPS_NO_DATA,
            Some(_) if i < 60 => HOPS_UNREACHABLE,
            Some(_) => 1,
        })
        .collect();
    // A zone over the first two rows, and one over a reached post on a border, which keeps its class.
    let class = |by: RefusedBy, reason: &str, posts: &dyn Fn(usize) -> bool| RefusedPosts {
        by,
        reason: reason.to_owned(),
        posts: (0..240).map(posts).collect(),
    };
    // Of the third row, five posts are dark; of those in the zone the zone counts.
    let refused = vec![
        class(RefusedBy::Zone, "keep-out", &|i| i < 40 || i == 100),
        class(RefusedBy::Layer, "layer sun does not hold", &|i| (30..45).contains(&i)),
    ];
    let figure = HopMapFigure { refused, ..hop_map(posts, &hops, Some(&[true; 240])) };
    let picture = check_picture("hops-keep-out", || draw_hop_map(&figure).unwrap());
    let lettering = texts(&picture);
    let words = [
        "keep-out, not reached: 40 posts",
        "layer sun does not hold, not reached: 5 posts",
        "no hop leads there, not reached: 15 posts",
    ];
    for words in words.into_iter().chain(["no path back to the start: 0 posts"]) {
        assert!(lettering.lines().any(|line| line.ends_with(words)), "{words:?} is missing in {lettering}");
    }
    let image = &picture.sheet.images[0].pixels;
    // Each set of stripes covers two of nine pixels, and both cover four of 81: together 32 of 81.
    let of_a_row = image.width * image.width / 20;
    let inked = |row: usize| (0..of_a_row).filter(|at| image.bytes[row * of_a_row + at] == 1).count();
    assert!(inked(0).abs_diff(of_a_row * 32 / 81) < of_a_row / 40, "{} of {of_a_row} under stripes", inked(0));
    assert_eq!(inked(5), 0, "no pattern over reached posts");
    assert!(
        draw_hop_map(&HopMapFigure {
            refused: vec![RefusedPosts { by: RefusedBy::Zone, reason: String::new(), posts: vec![true; 3] }],
            ..figure
        })
        .is_err()
    );
}

fn value_map<'a>(posts: MapPosts<'a>, values: &'a [f64], name: &str) -> ValueMapFigure<'a> {
    ValueMapFigure {
        caption: Caption::new("A map of values & <more>", "Mars"),
        posts,
        values,
        refused: Vec::new(),
        value_name: name.to_owned(),
        none_name: "not reached".to_owned(),
        starts: Vec::new(),
        goals: Vec::new(),
        paths: Vec::new(),
    }
}

#[test]
fn value_maps_have_round_classes_and_accept_any_values() {
    if let Some(dem) = real_dem(MOON) {
        let posts = MapPosts { dem: &dem, stride: 2, per_post: 1 };
        let values: Vec<f64> = (0..128 * 128usize)
            .map(|i| {
                let away = libm::hypot((i / 128) as f64 - 60.0, (i % 128) as f64 - 70.0);
                if away > 55.0 { f64::NAN } else { away * 2.7 }
            })
            .collect();
        let picture =
            check_picture("effort-moon", || draw_value_map(&value_map(posts, &values, "least total effort (m/s)")).unwrap());
        let texts = texts(&picture);
        for words in ["0 to 25", "125 to 150", "not reached", "Colours: least total effort (m/s); from 0 to 148"] {
            assert!(texts.contains(words), "{words:?} is missing in {texts}");
        }
    }
    let dem = made_up(9, 30, 1.0);
    let posts = MapPosts { dem: &dem, stride: 1, per_post: 1 };
    for (name, value) in
        [("values-none", f64::NAN), ("values-equal", 3.25), ("values-infinite", f64::INFINITY), ("values-huge", 1e300)]
    {
        let mut values = vec![value; 270];
        if value > 1e200 && value.is_finite() {
            values[7] = -value;
        }
        let picture = check_picture(name, || draw_value_map(&value_map(posts, &values, "share")).unwrap());
        assert_eq!(texts(&picture).contains("not reached"), !value.is_finite(), "{name}: {}", texts(&picture));
    }
    assert!(draw_value_map(&value_map(posts, &[0.0], "share")).is_err());
}

/// A path along a row with a cloud around every landing: points of ellipses with known axes, the longer one towards `heading_deg`.
fn landing_map(dem: &Dem, hops: usize, landings: usize, semi_m: (f64, f64), heading_deg: f64) -> LandingMapFigure<'_> {
    let post = |hop: usize| dem.georeference().post(dem.rows() / 2 - hop % 3, dem.cols() / 4 + hop * dem.cols() / (3 * hops));
    let cloud = |hop: usize| {
        let planned = post(hop);
        let growth = 1.0 + 0.3 * hop as f64;
        let centre = MapPoint::new(planned.x + 0.2 * semi_m.0, planned.y - 0.1 * semi_m.0);
        let ellipse = LandingEllipse {
            centre,
            semi_major_m: growth * semi_m.0,
            semi_minor_m: growth * semi_m.1,
            heading_deg: heading_deg + hop as f64,
        };
        // The golden angle spreads points evenly, less densely away from the centre.
        let landing = |i: usize| {
            let share = libm::sqrt(-2.0 * libm::log((i as f64 + 0.5) / landings as f64) / 5.991);
            let rim = rim(&ellipse);
            let on_rim = rim[i * 29 % rim.len()];
            MapPoint::new(centre.x + share * (on_rim.x - centre.x), centre.y + share * (on_rim.y - centre.y))
        };
        let landings = (0..landings).map(landing).collect();
        LandingCloud { hop, planned, landings, count: 10_000, ellipse: Some(ellipse) }
    };
    LandingMapFigure {
        caption: Caption::new("Landings of 10 000 trials", "Mars, g = 3.711 m/s²; open loop"),
        dem,
        path: (0..=hops).map(post).collect(),
        clouds: (1..=hops).map(cloud).collect(),
    }
}

#[test]
fn landing_maps_of_real_terrain_show_path_landings_and_ellipses() {
    for (name, file, hops, semi_m) in [("landings-mars", MARS, 4, (3.0, 1.2)), ("landings-moon", MOON, 15, (11.0, 8.0))] {
        let Some(dem) = real_dem(file) else { continue };
        let figure = landing_map(&dem, hops, 400, semi_m, 80.0);
        let picture = check_picture(name, || draw_landing_map(&figure).unwrap());
        let texts = texts(&picture);
        for words in ["planned path", "planned landing", "95 % ellipse", "map x, east (m)", "N (grid)", "start", "goal"] {
            assert!(texts.contains(words), "{words:?} is missing in {texts}");
        }
        // Ellipses that are small on the page have insets.
        assert_eq!(texts.contains("widest scatter: enlarged "), name == "landings-moon", "{texts}");
        assert!(texts.lines().any(|line| line == hops.to_string()), "the last hop's number: {texts}");
        if name == "landings-mars" {
            assert!(texts.contains("landing (1600 of 40000 drawn)"), "{texts}");
            assert!(
                texts.replace('\n', " ").contains("hop 1: 3.9 m by 1.56 m, 81\u{b0}; hop 2: 4.8 m by 1.92 m, 82\u{b0};"),
                "{texts}"
            );
        } else {
            assert!(texts.contains("landing (2010 of 150000 drawn)"), "every third of 400, 15 times: {texts}");
            assert!(texts.contains("half the longer axis 14.3 m to 60.5 m, half the shorter one 10.4 m to 44 m"), "{texts}");
        }
    }
}

#[test]
fn landing_maps_show_the_flown_area_and_count_landings_off_the_map() {
    let dem = made_up(200, 300, 2.0);
    let mut figure = landing_map(&dem, 3, 50, (4.0, 2.0), 0.0);
    let whole = dem.georeference().bounds(200, 300);
    let far = MapPoint::new(whole.max.x + 500.0, whole.min.y);
    figure.clouds[2].landings[7] = far;
    let picture = check_picture("landings-left", || draw_landing_map(&figure).unwrap());
    let lettering = texts(&picture);
    assert!(
        lettering.contains("Landings beyond the DEM, not drawn: 1.") && lettering.contains("landing (149 of 30000 drawn)"),
        "{lettering}"
    );
    let image = &picture.sheet.images[0];
    assert!(image.width_mm / image.height_mm > 1.2, "cut to the path, which runs east: {} by {}", image.width_mm, image.height_mm);
    // No data at all, and a path without landings.
    for clouds in [Vec::new(), vec![LandingCloud { hop: 1, planned: whole.min, landings: Vec::new(), count: 0, ellipse: None }]] {
        let figure = LandingMapFigure { caption: Caption::default(), dem: &dem, path: Vec::new(), clouds };
        let picture = check_picture("landings-none", || draw_landing_map(&figure).unwrap());
        assert!(!texts(&picture).contains("ellipse"), "{}", texts(&picture));
    }
}

#[test]
fn the_outline_of_an_ellipse_has_its_axes_and_its_heading() {
    let centre = MapPoint::new(10.0, -20.0);
    let ellipse = LandingEllipse { centre, semi_major_m: 5.0, semi_minor_m: 2.0, heading_deg: 30.0 };
    let rim = rim(&ellipse);
    // Independent computation: the equation of an ellipse in rotated axes; a heading of 30 degrees is (1/2, sqrt 3 / 2).
    let along = (0.5, libm::sqrt(3.0) / 2.0);
    for at in &rim {
        let (x, y) = (at.x - centre.x, at.y - centre.y);
        let (u, v) = (x * along.0 + y * along.1, x * along.1 - y * along.0);
        assert!((u * u / 25.0 + v * v / 4.0 - 1.0).abs() < 1e-12, "{at:?}");
    }
    assert!((rim[0].x - 12.5).abs() < 1e-12 && (rim[0].y - (-20.0 + 5.0 * along.1)).abs() < 1e-12, "{:?}", rim[0]);
}

#[test]
fn windows_contain_their_points_with_a_margin_and_stay_on_the_dem() {
    let dem = made_up(60, 90, 2.0);
    let post = |row, col| dem.georeference().post(row, col);
    let window = Window::around(&dem, [post(20, 30), post(30, 80)].into_iter());
    assert_eq!(window, Window { rows: 15..36, cols: 25..86 }, "5 posts, a tenth of 50, on each side");
    let corner = Window::around(&dem, [post(0, 89)].into_iter());
    assert_eq!(corner, Window { rows: 0..5, cols: 85..90 });
    assert_eq!(Window::around(&dem, std::iter::empty()), Window::whole(&dem));
    assert_eq!(Window::around(&dem, [MapPoint::new(f64::NAN, 0.0)].into_iter()), Window::whole(&dem));
}
