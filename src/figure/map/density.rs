//! Where trials come to rest: the probability of each cell in bands over a hillshade.

use plotters::style::RGBColor;

use super::{
    super::{
        FigureError, Picture,
        bands::{MOST_CLASSES, ramp},
        keys::{self, Swatch},
        palette::{BLACK, TEXT_MM, WHITE},
        picture::{Caption, paragraph},
        sheet::{Pen, Place, Sheet},
        ticks::short,
    },
    check_size,
    data::MapPosts,
    hops::{no_data_symbol, notes},
    names::Bounds,
    panel::{MapPanel, start_symbol},
    raster::{self, Pattern, tone},
};
use crate::{quantity::MapPoint, terrain::Dem};

/// Ground where no trial rests: paler than every band, also in a print in grey.
const GROUND: RGBColor = RGBColor(240, 238, 234);
/// The first band is this far along the colours: those before it are as light as the ground.
const LIGHTEST: f64 = 0.2;
/// The outline of the area, dashed in a white casing.
const AREA_PEN: Pen = Pen { colour: BLACK, width_mm: 0.4 };
const CASING_PEN: Pen = Pen { colour: WHITE, width_mm: 1.0 };
const DASH_MM: [f64; 2] = [2.4, 1.2];
/// Half the size of the goal's outline.
const OPEN_MM: f64 = 2.0;

/// The picture of where trials come to rest.
#[derive(Clone, Debug)]
pub struct DensityFigure<'a> {
    /// The caption.
    pub caption: Caption,
    /// The terrain, whose posts have a cell each.
    pub dem: &'a Dem,
    /// The share of all trials that rest in the cell of each post, row by row from the north-west.
    pub shares: &'a [f64],
    /// What the shares are of, such as `share of the trials that end in a cell`.
    pub value_name: String,
    /// The start, and the planned landings if there is a plan, in order.
    pub path: Vec<MapPoint>,
    /// The outlines of the area whose share is stated; empty without one.
    pub area: Vec<Vec<MapPoint>>,
}

/// Draws where trials come to rest.
///
/// The probabilities are drawn in at most seven bands, each a round factor wider than the one below it, since they differ by orders of
/// magnitude; the legend counts the cells of each. Cells where no trial rests are bare ground. The map is cut to the cells where some rest, the
/// path and the area, if that leaves out much of it.
///
/// # Errors
/// [`FigureError::RasterSize`] if the shares are not one for every post.
pub fn draw_density(figure: &DensityFigure<'_>) -> Result<Picture, FigureError> {
    let posts = MapPosts { dem: figure.dem, stride: 1, per_post: 1 };
    check_size("map of densities", &posts, figure.shares.len())?;
    let bands = Bands::of(figure.shares.iter().copied());
    let mut tones = bands.tones();
    let ground = tones.len();
    tones.push(GROUND);
    let marks = figure.path.iter().chain(figure.area.iter().flatten()).copied();
    let window = posts.window((0..figure.shares.len()).filter(|at| figure.shares[*at] > 0.0), marks, &[], &[]);
    let pixels = raster::draw(figure.dem, &window, &tones, |row, col| {
        Some((bands.class(figure.shares[posts.index(row, col)]).unwrap_or(ground), Pattern::Plain))
    });
    let mut sheet = Sheet::default();
    let top_mm = figure.caption.draw(&mut sheet);
    let map = MapPanel::new(figure.dem, &window, top_mm);
    let end_mm = map.draw(&mut sheet, pixels);
    for pen in [CASING_PEN, AREA_PEN] {
        for piece in figure.area.iter().flat_map(|outline| map.shown_pieces(outline)) {
            let [dash_mm, gap_mm] = DASH_MM;
            if pen == AREA_PEN { sheet.dashed(&piece, dash_mm, gap_mm, pen) } else { sheet.line(piece, pen) }
        }
    }
    let path: Vec<MapPoint> = figure.path.iter().copied().filter(|at| map.shows(*at)).collect();
    let plan = if path.len() > 1 { vec![path.clone()] } else { Vec::new() };
    for places in &plan {
        thin_path(&mut sheet, &places.iter().map(|at| map.place(*at)).collect::<Vec<_>>());
    }
    let starts: Vec<MapPoint> = path.first().copied().into_iter().collect();
    let goal = figure.path.last().copied().filter(|at| figure.path.len() > 1 && map.shows(*at));
    let mut taken = map.ends(&mut sheet, &starts, &[], &plan);
    if let Some(at) = goal {
        open_goal_symbol(&mut sheet, map.place(at));
        taken.kept.push(Bounds::around(map.place(at), OPEN_MM));
        map.name(&mut sheet, at, "goal", &mut taken);
    }
    let end_mm = paragraph(&mut sheet, &format!("Colours: {}", figure.value_name), TEXT_MM, false, end_mm + 0.5);
    let mut entries = bands.keys(&tones, figure.shares);
    entries.push((Swatch::Fill(GROUND), "no trial".to_owned()));
    if !starts.is_empty() {
        entries.push((Swatch::Symbol(start_symbol), "start".to_owned()));
    }
    if !plan.is_empty() {
        entries.push((Swatch::Symbol(thin_path_symbol), "planned path".to_owned()));
    }
    if goal.is_some() {
        entries.push((Swatch::Symbol(open_goal_symbol), "goal".to_owned()));
    }
    if !figure.area.is_empty() {
        entries.push((Swatch::Symbol(area_symbol), "the area".to_owned()));
    }
    if window.has_gaps(figure.dem) {
        entries.push((Swatch::Symbol(no_data_symbol), "no data".to_owned()));
    }
    let end_mm = keys::draw(&mut sheet, &entries, end_mm + 2.5);
    let height_mm = notes(&mut sheet, &posts, &window, end_mm + 0.8) + 2.0;
    Ok(Picture::page(sheet, height_mm))
}

/// The planned path, thin and without a casing: it would hide the cells beside it, where trials come to rest.
fn thin_path(sheet: &mut Sheet, places: &[Place]) {
    sheet.line(places.to_vec(), Pen { colour: BLACK, width_mm: 0.15 });
    for &at in places {
        sheet.dot(at, 0.4, BLACK);
    }
}

fn thin_path_symbol(sheet: &mut Sheet, (x, y): Place) {
    thin_path(sheet, &[(x - 2.4, y), (x + 2.4, y)]);
}

/// The goal as an outline, which leaves the cells within it to be seen.
fn open_goal_symbol(sheet: &mut Sheet, (x, y): Place) {
    let corners = [(x - OPEN_MM, y), (x, y - OPEN_MM), (x + OPEN_MM, y), (x, y + OPEN_MM), (x - OPEN_MM, y)];
    for pen in [CASING_PEN, AREA_PEN] {
        sheet.line(corners.to_vec(), pen);
    }
}

/// The outline of the area in a legend.
fn area_symbol(sheet: &mut Sheet, (x, y): Place) {
    sheet.dashed(&[(x - 3.0, y), (x + 3.0, y)], 1.6, 0.7, AREA_PEN);
}

impl MapPanel {
    /// The pieces of an outline whose points are shown; an edge that leaves the map is cut at the last of its points that lies on it.
    fn shown_pieces(&self, outline: &[MapPoint]) -> Vec<Vec<Place>> {
        /// An edge is followed in this many steps: fine enough for where it leaves the map.
        const STEPS: u16 = 64;
        let mut pieces: Vec<Vec<Place>> = vec![Vec::new()];
        for pair in outline.windows(2) {
            for step in 0..=STEPS {
                let at = pair[0] + (pair[1] - pair[0]) * (f64::from(step) / f64::from(STEPS));
                match pieces.last_mut() {
                    Some(piece) if self.shows(at) => {
                        let place = self.place(at);
                        if piece.last() != Some(&place) {
                            piece.push(place);
                        }
                    }
                    Some(piece) if !piece.is_empty() => pieces.push(Vec::new()),
                    _ => {}
                }
            }
        }
        pieces.retain(|piece| piece.len() > 1);
        pieces
    }
}

/// Bands of probabilities.
struct Bands {
    /// The greatest share of each band, in ascending order; each is 1, 2 or 5, 1 or 3, or 1 times a power of ten.
    ends: Vec<f64>,
}

impl Bands {
    /// Bands from the least to the greatest of the shares above 0: the finest of three series that has at most seven.
    fn of(shares: impl Iterator<Item = f64>) -> Self {
        let positive = shares.filter(|share| *share > 0.0 && share.is_finite());
        let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(low, high), share| (low.min(share), high.max(share)));
        if low > high {
            return Self { ends: Vec::new() };
        }
        let series: [&[f64]; 3] = [&[1.0, 2.0, 5.0], &[1.0, 3.0], &[1.0]];
        let most = usize::try_from(MOST_CLASSES).unwrap_or(usize::MAX);
        let of_series = series.into_iter().map(|series| ends(series, low, high));
        let mut ends = of_series.reduce(|finer, coarser| if finer.len() <= most { finer } else { coarser }).unwrap_or_default();
        // Over more than seven decades the lowest bands are one.
        if ends.len() > most {
            ends.drain(..ends.len() - most);
        }
        Self { ends }
    }

    /// The band of a share; `None` without any trial.
    fn class(&self, share: f64) -> Option<usize> {
        let above = || self.ends.iter().position(|end| share <= end * (1.0 + 1e-12));
        (share > 0.0 && !self.ends.is_empty()).then(|| above().unwrap_or(self.ends.len() - 1))
    }

    #[expect(clippy::cast_precision_loss, reason = "at most seven bands")]
    fn tones(&self) -> Vec<RGBColor> {
        let last = self.ends.len().max(2) - 1;
        (0..self.ends.len()).map(|band| tone(ramp(LIGHTEST + (1.0 - LIGHTEST) * band as f64 / last as f64))).collect()
    }

    /// The legend, with the number of cells in each band that has any.
    fn keys(&self, tones: &[RGBColor], shares: &[f64]) -> Vec<(Swatch, String)> {
        let mut counts = vec![0_usize; self.ends.len()];
        for band in shares.iter().filter_map(|share| self.class(*share)) {
            counts[band] += 1;
        }
        let percent = |share: f64| short(100.0 * share);
        let entry = |(band, (count, tone)): (usize, (usize, &RGBColor))| {
            let to = percent(self.ends[band]);
            let range = match band.checked_sub(1) {
                Some(below) => format!("over {} to {to} %", percent(self.ends[below])),
                None => format!("up to {to} %"),
            };
            (Swatch::Fill(*tone), format!("{range}: {count} cell{}", if count == 1 { "" } else { "s" }))
        };
        counts.into_iter().zip(tones).enumerate().filter(|(_, (count, _))| *count > 0).map(entry).collect()
    }
}

/// The ends of the bands of a series that hold everything from a least to a greatest share.
fn ends(series: &[f64], low: f64, high: f64) -> Vec<f64> {
    let mut found = Vec::new();
    // Exact powers of ten are quotients.
    #[expect(clippy::cast_possible_truncation, reason = "an exponent of a share")]
    let (first, last) = (libm::floor(libm::log10(low)) as i32 - 1, libm::ceil(libm::log10(high)) as i32);
    for exponent in first..=last {
        let power = |number: f64| {
            let size = libm::pow(10.0, f64::from(exponent.abs()));
            if exponent < 0 { number / size } else { number * size }
        };
        for end in series.iter().map(|number| power(*number)) {
            let is_full = found.last().is_some_and(|last: &f64| *last * (1.0 + 1e-12) >= high);
            if end * (1.0 + 1e-12) >= low && !is_full {
                found.push(end);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        figure::{
            bitmap::Form,
            samples::{check_picture, texts},
        },
        terrain::GeoReference,
    };

    #[test]
    fn bands_are_at_most_seven_with_round_ends_and_hold_every_share() {
        for trials in [3.0, 77.0, 400.0, 10_000.0, 1e6, 1e9] {
            for greatest in [1.0, 7.0, 40.0, 250.0, 9_999.0] {
                let shares: Vec<f64> =
                    [1.0, 2.0, 3.0, 5.0, 30.0, 200.0, greatest].iter().map(|count| f64::min(*count, greatest) / trials).collect();
                let bands = Bands::of(shares.iter().copied());
                assert!((1..=7).contains(&bands.ends.len()), "{:?}", bands.ends);
                assert!(bands.ends.windows(2).all(|pair| pair[1] / pair[0] > 1.4), "{:?}", bands.ends);
                for share in shares {
                    let band = bands.class(share).unwrap();
                    assert!(
                        share <= bands.ends[band] * 1.000_001 && (band == 0 || share > bands.ends[band - 1]),
                        "{share} {:?}",
                        bands.ends
                    );
                }
            }
        }
        assert_eq!(Bands::of([0.0, 0.0].into_iter()).class(0.0), None);
        assert_eq!(Bands::of([0.01].into_iter()).ends, [0.01]);
        assert_eq!(Bands::of([0.0025, 0.02].into_iter()).ends, [0.005, 0.01, 0.02]);
    }

    #[test]
    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    fn every_cell_is_drawn_in_the_band_of_its_share_and_the_legend_counts_them() {
        let map = GeoReference::local(MapPoint::new(0.0, 40.0), 2.0, 2.0).unwrap();
        let dem = Dem::new(20, 30, vec![0.0; 600], map).unwrap();
        // Shares over three decades around a place, none farther away.
        let counts: Vec<u32> = (0..600_usize)
            .map(|i| {
                let away = libm::hypot((i / 30) as f64 - 9.0, (i % 30) as f64 - 12.0);
                if away > 11.0 {
                    0
                } else {
                    (1..=900_u32).take_while(|count| f64::from(*count) <= 900.0 * libm::exp(-away)).fold(1, |sum, _| sum + 1)
                }
            })
            .collect();
        let shares: Vec<f64> = counts.iter().map(|count| f64::from(*count) / 5000.0).collect();
        let figure = DensityFigure {
            caption: Caption::new("Where it rests", "5 000 trials; inside the area: 0.31"),
            dem: &dem,
            shares: &shares,
            value_name: "share of the trials that end in a cell".to_owned(),
            path: vec![MapPoint::new(24.0, 22.0), MapPoint::new(30.0, 22.0)],
            area: vec![
                [(18.0, 12.0), (70.0, 12.0), (70.0, 30.0), (18.0, 30.0), (18.0, 12.0)].map(|(x, y)| MapPoint::new(x, y)).to_vec(),
            ],
        };
        let picture = check_picture("density", || draw_density(&figure).unwrap());
        let bands = Bands::of(shares.iter().copied());
        let image = &picture.sheet.images[0].pixels;
        let Form::Palette(colours) = &image.form else { panic!("a palette") };
        let shades = (colours.len() - 2) / (bands.ends.len() + 1);
        // The whole map is drawn: the area reaches its border.
        let up = image.width / 30;
        assert_eq!((image.width, image.height), (30 * up, 20 * up));
        for (i, share) in shares.iter().enumerate() {
            let index = usize::from(image.bytes[(i / 30 * up + up / 2) * image.width + i % 30 * up + up / 2]);
            assert_eq!((index - 2) / shades, bands.class(*share).unwrap_or(bands.ends.len()), "cell {i} of share {share}");
        }
        let lettering = texts(&picture);
        let counted: usize = lettering
            .lines()
            .filter_map(|line| {
                line.rsplit_once(": ")?
                    .1
                    .strip_suffix(" cells")
                    .or(line.rsplit_once(": ")?.1.strip_suffix(" cell"))?
                    .parse::<usize>()
                    .ok()
            })
            .sum();
        assert_eq!(counted, counts.iter().filter(|count| **count > 0).count(), "{lettering}");
        assert!(!lettering.contains(": 0 cells"), "a band without a cell: {lettering}");
        for words in ["the area", "planned path", "start", "goal", "no trial", "up to 0.03 %", "inside the area: 0.31"] {
            assert!(lettering.contains(words), "{words:?} is missing in {lettering}");
        }
        let none = DensityFigure { shares: &[0.0; 600], path: Vec::new(), area: Vec::new(), ..figure.clone() };
        check_picture("density-none", || draw_density(&none).unwrap());
        assert!(draw_density(&DensityFigure { shares: &[0.0; 3], ..figure.clone() }).is_err());
    }
}
