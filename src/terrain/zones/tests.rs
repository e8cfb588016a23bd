#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "tests index rasters of some hundred posts by coordinates"
)]

use std::path::PathBuf;

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

use super::*;
use crate::{
    quantity::MapPoint,
    terrain::{Dem, GeoReference, MapBounds, Profile, slice, write_ascii_grid},
    world::FrictionCone,
};

/// A plain of 1 m posts from (0, 0) to (side, side).
fn plain(side: u32) -> Dem {
    let count = side as usize + 1;
    let map = GeoReference::local(MapPoint::new(0.0, f64::from(side)), 1.0, 1.0).unwrap();
    Dem::new(count, count, (0..count * count).map(|i| (i % 7) as f64 * 0.1).collect(), map).unwrap()
}

fn file(content: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("zones.geojson");
    std::fs::write(&path, content).unwrap();
    (folder, path)
}

fn zones(content: &str, terrain: &Dem) -> KeepOut {
    let (_folder, path) = file(content);
    read_keep_out(&path, None, terrain.bounds()).unwrap()
}

fn ring_text(ring: &[(i64, i64)]) -> String {
    let points: Vec<String> = ring.iter().chain(&ring[..1]).map(|(x, y)| format!("[{x},{y}]")).collect();
    format!("[{}]", points.join(","))
}

/// Stretches of one flag: (from, to, kept out), m.
fn flags(profile: &Profile) -> Vec<(f64, f64, bool)> {
    let mut found: Vec<(f64, f64, bool)> = Vec::new();
    for (pair, facet) in profile.points.windows(2).zip(&profile.facets) {
        match found.last_mut() {
            Some(last) if last.2 == facet.keep_out => last.1 = pair[1].x_m,
            _ => found.push((pair[0].x_m, pair[1].x_m, facet.keep_out)),
        }
    }
    found
}

fn walk(terrain: &Dem, zones: &KeepOut, from: (f64, f64), to: (f64, f64)) -> Vec<(f64, f64, bool)> {
    let mut profile = slice(terrain, MapPoint::new(from.0, from.1), MapPoint::new(to.0, to.1)).unwrap();
    zones.mark(&mut profile).unwrap();
    flags(&profile)
}

/// Whether the point `at / scale` lies in a closed polygon by the even-odd rule, in integer arithmetic.
fn contains(rings: &[Vec<(i64, i64)>], at: (i64, i64), scale: i64) -> bool {
    let mut odd = false;
    for ring in rings {
        for (i, a) in ring.iter().enumerate() {
            let b = ring[(i + 1) % ring.len()];
            let (ax, ay, bx, by) = (a.0 * scale - at.0, a.1 * scale - at.1, b.0 * scale - at.0, b.1 * scale - at.1);
            let cross = ax * by - ay * bx;
            if cross == 0 && ax * bx + ay * by <= 0 {
                return true;
            }
            if (ay > 0) != (by > 0) && (cross > 0) == (by > ay) {
                odd = !odd;
            }
        }
    }
    odd
}

#[test]
fn random_polygons_agree_with_integer_arithmetic_at_every_position() {
    let terrain = plain(12);
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut checked = [0_usize; 2];
    for _ in 0..400 {
        let mut corner = |low: i64, high: i64| (random.random_range(low..=high), random.random_range(low..=high));
        // Self-intersecting and overlapping rings, with edges and corners on posts, rows and the transect itself.
        let polygons: Vec<Vec<Vec<(i64, i64)>>> =
            (0..2).map(|_| (0..2).map(|_| (0..5).map(|_| corner(-2, 14)).collect()).collect()).collect();
        let flat = |ring: &Vec<(i64, i64)>| {
            ring.iter().all(|c| (c.0 - ring[0].0) * (ring[1].1 - ring[0].1) == (c.1 - ring[0].1) * (ring[1].0 - ring[0].0))
        };
        let (from, to) = (corner(0, 12), corner(0, 12));
        if from == to || polygons.iter().flatten().any(flat) {
            continue;
        }
        let text: Vec<String> = polygons
            .iter()
            .map(|rings| format!("[{}]", rings.iter().map(|ring| ring_text(ring)).collect::<Vec<_>>().join(",")))
            .collect();
        let text = format!(r#"{{"type":"MultiPolygon","coordinates":[{}]}}"#, text.join(","));
        let (_folder, path) = file(&text);
        let Ok(kept) = read_keep_out(&path, None, terrain.bounds()) else { continue };
        let map = |p: (i64, i64)| MapPoint::new(p.0 as f64, p.1 as f64);
        let mut profile = slice(&terrain, map(from), map(to)).unwrap();
        let untouched = profile.clone();
        kept.mark(&mut profile).unwrap();
        assert!(profile.points.windows(2).all(|pair| pair[0].x_m < pair[1].x_m));
        assert!(untouched.points.iter().all(|point| profile.points.contains(point)), "no vertex moves");
        let length_m = profile.length_m();
        for k in 1..1009 {
            let x_m = length_m * k as f64 / 1009.0;
            let next = profile.points.partition_point(|point| point.x_m < x_m);
            if [next - 1, next].iter().any(|&i| (profile.points[i].x_m - x_m).abs() < 1e-9) {
                continue;
            }
            let at = (from.0 * 1009 + k * (to.0 - from.0), from.1 * 1009 + k * (to.1 - from.1));
            let expected = polygons.iter().any(|rings| contains(rings, at, 1009));
            assert_eq!(profile.facets[next - 1].keep_out, expected, "{text} from {from:?} to {to:?} at {x_m} m");
            let place = map(from) + (map(to) - map(from)) * (k as f64 / 1009.0);
            assert!(k % 7 != 0 || kept.keeps_out(place) == expected, "{text} at {place}");
            checked[usize::from(expected)] += 1;
        }
        // Heights and facets of the ground are unchanged.
        for (pair, facet) in profile.points.windows(2).zip(&profile.facets) {
            let own = untouched.points.partition_point(|p| p.x_m <= pair[0].x_m) - 1;
            assert_eq!((facet.normal, facet.cross_slope), (untouched.facets[own].normal, untouched.facets[own].cross_slope));
            let (a, b) = (untouched.points[own], untouched.points[own + 1]);
            let line_m = |x_m: f64| a.z_m + (b.z_m - a.z_m) * (x_m - a.x_m) / (b.x_m - a.x_m);
            assert!((pair[0].z_m - line_m(pair[0].x_m)).abs() < 1e-12 && (pair[1].z_m - line_m(pair[1].x_m)).abs() < 1e-12);
        }
        let mut back = slice(&terrain, map(to), map(from)).unwrap();
        kept.mark(&mut back).unwrap();
        assert_eq!(back.points.len(), profile.points.len());
        for (there, back) in profile.points.iter().zip(back.points.iter().rev()) {
            assert!((there.map - back.map).norm() < 1e-12 && (there.z_m - back.z_m).abs() < 1e-12);
        }
        assert!(profile.facets.iter().eq(back.facets.iter().rev()));
    }
    assert!(checked.iter().all(|&count| count > 50_000), "{checked:?}");
}

#[test]
fn degenerate_zones_are_handled() {
    let terrain = plain(10);
    // A square with a hole, on posts.
    let holed = zones(
        r#"{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":
            [[[2,2],[8,2],[8,8],[2,8],[2,2]],[[4,4],[6,4],[6,6],[4,6],[4,4]]]}}"#,
        &terrain,
    );
    let through = [(0.0, 2.0, false), (2.0, 4.0, true), (4.0, 6.0, false), (6.0, 8.0, true), (8.0, 10.0, false)];
    assert_eq!(walk(&terrain, &holed, (0.0, 5.0), (10.0, 5.0)), through);
    assert_eq!(walk(&terrain, &holed, (10.0, 5.0), (0.0, 5.0)), through);
    assert_eq!(
        walk(&terrain, &holed, (0.0, 2.0), (10.0, 2.0)),
        [(0.0, 2.0, false), (2.0, 8.0, true), (8.0, 10.0, false)],
        "along the border"
    );
    assert_eq!(
        walk(&terrain, &holed, (0.0, 4.0), (10.0, 4.0)),
        [(0.0, 2.0, false), (2.0, 8.0, true), (8.0, 10.0, false)],
        "along the hole"
    );
    assert_eq!(walk(&terrain, &holed, (0.0, 1.999), (10.0, 1.999)), [(0.0, 10.0, false)]);
    assert_eq!(walk(&terrain, &holed, (3.0, 3.0), (7.0, 3.0)), [(0.0, 4.0, true)], "both ends inside");
    assert_eq!(walk(&terrain, &holed, (4.5, 5.0), (5.5, 5.0)), [(0.0, 1.0, false)], "both ends in the hole");
    // Two squares that touch at a corner, crossed at that corner.
    let corners = zones(
        r#"{"type":"GeometryCollection","geometries":[
            {"type":"Polygon","coordinates":[[[2,2],[5,2],[5,5],[2,5],[2,2]]]},
            {"type":"Polygon","coordinates":[[[5,5],[8,5],[8,8],[5,8],[5,5]]]}]}"#,
        &terrain,
    );
    assert_eq!(walk(&terrain, &corners, (2.0, 8.0), (8.0, 2.0)), [(0.0, 72.0_f64.sqrt(), false)], "touching a zone has no effect");
    let diagonal = walk(&terrain, &corners, (1.0, 1.0), (9.0, 9.0));
    assert_eq!(diagonal.iter().map(|stretch| stretch.2).collect::<Vec<_>>(), [false, true, false], "{diagonal:?}");
    // A zone of 4 mm between two vertices, and a bow tie.
    let tiny = zones(r#"{"type":"Polygon","coordinates":[[[3.3,2.9],[3.304,2.9],[3.304,3.1],[3.3,3.1],[3.3,2.9]]]}"#, &terrain);
    let met = walk(&terrain, &tiny, (0.5, 3.05), (9.5, 3.05));
    assert!((met[1].0 - 2.8).abs() < 1e-12 && (met[1].1 - 2.804).abs() < 1e-12 && met[1].2, "{met:?}");
    let bow = zones(r#"{"type":"Polygon","coordinates":[[[2,2],[8,8],[8,2],[2,8],[2,2]]]}"#, &terrain);
    assert_eq!(walk(&terrain, &bow, (0.0, 5.0), (10.0, 5.0)), [(0.0, 2.0, false), (2.0, 8.0, true), (8.0, 10.0, false)]);
    assert_eq!(walk(&terrain, &bow, (5.0, 0.0), (5.0, 4.5)), [(0.0, 4.5, false)]);
}

#[test]
fn far_from_zero_the_borders_stay_where_they_are() {
    let (x, y) = (75_360.7, -609_600.3);
    let map = GeoReference::local(MapPoint::new(x, y), 5.0, 5.0).unwrap();
    let terrain = Dem::new(9, 9, (0..81).map(f64::from).collect(), map).unwrap();
    let text = format!(
        r#"{{"type":"Polygon","coordinates":[[[{a},{c}],[{b},{c}],[{b},{d}],[{a},{d}],[{a},{c}]]]}}"#,
        a = x + 11.0,
        b = x + 17.5,
        c = y - 30.0,
        d = y - 5.0
    );
    let kept = zones(&text, &terrain);
    for (from, to) in
        [((x, y - 20.0), (x + 40.0, y - 20.0)), ((x, y - 5.0), (x + 40.0, y - 5.0)), ((x + 40.0, y - 30.0), (x, y - 30.0))]
    {
        let met = walk(&terrain, &kept, from, to);
        assert_eq!(met.len(), 3, "{met:?}");
        let (begin, end) = if from.0 < to.0 { (11.0, 17.5) } else { (22.5, 29.0) };
        assert!((met[1].0 - begin).abs() < 1e-9 && (met[1].1 - end).abs() < 1e-9 && met[1].2, "{met:?}");
    }
}

fn grid_file(raster: &Dem) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("raster.asc");
    write_ascii_grid(raster, std::fs::File::create(&path).unwrap()).unwrap();
    (folder, path)
}

#[test]
fn a_mask_is_the_union_of_its_pixels_cells() {
    let terrain = plain(8);
    let mut random = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..60 {
        let bits: Vec<f64> = (0..81).map(|_| if random.random_range(0..3) == 0 { 1.0 } else { 0.0 }).collect();
        let mask = Dem::new(9, 9, bits.clone(), terrain.georeference().clone()).unwrap();
        let (_folder, path) = grid_file(&mask);
        let masked = read_keep_out(&path, None, terrain.bounds()).unwrap();
        let cells: Vec<String> = (0..81)
            .filter(|&i| bits[i] != 0.0)
            .map(|i| {
                let (x, y) = ((i % 9) as f64, 8.0 - (i / 9) as f64);
                format!("[[[{0},{2}],[{1},{2}],[{1},{3}],[{0},{3}],[{0},{2}]]]", x - 0.5, x + 0.5, y - 0.5, y + 0.5)
            })
            .collect();
        let drawn = zones(&format!(r#"{{"type":"MultiPolygon","coordinates":[{}]}}"#, cells.join(",")), &terrain);
        // Multiples of one half put the line along cell borders and through their corners.
        let mut place = || (0.5 * f64::from(random.random_range(0..=16)), 0.5 * f64::from(random.random_range(0..=16)));
        let (from, to) = (place(), place());
        if from == to {
            continue;
        }
        for _ in 0..20 {
            let at = place();
            let at = MapPoint::new(at.0, at.1);
            assert_eq!(masked.keeps_out(at), drawn.keeps_out(at), "{at}");
        }
        let (a, b) = (walk(&terrain, &masked, from, to), walk(&terrain, &drawn, from, to));
        assert_eq!(a.len(), b.len(), "{from:?} {to:?}\n{a:?}\n{b:?}");
        for (a, b) in a.iter().zip(&b) {
            assert!((a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9 && a.2 == b.2, "{a:?} {b:?}");
        }
    }
}

#[test]
fn friction_comes_from_the_pixel_over_the_middle_and_the_constant_fills_gaps() {
    let terrain = plain(8);
    let map = GeoReference::local(MapPoint::new(0.25, 8.0), 1.7, 1.3).unwrap();
    let values: Vec<f64> = (0..35).map(|i| if i % 5 == 2 { f64::NAN } else { 0.3 + 0.1 * f64::from(i % 4) }).collect();
    let raster = Dem::new(7, 5, values, map).unwrap();
    let (_folder, path) = grid_file(&raster);
    let friction = read_friction_raster(&path, None).unwrap();
    let constant = FrictionCone::new(0.9).unwrap();
    let (from, to) = (MapPoint::new(0.1, 0.3), MapPoint::new(7.9, 7.2));
    let mut profile = slice(&terrain, from, to).unwrap();
    let before = profile.points.len();
    friction.lay(&mut profile, Some(constant)).unwrap();
    assert!(profile.points.len() > before);
    let coefficient_at = |at: MapPoint| {
        let (col, row) = (((at.x - 0.25) / 1.7).round(), ((8.0 - at.y) / 1.3).round());
        raster.elevation(row as usize, col as usize).unwrap_or(0.9)
    };
    let mut seen = std::collections::BTreeSet::new();
    for (pair, facet) in profile.points.windows(2).zip(&profile.facets) {
        let found = facet.friction.unwrap().coefficient();
        for share in [0.001, 0.5, 0.999] {
            let at = MapPoint::from(pair[0].map.coords * (1.0 - share) + pair[1].map.coords * share);
            assert_eq!(found, coefficient_at(at), "{at}");
            assert_eq!(friction.at(at).map_or(0.9, FrictionCone::coefficient), found, "{at}");
        }
        seen.insert(found.to_bits());
    }
    assert!(seen.len() >= 3 && seen.contains(&0.9_f64.to_bits()));
    let refused = friction.lay(&mut slice(&terrain, from, to).unwrap(), None).unwrap_err().to_string();
    assert!(
        refused.contains("friction raster")
            && refused.contains("no data at map point (")
            && refused.contains("friction_coefficient"),
        "{refused}"
    );
    // Along a border the smaller coefficient applies.
    let halves = Dem::new(2, 2, vec![0.4, 0.4, 0.7, 0.7], GeoReference::local(MapPoint::new(2.0, 6.0), 4.0, 4.0).unwrap()).unwrap();
    let (_folder, path) = grid_file(&halves);
    let mut along = slice(&terrain, MapPoint::new(0.0, 4.0), MapPoint::new(8.0, 4.0)).unwrap();
    let friction = read_friction_raster(&path, None).unwrap();
    assert_eq!(friction.at(MapPoint::new(3.0, 4.0)).unwrap().coefficient(), 0.4);
    assert!(friction.at(MapPoint::new(8.5, 4.0)).is_none(), "beyond the outermost cells");
    friction.lay(&mut along, None).unwrap();
    assert!(along.facets.iter().all(|facet| facet.friction.unwrap().coefficient() == 0.4));
}

#[test]
fn files_without_valid_zones_are_refused_with_fault_and_position() {
    let bounds = MapBounds { min: MapPoint::new(1000.0, 1000.0), max: MapPoint::new(2000.0, 2000.0) };
    let square = "[[1100,1100],[1200,1100],[1200,1200],[1100,1100]]";
    let good = format!(r#"{{"type":"Feature","properties":{{}},"geometry":{{"type":"Polygon","coordinates":[{square}]}}}}"#);
    let second = |feature: &str| format!(r#"{{"type":"FeatureCollection","features":[{good},{feature}]}}"#);
    let polygon = |rings: &str| second(&format!(r#"{{"type":"Feature","geometry":{{"type":"Polygon","coordinates":{rings}}}}}"#));
    let with_crs = |name: &str| good.replacen('{', &format!(r#"{{"crs":{{"type":"name","properties":{{"name":"{name}"}}}},"#), 1);
    let cases = [
        ("{nonsense".to_owned(), "not JSON"),
        ("[1,2]".to_owned(), "no `type`"),
        (r#"{"type":"FeatureCollection"}"#.to_owned(), "`features`"),
        (r#"{"type":"FeatureCollection","features":[]}"#.to_owned(), "found no polygon"),
        (second(r#"{"type":"Feature","geometry":null}"#), "feature 2 has no geometry"),
        (second(r#"{"type":"Feature","geometry":{"type":"LineString","coordinates":[[0,0],[1,1]]}}"#), "feature 2 is a LineString"),
        (second("7"), "feature 2 has no `type`"),
        (polygon("[[[0,0],[1,0],[1,1]]]"), "feature 2, ring 1 is not closed"),
        (polygon("[[[0,0],[1,1],[2,2],[0,0]]]"), "feature 2, ring 1 encloses no area"),
        (polygon("[]"), "feature 2 is an empty polygon"),
        (polygon("[[]]"), "feature 2, ring 1 is not closed"),
        (polygon(r#"[[["a",0]]]"#), "feature 2 is not a GeoJSON geometry"),
        (good.replace("1100", "11").replace("1200", "12"), "look like degrees"),
        (good.replace("1100", "11000").replace("1200", "12000"), "off the terrain: they have x from 11000 to 12000"),
        (with_crs("urn:ogc:def:crs:OGC:1.3:CRS84"), "in degrees"),
        (with_crs("urn:ogc:def:crs:EPSG::4326"), "in degrees"),
    ];
    for (content, expected) in cases {
        let (_folder, path) = file(&content);
        let message = read_keep_out(&path, None, bounds).unwrap_err().to_string();
        assert!(message.contains(expected) && message.contains("zones.geojson"), "{content}\n{message}");
    }
    let (_folder, path) = file(&with_crs("urn:ogc:def:crs:EPSG::32612"));
    assert!(read_keep_out(&path, None, bounds).is_ok());
    let other = crate::terrain::CoordinateSystem {
        key_directory: vec![1, 1, 0, 1, 3072, 0, 1, 32613],
        ..crate::terrain::CoordinateSystem::default()
    };
    let message = read_keep_out(&path, Some(&other), bounds).unwrap_err().to_string();
    assert!(message.contains("EPSG:32612") && message.contains("EPSG:32613"), "{message}");
    let (_folder, path) = file("x,y\n1,2\n");
    assert!(read_keep_out(&path, None, bounds).unwrap_err().to_string().contains("not a known elevation format"));
    assert!(
        read_keep_out(std::path::Path::new("absent.geojson"), None, bounds).unwrap_err().to_string().contains("absent.geojson")
    );
}

#[test]
fn rasters_that_end_early_or_lie_on_another_map_are_refused() {
    let terrain = plain(8);
    let small = Dem::new(2, 2, vec![0.0; 4], GeoReference::local(MapPoint::new(0.0, 8.0), 1.0, 1.0).unwrap()).unwrap();
    let (_folder, path) = grid_file(&small);
    let kept = read_keep_out(&path, None, terrain.bounds()).unwrap();
    let mut profile = slice(&terrain, MapPoint::new(0.0, 8.0), MapPoint::new(8.0, 8.0)).unwrap();
    let message = kept.mark(&mut profile).unwrap_err().to_string();
    assert!(message.contains("ends before the slice does") && message.contains("(4.750 m, 8.000 m)"), "{message}");
    let mut map = terrain.georeference().clone();
    map.coordinate_system.key_directory = vec![1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 32613];
    let elsewhere = Dem::new(9, 9, vec![0.5; 81], map.clone()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("raster.tif");
    crate::terrain::write_geotiff(&elsewhere, std::fs::File::create(&path).unwrap()).unwrap();
    let mut own = map.coordinate_system.clone();
    assert!(read_keep_out(&path, Some(&own), terrain.bounds()).is_ok());
    own.key_directory[11] = 32612;
    let message = read_keep_out(&path, Some(&own), terrain.bounds()).unwrap_err().to_string();
    assert!(message.contains("key 3072 is 32613 in it and 32612"), "{message}");
    assert!(read_friction_raster(&path, Some(&own)).unwrap_err().to_string().contains("another map"));
    let negative = Dem::new(2, 2, vec![0.5, -0.1, 0.5, 0.5], terrain.georeference().clone()).unwrap();
    let (_folder, path) = grid_file(&negative);
    assert!(read_friction_raster(&path, None).unwrap_err().to_string().contains("row 0, column 1"));
}

/// Each row: the `crs` member, the terrain's map, and what follows: read, a word of the refusal, or a warning. The codes are those of
/// `projinfo`: 30130 and 30135 are the polar maps of the Moon, nn00, nn01 and nn02 degrees, 499nn Mars.
#[test]
fn the_reference_system_of_zones_is_compared_with_the_terrains() {
    enum Expected {
        Read,
        Refused(&'static str),
        Warned(&'static str),
    }
    use crate::terrain::{CoordinateSystem, MapProjection};
    use Expected::{Read, Refused, Warned};
    let moon = "IAU_2015:30135";
    let named = |name: &str| format!(r#"{{"type":"name","properties":{{"name":"{name}"}}}}"#);
    let local = "";
    let unsupported = "robinson";
    let system = |text: &str| match text {
        "" => CoordinateSystem::default(),
        "robinson" => {
            CoordinateSystem { key_directory: vec![1, 1, 0, 2, 1024, 0, 1, 1, 3075, 0, 1, 23], ..CoordinateSystem::default() }
        }
        "EPSG:27700" => {
            CoordinateSystem { key_directory: vec![1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 27700], ..CoordinateSystem::default() }
        }
        text => text.parse::<MapProjection>().unwrap().coordinate_system(),
    };
    for (crs, terrain, expected) in [
        (named("urn:ogc:def:crs:IAU:2015:30135"), moon, Read),
        (named("IAU_2015:30135"), moon, Read),
        (named("iau_2015:30135"), moon, Read),
        (named("http://www.opengis.net/def/crs/IAU/2015/30135"), moon, Read),
        (named("+proj=stere +lat_0=-90 +lon_0=0 +R=1737400"), moon, Read),
        (named("urn:ogc:def:crs:IAU:2015:30130"), moon, Refused("IAU_2015:30130")),
        (named("urn:ogc:def:crs:IAU:2015:30110"), moon, Refused("IAU_2015:30135")),
        (named("urn:ogc:def:crs:IAU:2015:30100"), moon, Refused("in degrees")),
        (named("urn:ogc:def:crs:IAU:2015:30101"), moon, Refused("in degrees")),
        (named("urn:ogc:def:crs:IAU:2015:30102"), local, Refused("in degrees")),
        (named("urn:ogc:def:crs:IAU:2015:49900"), moon, Refused("another body")),
        (named("urn:ogc:def:crs:IAU:2015:49935"), moon, Refused("another body")),
        (named("EPSG:3857"), moon, Refused("another body")),
        (named("urn:ogc:def:crs:EPSG::3857"), "EPSG:32633", Refused("ogr2ogr -t_srs '+proj=tmerc")),
        (named("urn:ogc:def:crs:OGC:1.3:CRS84"), moon, Refused("-s_srs '+proj=longlat +R=1737400")),
        (named("urn:ogc:def:crs:OGC:1.3:CRS84"), "EPSG:32633", Refused("ogr2ogr -t_srs")),
        (named("OGC:CRS84"), local, Refused("in degrees")),
        (named("EPSG:4326"), local, Refused("in degrees")),
        (named("EPSG:4979"), moon, Refused("in degrees")),
        (named("http://www.opengis.net/gml/srs/epsg.xml#4326"), local, Refused("in degrees")),
        (named("EPSG:32633"), "EPSG:32633", Read),
        (named("EPSG:25833"), "EPSG:32633", Read),
        (named("EPSG:32633"), "+proj=utm +zone=33 +ellps=GRS80", Read),
        (named("EPSG:32634"), "+proj=utm +zone=33 +ellps=GRS80", Refused("EPSG:32634")),
        // A projected code among the geographic ones.
        (named("EPSG:4087"), moon, Refused("not known here")),
        (named("EPSG:27700"), "EPSG:27700", Read),
        (named("EPSG:27700"), "EPSG:32633", Refused("not known here")),
        (named("EPSG:32633"), "EPSG:27700", Refused("EPSG:27700")),
        (named("my own grid"), moon, Refused("my own grid")),
        (named("my own grid"), local, Warned("not checked")),
        (named("EPSG:32633"), local, Warned("not checked")),
        (named("IAU_2015:30135"), unsupported, Warned("not checked")),
        (r#"{"type":"EPSG","properties":{"code":4326}}"#.to_owned(), local, Refused("in degrees")),
        (r#"{"type":"EPSG","properties":{"code":32633}}"#.to_owned(), "EPSG:32633", Read),
        (
            r#"{"type":"link","properties":{"href":"http://spatialreference.org/ref/epsg/4326/"}}"#.to_owned(),
            local,
            Refused("in degrees"),
        ),
        (r#"{"type":"name"}"#.to_owned(), moon, Refused("neither a name nor a code")),
        ("null".to_owned(), moon, Read),
    ] {
        let polygon = r#""geometry":{"type":"Polygon","coordinates":[[[1,1],[2,1],[2,2],[1,1]]]}"#;
        // On the collection and on its one feature.
        for text in [
            format!(r#"{{"type":"FeatureCollection","crs":{crs},"features":[{{"type":"Feature",{polygon}}}]}}"#),
            format!(r#"{{"type":"FeatureCollection","features":[{{"type":"Feature","crs":{crs},{polygon}}}]}}"#),
        ] {
            let (_folder, path) = file(&text);
            let bounds = MapBounds { min: MapPoint::new(0.0, 0.0), max: MapPoint::new(9.0, 9.0) };
            let found = read_keep_out(&path, Some(&system(terrain)), bounds);
            match (found, &expected) {
                (Ok(zones), Read) => assert_eq!(zones.not_compared(), None, "{crs} {terrain}"),
                (Ok(zones), Warned(word)) => {
                    assert!(zones.not_compared().is_some_and(|text| text.contains(word)), "{crs} {terrain}");
                }
                (Err(error), Refused(word)) => assert!(error.to_string().contains(word), "{crs} {terrain}: {error}"),
                (Err(error), _) => panic!("{crs} {terrain}: {error}"),
                (Ok(_), Refused(_)) => panic!("{crs} {terrain}: read"),
            }
        }
    }
}

/// Beside a small local map the numbers of zones in metres are small as well.
#[test]
fn zones_beside_a_small_local_map_do_not_look_like_degrees() {
    let small = MapBounds { min: MapPoint::new(0.0, 0.0), max: MapPoint::new(60.0, 60.0) };
    let large = MapBounds { min: MapPoint::new(1000.0, 1000.0), max: MapPoint::new(2000.0, 2000.0) };
    let (_folder, path) = file(r#"{"type":"Polygon","coordinates":[[[70,70],[80,70],[80,80],[70,70]]]}"#);
    for (bounds, degrees) in [(small, false), (large, true)] {
        let message = read_keep_out(&path, None, bounds).unwrap_err().to_string();
        assert!(message.contains("off the terrain") && message.contains("look like degrees") == degrees, "{message}");
    }
}
