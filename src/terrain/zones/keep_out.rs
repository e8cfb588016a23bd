//! Keep-out zones: polygons or a mask where take-off and landing are forbidden; and keep-in zones, outside which they are.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{
    cells::{borders_of, cell_bounds, cells_at, cells_on, has_cell, is_on},
    geojson::polygons,
    line::{Line, Stretch, covered},
    polygons::Polygon,
    same_map::{self, SameMap},
    vector::{VectorFormat, refusal},
};
use crate::{
    quantity::{MapPoint, format_number},
    terrain::{CoordinateSystem, Dem, DemOptions, MapBounds, NoDataRule, Profile, TerrainError, without_mark},
};

/// On which side of zones take-off and landing are forbidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Forbidden {
    Inside,
    Outside,
}

impl Forbidden {
    /// The name of the file's role in messages.
    const fn what(self) -> &'static str {
        match self {
            Self::Inside => "keep-out zones",
            Self::Outside => "keep-in zones",
        }
    }

    /// What a mask holds where nothing is known: that nothing is allowed there.
    const fn unknown(self) -> f64 {
        match self {
            Self::Inside => 1.0,
            Self::Outside => 0.0,
        }
    }

    /// Whether contacts are forbidden where all pixels of a mask are zones, or only some.
    fn forbids(self, mut is_zone: impl Iterator<Item = bool>) -> bool {
        match self {
            Self::Inside => is_zone.any(|zone| zone),
            Self::Outside => {
                let mut some = false;
                let all = is_zone.all(|zone| {
                    some = true;
                    zone
                });
                !(some && all)
            }
        }
    }
}

/// The largest GeoJSON read: zones drawn by hand take kilobytes, vectorised rasters megabytes.
const LARGEST_BYTES: u64 = 1 << 30;

/// The ground where take-off and landing are forbidden: inside zones, or outside them. Flying over is allowed.
#[derive(Clone, Debug)]
pub struct KeepOut {
    path: PathBuf,
    forbidden: Forbidden,
    zones: Zones,
    /// Why its map could not be compared with the terrain's.
    not_compared: Option<String>,
}

#[derive(Clone, Debug)]
enum Zones {
    Polygons(Vec<Polygon>),
    Mask(Box<Dem>),
}

/// Reads keep-out zones for a terrain: a `GeoJSON` file of polygons in the terrain's map coordinates, or a raster (`GeoTIFF`,
/// ESRI ASCII grid) on the same map whose non-zero pixels are kept out. The format is recognised by content.
///
/// `coordinates` is the terrain's own description of its map, if it has one; `bounds` is the area of the terrain.
///
/// Each pixel of a raster applies to its cell, half a spacing in every direction from its centre. Missing pixels are kept out, unless
/// their no-data value is 0: what is not known is not allowed.
///
/// # Errors
/// [`TerrainError::Overlay`]: the file cannot be read, holds no polygons, holds an invalid one (named by feature and ring),
/// has coordinates in degrees or on another map, or lies wholly off the terrain.
pub fn read_keep_out(path: &Path, coordinates: Option<&CoordinateSystem>, bounds: MapBounds) -> Result<KeepOut, TerrainError> {
    read(Forbidden::Inside, path, coordinates, bounds)
}

/// Reads keep-in zones for a terrain, of the same formats: what lies outside all of them is kept out.
///
/// The border of a polygon belongs to it. A pixel of a mask beside one that is zero, or missing, ends at its border, which is kept out, as
/// is everything beyond the mask.
///
/// # Errors
/// As [`read_keep_out`].
pub fn read_keep_in(path: &Path, coordinates: Option<&CoordinateSystem>, bounds: MapBounds) -> Result<KeepOut, TerrainError> {
    read(Forbidden::Outside, path, coordinates, bounds)
}

fn read(
    forbidden: Forbidden,
    path: &Path,
    coordinates: Option<&CoordinateSystem>,
    bounds: MapBounds,
) -> Result<KeepOut, TerrainError> {
    let failed = |problem: String| TerrainError::Overlay { what: forbidden.what(), path: path.to_path_buf(), problem };
    let (zones, same) = if looks_like_json(path).map_err(|error| failed(unread(&error)))? {
        let size = fs::metadata(path).map_err(|error| failed(unread(&error)))?.len();
        if size > LARGEST_BYTES {
            return Err(failed(format!("the file has {size} bytes, expected at most {LARGEST_BYTES}: simplify the polygons")));
        }
        let bytes = fs::read(path).map_err(|error| failed(unread(&error)))?;
        let (polygons, same) = polygons(&bytes, coordinates, bounds).map_err(failed)?;
        (Zones::Polygons(polygons), same)
    } else if let Some(format) = vector_format(path).map_err(|error| failed(unread(&error)))? {
        return Err(failed(refusal(format, path, coordinates)));
    } else {
        let mask = mask_of(path, forbidden).map_err(|error| failed(of_raster(error)))?;
        let same = same_map::of_raster(&mask.georeference().coordinate_system, coordinates).map_err(|difference| {
            failed(format!("the mask lies on another map ({difference}); {}", same_map::mend_raster(coordinates)))
        })?;
        (Zones::Mask(Box::new(mask)), same)
    };
    let not_compared = match same {
        SameMap::Agreed => None,
        SameMap::NotCompared(reason) => Some(format!("{} '{}': {reason}", forbidden.what(), name_of(path))),
    };
    Ok(KeepOut { path: path.to_path_buf(), forbidden, zones, not_compared })
}

/// A mask whose zones are all its pixels but zeros: what is missing may not be landed on either. A no-data value of 0, as burning
/// polygons into an empty raster leaves, is no zone.
fn mask_of(path: &Path, forbidden: Forbidden) -> Result<Dem, TerrainError> {
    let raster = DemOptions::default().no_data(NoDataRule::Nothing).read(path)?;
    let kept = raster.elevations().map(|value| value.unwrap_or(forbidden.unknown())).collect();
    Dem::new(raster.rows(), raster.cols(), kept, raster.georeference().clone())
}

impl KeepOut {
    /// Its content, whatever file it comes from.
    pub(crate) fn content(&self) -> impl std::fmt::Debug + '_ {
        (self.forbidden, &self.zones)
    }

    /// Whether contacts at a position are forbidden: in a keep-out zone, including its border, or outside all keep-in zones. Beyond its
    /// pixels a mask has no zones.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::MapPoint, terrain::{MapBounds, read_keep_out}};
    /// let folder = tempfile::tempdir()?;
    /// let file = folder.path().join("zones.geojson");
    /// std::fs::write(&file, r#"{"type": "Polygon", "coordinates": [[[3, 0], [4, 0], [4, 9], [3, 9], [3, 0]]]}"#)?;
    /// let bounds = MapBounds { min: MapPoint::new(0.0, 0.0), max: MapPoint::new(20.0, 10.0) };
    /// let zones = read_keep_out(&file, None, bounds)?;
    /// let kept = [2.5, 3.0, 3.5, 4.0, 4.5].map(|x| zones.keeps_out(MapPoint::new(x, 4.0)));
    /// assert_eq!(kept, [false, true, true, true, false]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn keeps_out(&self, place: MapPoint) -> bool {
        match &self.zones {
            Zones::Polygons(polygons) => {
                self.forbidden.forbids(std::iter::once(polygons.iter().any(|polygon| polygon.contains(place))))
            }
            Zones::Mask(mask) => self.forbidden.forbids(cells_at(place, mask).map(is_zone)),
        }
    }

    /// Marks the segments of a profile where contacts are forbidden, and adds vertices where its line crosses the border of a zone.
    ///
    /// Zones are closed: a segment along a border, including the border of a hole, lies inside. Each segment is then wholly
    /// inside or outside; at a vertex on a border, the adjacent segments rule as at every vertex. A zone that overlaps the
    /// line by less than 1e-12 of the map coordinates (0.1 micrometres at 100 km) touches it at a point, which has no effect.
    ///
    /// Returns whether contacts are forbidden on any part of the profile.
    ///
    /// # Errors
    /// [`TerrainError::Overlay`] if a mask does not cover the whole profile.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::MapPoint, terrain::{Dem, GeoReference, read_keep_out, slice}};
    /// let plain = Dem::new(2, 3, vec![0.0; 6], GeoReference::local(MapPoint::new(0.0, 10.0), 10.0, 10.0)?)?;
    /// let folder = tempfile::tempdir()?;
    /// let file = folder.path().join("zones.geojson");
    /// std::fs::write(&file, r#"{"type": "Polygon", "coordinates": [[[3, 0], [4, 0], [4, 9], [3, 9], [3, 0]]]}"#)?;
    /// let zones = read_keep_out(&file, None, plain.bounds())?;
    /// let mut profile = slice(&plain, MapPoint::new(1.0, 1.0), MapPoint::new(6.0, 1.0))?;
    /// zones.mark(&mut profile)?;
    /// let kept: Vec<(f64, bool)> = profile.points.iter().zip(&profile.facets).map(|(p, f)| (p.x_m, f.keep_out)).collect();
    /// assert_eq!(kept, [(0.0, false), (2.0, true), (3.0, false)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn mark(&self, profile: &mut Profile) -> Result<bool, TerrainError> {
        let Some(line) = Line::of(profile) else { return Ok(false) };
        let stretches: Vec<Stretch<bool>> = match &self.zones {
            Zones::Polygons(polygons) => {
                let inside = covered(&line, polygons.iter().flat_map(|polygon| polygon.parts_on(&line)).collect());
                let forbids = |part: Stretch<bool>| Stretch { value: self.forbidden.forbids(std::iter::once(part.value)), ..part };
                inside.into_iter().map(forbids).collect()
            }
            Zones::Mask(mask) => covered(&line, self.masked(mask, &line)?),
        };
        line.lay(profile, &stretches, |profile, segment, inside| profile.facets[segment].keep_out |= inside);
        Ok(stretches.iter().any(|stretch| stretch.value))
    }

    /// The warning if its map could not be compared with the terrain's.
    pub(crate) fn not_compared(&self) -> Option<&str> {
        self.not_compared.as_deref()
    }

    /// The warning if no zone meets `on`, such as "the transect".
    pub(crate) fn without_effect(&self, on: &str) -> String {
        let effect = match self.forbidden {
            Forbidden::Inside => "none has an effect there",
            Forbidden::Outside => "no contact is allowed there",
        };
        format!("{} '{}': no zone meets {on}, so {effect}", self.forbidden.what(), name_of(&self.path))
    }

    /// The warning if it forbids no contact on `on`, of keep-in zones.
    pub(crate) fn without_bounds(&self, on: &str) -> String {
        format!("{} '{}': they contain all of {on}, so they have no effect there", self.forbidden.what(), name_of(&self.path))
    }

    /// Whether a zone, or the rectangle around its polygon, intersects a rectangle of the map.
    pub(crate) fn meets(&self, bounds: MapBounds) -> bool {
        match &self.zones {
            Zones::Polygons(polygons) => polygons.iter().any(|polygon| polygon.bounds().meets(bounds)),
            Zones::Mask(mask) => has_cell(mask, bounds, &|value| value != 0.0),
        }
    }

    /// Calls `visit` with rectangles that together contain all borders of zones; the edges of polygons are divided into pieces
    /// of at most `longest_m`.
    pub(crate) fn borders(&self, longest_m: f64, visit: &mut dyn FnMut(MapBounds)) {
        match &self.zones {
            Zones::Polygons(polygons) => polygons.iter().for_each(|polygon| polygon.borders(longest_m, visit)),
            Zones::Mask(mask) => borders_of(mask, &|value: Option<f64>| value.is_some_and(|value| value != 0.0), visit),
        }
    }

    /// The outlines of all zones, for drawing: the rings of polygons, each closed, and of a mask the borders between its pixels.
    pub fn outlines(&self) -> Vec<Vec<MapPoint>> {
        match &self.zones {
            Zones::Polygons(polygons) => polygons.iter().flat_map(Polygon::outlines).collect(),
            Zones::Mask(mask) => {
                let mut found = Vec::new();
                borders_of(mask, &is_zone, &mut |border| found.push(vec![border.min, border.max]));
                found
            }
        }
    }

    /// The parts of a line on pixels where contacts are forbidden.
    fn masked(&self, mask: &Dem, line: &Line) -> Result<Vec<(f64, f64)>, TerrainError> {
        let cells = cells_on(line, mask);
        let beyond = cells.iter().find(|cell| cell.value.is_empty());
        if let Some(beyond) = beyond.filter(|_| self.forbidden == Forbidden::Inside) {
            let at = line.map_point(0.5 * (beyond.from_m + beyond.to_m));
            let whole = if is_on(&cells) { "ends before the slice does" } else { "does not cover the slice" };
            let problem = format!(
                "the mask {whole}: nothing at map point ({:.3} m, {:.3} m), expected pixels all the way, and it covers {}; make one for the \
                 whole terrain with: gdalwarp -te XMIN YMIN XMAX YMAX mask.tif whole.tif",
                at.x,
                at.y,
                cell_bounds(mask)
            );
            return Err(TerrainError::Overlay { what: self.forbidden.what(), path: self.path.clone(), problem });
        }
        let kept = |values: &[Option<f64>]| self.forbidden.forbids(values.iter().copied().map(is_zone));
        Ok(cells.iter().filter(|cell| kept(&cell.value)).map(|cell| (cell.from_m, cell.to_m)).collect())
    }
}

/// Whether a pixel of a mask, in which nothing is missing, is a zone.
fn is_zone(pixel: Option<f64>) -> bool {
    pixel.is_some_and(|value| value != 0.0)
}

/// The first bytes of a file.
fn beginning_of(path: &Path) -> std::io::Result<Vec<u8>> {
    use std::io::Read;
    let mut beginning = Vec::new();
    fs::File::open(path)?.take(4096).read_to_end(&mut beginning)?;
    Ok(beginning)
}

/// The format of shapes that a file has, other than `GeoJSON`.
fn vector_format(path: &Path) -> std::io::Result<Option<VectorFormat>> {
    Ok(VectorFormat::of(&beginning_of(path)?, path))
}

/// Whether a file begins like JSON.
fn looks_like_json(path: &Path) -> std::io::Result<bool> {
    let beginning = beginning_of(path)?;
    let text = without_mark(&beginning);
    let first = text.iter().find(|byte| !byte.is_ascii_whitespace());
    Ok(matches!(first, Some(b'{' | b'[')))
}

/// A file's name without folders, for warnings: results contain them and must not depend on the location of the file.
pub(super) fn name_of(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The system's error for a file, with a remedy.
pub(super) fn unread(error: &std::io::Error) -> String {
    format!("cannot be read ({error}): check the path and its permissions")
}

/// The problem of a raster, without the name of the file.
pub(super) fn of_raster(error: TerrainError) -> String {
    match error {
        TerrainError::InFile { problem, .. } => match *problem {
            // The key terrain.no_data is about the elevations.
            TerrainError::Void(void) => format!(
                "the value {}, expected missing data that the file states: mark it with: gdal_translate -a_nodata {} in.tif out.tif",
                void.found(),
                format_number(void.stored)
            ),
            other => other.to_string(),
        },
        other => other.to_string(),
    }
}
