//! The posts of a DEM for a page: all of a small one; of a large one those about the path, thinned.

use std::ops::Range;

use crate::{
    quantity::MapPoint,
    report::{PageLayer, PagePosts},
    terrain::{Dem, MapBounds, OverlaidDem},
};

/// The most rows and columns of a page: with them, 0.7 MB of base64.
const SIDE_MAX: usize = 512;

/// The step that marks a post without data.
const NO_DATA: u16 = u16::MAX;

/// The highest step of a post with data.
const HIGHEST: f64 = 65_534.0;

/// The posts about these places, and where overlays refuse contact at them.
pub(super) fn page_posts(overlaid: &OverlaidDem, places: &[MapPoint]) -> (PagePosts, Vec<PageLayer>) {
    let dem = overlaid.dem();
    let (rows, cols) = window(dem, places);
    let stride = rows.len().max(cols.len()).div_ceil(SIDE_MAX).max(1);
    let kept: [Vec<usize>; 2] = [rows.clone(), cols.clone()].map(|range| range.step_by(stride).collect());
    let posts = || kept[0].iter().flat_map(|&row| kept[1].iter().map(move |&col| (row, col)));
    let heights = posts().filter_map(|(row, col)| dem.elevation(row, col));
    let (low_m, high_m) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z_m| (low.min(z_m), high.max(z_m)));
    let z_step_m = if high_m > low_m { (high_m - low_m) / HIGHEST } else { 1.0 };
    let step = |z_m: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to the highest step")]
        let step = ((z_m - low_m) / z_step_m).round().clamp(0.0, HIGHEST) as u16;
        step
    };
    let map = dem.georeference();
    let first = map.post(rows.start, cols.start);
    let spaced = map.every(stride);
    let of_page = PagePosts {
        rows: kept[0].len(),
        columns: kept[1].len(),
        of_rows: dem.rows(),
        of_columns: dem.cols(),
        stride,
        west_m: first.x,
        north_m: first.y,
        dx_m: spaced.dx_m(),
        dy_m: spaced.dy_m(),
        z_min_m: if low_m.is_finite() { low_m } else { 0.0 },
        z_step_m,
        steps: posts().map(|(row, col)| dem.elevation(row, col).map_or(NO_DATA, step)).collect(),
    };
    let at: Vec<MapPoint> = posts().map(|(row, col)| map.post(row, col)).collect();
    (of_page, layers(overlaid, &at))
}

/// The rows and columns of a page before they are thinned.
fn window(dem: &Dem, places: &[MapPoint]) -> (Range<usize>, Range<usize>) {
    let whole = (0..dem.rows(), 0..dem.cols());
    if (dem.rows() <= SIDE_MAX && dem.cols() <= SIDE_MAX) || places.is_empty() {
        return whole;
    }
    let map = dem.georeference();
    let side = |of: fn(&MapPoint) -> f64| {
        places.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ((west, east), (south, north)) = (side(|at| at.x), side(|at| at.y));
    // As much ground on every side as half the path is long, so that the surroundings of its hops are seen.
    let beside_m = (0.5 * (east - west).max(north - south)).max(16.0 * map.dx_m().max(map.dy_m()));
    let bounds =
        MapBounds { min: MapPoint::new(west - beside_m, south - beside_m), max: MapPoint::new(east + beside_m, north + beside_m) };
    let corner = map.post(0, 0);
    let index = |distance_m: f64, step_m: f64, count: usize| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the posts of the raster")]
        let index = (distance_m / step_m).round().max(0.0) as usize;
        index.min(count - 1)
    };
    let rows = index(corner.y - bounds.max.y, map.dy_m(), dem.rows())..index(corner.y - bounds.min.y, map.dy_m(), dem.rows()) + 1;
    let cols = index(bounds.min.x - corner.x, map.dx_m(), dem.cols())..index(bounds.max.x - corner.x, map.dx_m(), dem.cols()) + 1;
    if rows.len() < 2 || cols.len() < 2 { whole } else { (rows, cols) }
}

/// Where overlays refuse contact.
fn layers(overlaid: &OverlaidDem, at: &[MapPoint]) -> Vec<PageLayer> {
    let overlays = overlaid.overlays();
    let zones = [("keep-out zones", overlays.keep_out()), ("outside the keep-in zones", overlays.keep_in())];
    let mut layers: Vec<PageLayer> = zones
        .into_iter()
        .filter_map(|(name, zones)| Some((name, zones?)))
        .map(|(name, zones)| PageLayer { name: name.to_owned(), bits: bits(at, |at| zones.keeps_out(at)) })
        .collect();
    layers.extend(
        overlays.layers().iter().map(|layer| PageLayer {
            name: format!("layer {} unmet", layer.rule().name),
            bits: bits(at, |at| !layer.holds_at(at)),
        }),
    );
    layers
}

/// One bit for each place, from the least significant on.
fn bits(at: &[MapPoint], is_marked: impl Fn(MapPoint) -> bool) -> Vec<u8> {
    at.chunks(8)
        .map(|places| places.iter().enumerate().fold(0, |byte, (bit, &at)| byte | (u8::from(is_marked(at)) << bit)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::{GeoReference, Overlays};

    fn as_f64(count: usize) -> f64 {
        f64::from(u32::try_from(count).unwrap())
    }

    fn overlaid(rows: usize, cols: usize, z_m: impl Fn(usize, usize) -> f64) -> OverlaidDem {
        let heights = (0..rows * cols).map(|index| z_m(index / cols, index % cols)).collect();
        let map = GeoReference::local(MapPoint::new(100.0, 900.0), 2.0, 3.0).unwrap();
        OverlaidDem::new(Dem::new(rows, cols, heights, map).unwrap(), Overlays::default())
    }

    #[test]
    fn a_small_raster_is_there_as_a_whole_to_half_a_step() {
        let z_m = |row: usize, col: usize| if (row, col) == (1, 2) { f64::NAN } else { as_f64(row * 7 + col * 3) / 10.0 };
        let ground = overlaid(4, 5, z_m);
        let (posts, layers) = page_posts(&ground, &[]);
        assert_eq!((posts.rows, posts.columns, posts.stride, layers.len()), (4, 5, 1, 0));
        assert_eq!((posts.west_m, posts.north_m, posts.dx_m, posts.dy_m), (100.0, 900.0, 2.0, 3.0));
        for (index, step) in posts.steps.iter().enumerate() {
            let expected = z_m(index / 5, index % 5);
            match *step {
                NO_DATA => assert!(expected.is_nan()),
                step => assert!((posts.z_min_m + f64::from(step) * posts.z_step_m - expected).abs() <= 0.51 * posts.z_step_m),
            }
        }
    }

    #[test]
    fn a_large_raster_is_cut_about_the_path_and_thinned_to_the_greatest_side() {
        let ground = overlaid(1500, 1300, |row, col| as_f64(row + col));
        let (whole, _) = page_posts(&ground, &[]);
        assert_eq!((whole.stride, whole.rows, whole.columns), (3, 500, 434));
        let map = ground.dem().georeference();
        let near = [map.post(700, 600), map.post(720, 660)];
        let (cut, _) = page_posts(&ground, &near);
        assert_eq!(cut.stride, 1);
        assert!(cut.rows < 200 && cut.columns < 200 && (cut.of_rows, cut.of_columns) == (1500, 1300));
        // The first post of the page is the one of the raster that stands there.
        let (row, col) = ((900.0 - cut.north_m) / 3.0, (cut.west_m - 100.0) / 2.0);
        assert!((cut.z_min_m + f64::from(cut.steps[0]) * cut.z_step_m - (row + col)).abs() <= 0.51 * cut.z_step_m);
        let (east_m, south_m) = (cut.west_m + as_f64(cut.columns - 1) * cut.dx_m, cut.north_m - as_f64(cut.rows - 1) * cut.dy_m);
        assert!(near.iter().all(|at| (cut.west_m..=east_m).contains(&at.x) && (south_m..=cut.north_m).contains(&at.y)));
    }

    #[test]
    fn marks_are_bits_from_the_least_significant_on() {
        let at: Vec<MapPoint> = (0..11).map(|x| MapPoint::new(f64::from(x), 0.0)).collect();
        assert_eq!(bits(&at, |at| at.x == 0.0 || at.x == 3.0 || at.x == 9.0), [0b1001, 0b10]);
    }
}
