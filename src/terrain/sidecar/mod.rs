//! Files beside a raster that change its meaning, as GDAL and `ArcGIS` write them.
//!
//! | file | what it states | what is done |
//! |---|---|---|
//! | `dem.tif.aux.xml` | no-data value, scale, offset, unit, reference system, transform | read |
//! | `dem.tif.msk` | which posts are valid | read |
//! | `dem.prj` | reference system | read, well-known text |
//! | `dem.tfw`, `dem.tifw`, `dem.wld` | transform | read |
//! | `dem.aux` of ERDAS, `dem.tab`, `dem.rpc` and the like | the same in other formats | refused by name |
//!
//! What a sidecar file and the raster both state must agree, since programs differ in which of the two they trust.

mod aux_xml;
mod mask;
mod prj;
mod world_file;

use std::path::{Path, PathBuf};

use self::mask::MaskFile;
use super::stored::Scaling;
use super::{GeoReference, MapBounds, MapProjection, NoData, NoDataRule, NoProjection, PostLattice, TerrainError, Window};
use crate::quantity::MapPoint;

/// Sidecar files are texts of some kilobytes; masks are read in parts.
const LARGEST_TEXT: u64 = 1 << 26;

/// What the files beside a raster state.
#[derive(Debug, Default)]
pub(super) struct Sidecars {
    warnings: Vec<String>,
    no_data: Option<From<NoData>>,
    scaling: Option<From<Scaling>>,
    projection: Option<From<MapProjection>>,
    /// Reference systems that cannot be used.
    unclear: Vec<From<Unclear>>,
    transforms: Vec<From<Transform>>,
    mask: Option<From<MaskFile>>,
}

/// Why a reference system cannot be used.
#[derive(Clone, Debug)]
enum Unclear {
    /// A projection that is not supported, which a raster of an unsupported projection may state as well.
    Unsupported(String),
    /// A text that is wrong, or states another map, another unit, depths.
    Wrong(String),
}

impl Unclear {
    fn reason(&self) -> &str {
        let (Self::Unsupported(reason) | Self::Wrong(reason)) = self;
        reason
    }
}

/// A statement and the file it comes from.
#[derive(Clone, Debug)]
struct From<T> {
    path: PathBuf,
    value: T,
}

/// Map coordinates of the centre of column i, row j of the file: x = a i + b j + c, y = d i + e j + f.
pub(super) type Transform = [f64; 6];

/// The further files, by extension, that some program reads as the place or the meaning of a raster, and that are not read here.
const NOT_READ: [(&str, &str); 6] = [
    ("tab", "a MapInfo table"),
    ("rpc", "rational polynomial coefficients"),
    ("rpb", "rational polynomial coefficients"),
    ("aux", "an ERDAS file"),
    ("points", "ground control points"),
    ("gcp", "ground control points"),
];

/// The files beside a raster that are read with it.
///
/// # Examples
/// ```
/// let folder = tempfile::tempdir().unwrap();
/// let [dem, mask] = ["dem.tif", "dem.tif.msk"].map(|name| folder.path().join(name));
/// assert!(chta::terrain::sidecar_files(&dem).is_empty());
/// std::fs::write(&mask, "").unwrap();
/// assert_eq!(chta::terrain::sidecar_files(&dem), [mask]);
/// ```
pub fn sidecar_files(path: &Path) -> Vec<PathBuf> {
    let both = [with_suffix(path, "aux.xml"), with_suffix(path, "msk"), with_extension(path, "prj")];
    both.into_iter().flatten().chain(world_file::beside(path)).collect()
}

impl Sidecars {
    /// Reads what stands beside a file; nothing for a file of another kind than a raster, such as a pipe.
    ///
    /// # Errors
    /// [`TerrainError::Sidecar`] for a file that cannot be read, is not understood, or contradicts another one.
    pub(super) fn beside(path: &Path) -> Result<Self, TerrainError> {
        let mut found = Self::default();
        if let Some(file) = with_suffix(path, "aux.xml") {
            let stated = aux_xml::read(&file)?;
            found.no_data = stated.no_data.map(|value| From { path: file.clone(), value });
            found.scaling = stated.scaling.map(|value| From { path: file.clone(), value });
            found.transforms.extend(stated.transform.map(|value| From { path: file.clone(), value }));
            match stated.projection {
                Some(Ok(projection)) => found.projection = Some(From { path: file.clone(), value: projection }),
                Some(Err(unclear)) => found.unclear.push(From { path: file.clone(), value: unclear }),
                None => {}
            }
        }
        if let Some(file) = with_suffix(path, "msk") {
            found.mask = Some(From { path: file.clone(), value: MaskFile::open(&file)? });
        }
        if let Some(file) = with_extension(path, "prj") {
            match prj::read(&file)? {
                Some(Ok(projection)) if found.projection.is_none() => {
                    found.projection = Some(From { path: file.clone(), value: projection });
                }
                // Two sidecar files: the second is compared once the place of the raster is known.
                Some(Ok(projection)) => found.compare_later(&file, &projection),
                Some(Err(unclear)) => found.unclear.push(From { path: file.clone(), value: unclear }),
                None => {}
            }
        }
        for file in world_file::beside(path) {
            found.transforms.push(From { path: file.clone(), value: world_file::read(&file)? });
        }
        Self::refuse_others(path)?;
        Ok(found)
    }

    /// Refuses the formats that state a place or a meaning and are not read.
    fn refuse_others(path: &Path) -> Result<(), TerrainError> {
        for (extension, what) in NOT_READ {
            let Some(file) = with_extension(path, extension).or_else(|| with_suffix(path, extension)) else { continue };
            if extension == "aux" && !prj::begins_with(&file, b"EHFA_HEADER_TAG") {
                continue;
            }
            return Err(refused(
                &file,
                format!(
                    "{what}, which can change the place or the meaning of the raster and is not read, expected a raster that states \
                     both itself; write one with: gdal_translate {} out.tif, or move this file away if it has no effect",
                    name(path)
                ),
            ));
        }
        Ok(())
    }

    fn compare_later(&mut self, file: &Path, projection: &MapProjection) {
        let agrees = self.projection.as_ref().is_some_and(|known| known.value.definition() == projection.definition());
        if !agrees {
            let reason = format!("it states another reference system ({}) than the other sidecar file", projection.name());
            self.unclear.push(From { path: file.to_path_buf(), value: Unclear::Wrong(reason) });
        }
    }

    /// What the analyst should know of them.
    pub(super) fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The no-data value in force, where the raster itself states `own`.
    ///
    /// # Errors
    /// [`TerrainError::Sidecar`] if both state different values and the user none.
    pub(super) fn no_data(&self, rule: NoDataRule, own: Option<NoData>) -> Result<Option<NoData>, TerrainError> {
        let stated = match (&self.no_data, own) {
            (Some(beside), Some(own)) if rule == NoDataRule::AsStated && beside.value != own => {
                return Err(refused(
                    &beside.path,
                    format!(
                        "the no-data value {}, where the raster itself states {own}, expected the same; state the right one with \
                         terrain.no_data",
                        beside.value
                    ),
                ));
            }
            (Some(beside), _) => Some(beside.value),
            (None, own) => own,
        };
        Ok(rule.in_force(stated))
    }

    /// The scaling in force, where the raster itself states `own`.
    ///
    /// # Errors
    /// [`TerrainError::Sidecar`] if both state different ones.
    pub(super) fn scaling(&self, own: Option<Scaling>) -> Result<Scaling, TerrainError> {
        match (&self.scaling, own) {
            (Some(beside), Some(own)) if !beside.value.is_near(own) => Err(refused(
                &beside.path,
                format!(
                    "elevations of {} times the stored number plus {} m, where the raster itself states {} and {} m, expected the same; \
                     write the elevations out with: gdal_translate -unscale in.tif out.tif, once one of the two is removed",
                    beside.value.scale, beside.value.offset_m, own.scale, own.offset_m
                ),
            )),
            (Some(beside), _) => Ok(beside.value),
            (None, own) => Ok(own.unwrap_or(Scaling::NONE)),
        }
    }

    /// The transform of a raster that states none itself.
    pub(super) fn transform(&self) -> Option<Transform> {
        self.transforms.first().map(|transform| transform.value)
    }

    /// Whether a reference system is stated.
    pub(super) fn states_map(&self) -> bool {
        self.projection.is_some()
    }

    /// The place of a raster once the sidecar files are taken into account, and whether they state a projected map in metres.
    ///
    /// # Errors
    /// [`TerrainError::Sidecar`] if a file states another place or another map than the raster.
    pub(super) fn place(
        &self,
        georeference: GeoReference,
        (rows, cols): (usize, usize),
        south_up: bool,
    ) -> Result<(GeoReference, bool), TerrainError> {
        let bounds = georeference.bounds(rows, cols);
        for transform in &self.transforms {
            let other = corners(transform.value, rows, cols, south_up);
            let room = 0.01 * georeference.dx_m().min(georeference.dy_m());
            if (other.min - bounds.min).amax() > room || (other.max - bounds.max).amax() > room {
                return Err(refused(
                    &transform.path,
                    format!(
                        "posts at {other}, where the raster itself states {bounds}, expected the same; remove the wrong statement (this \
                         file, or the raster's with: gdal_edit.py -unsetgt)"
                    ),
                ));
            }
        }
        if let Some(wrong) = self.unclear.iter().find(|unclear| matches!(unclear.value, Unclear::Wrong(_))) {
            return Err(refused(&wrong.path, wrong.value.reason().to_owned()));
        }
        let beside = self.projection.as_ref();
        let differ = |path: &Path, other: &str, own: &str| {
            Err(refused(
                path,
                format!(
                    "the reference system {other}, where the raster itself states {own}, expected the same; remove this file, or write the \
                     right one into the raster with: gdal_translate -a_srs SYSTEM in.tif out.tif"
                ),
            ))
        };
        match (georeference.projection(), beside, self.unclear.first()) {
            (Ok(own), Some(beside), _) if !same_map(&own, &beside.value, bounds) => {
                differ(&beside.path, beside.value.name(), own.name())
            }
            (Ok(own), _, Some(unclear)) => differ(&unclear.path, "of a projection that is not supported", own.name()),
            (Ok(_), ..) | (Err(_), None, None) => Ok((georeference, false)),
            (Err(NoProjection::Unknown(own)), Some(beside), _) => {
                differ(&beside.path, beside.value.name(), &format!("another one ({own})"))
            }
            // Neither is understood: the scale is unknown in any case, and is refused where it counts.
            (Err(NoProjection::Unknown(_)), None, Some(_)) => Ok((georeference, true)),
            (Err(NoProjection::Local), Some(beside), _) => Ok((georeference.with_projection(&beside.value), true)),
            (Err(NoProjection::Local), None, Some(unclear)) => Ok((georeference.with_unknown_map(unclear.value.reason()), true)),
        }
    }

    /// Which posts of a window, counted from the north, are valid; `None` without a mask.
    ///
    /// # Errors
    /// [`TerrainError::Sidecar`] for a mask of another size than the raster, or that cannot be read.
    pub(super) fn shown(&self, lattice: &PostLattice, window: Window, south_up: bool) -> Result<Option<Vec<bool>>, TerrainError> {
        let Some(mask) = &self.mask else { return Ok(None) };
        let (rows, cols) = mask.value.size();
        if (rows, cols) != (lattice.rows(), lattice.cols()) {
            return Err(refused(
                &mask.path,
                format!(
                    "a mask of {rows} rows and {cols} columns for a raster of {} rows and {} columns, expected the same; remove it or \
                     write it again with gdal_translate -mask",
                    lattice.rows(),
                    lattice.cols()
                ),
            ));
        }
        let mut shown = mask.value.window(window.stored(rows, south_up)).map_err(|reason| refused(&mask.path, reason))?;
        super::window::turn_round(&mut shown, window.cols, south_up);
        Ok(Some(shown))
    }
}

/// The outermost posts that a transform gives.
fn corners([a, b, c, d, e, f]: Transform, rows: usize, cols: usize, south_up: bool) -> MapBounds {
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    let (i, j) = ((cols - 1) as f64, (rows - 1) as f64);
    let point = |i: f64, j: f64| MapPoint::new(a * i + b * j + c, d * i + e * j + f);
    let (first, last) = (point(0.0, 0.0), point(i, j));
    let (north_west, south_east) = if south_up { (point(0.0, j), point(i, 0.0)) } else { (first, last) };
    MapBounds { min: MapPoint::new(north_west.x, south_east.y), max: MapPoint::new(south_east.x, north_west.y) }
}

/// Whether two projections put the corners of a map at the same places, within a millimetre, on bodies of the same size.
fn same_map(own: &MapProjection, other: &MapProjection, bounds: MapBounds) -> bool {
    let (a, b) = (own.definition().ellipsoid, other.definition().ellipsoid);
    let near = |one: f64, two: f64| (one - two).abs() <= 1e-6 * one.abs();
    let middle = nalgebra::center(&bounds.min, &bounds.max);
    let corners = [bounds.min, bounds.max, MapPoint::new(bounds.min.x, bounds.max.y), middle];
    let agrees = |at: MapPoint| match own.lon_lat(at).map(|place| other.map_point(place)) {
        Some(Some(back)) => (back - at).norm() <= 1e-3,
        Some(None) => false,
        None => true,
    };
    near(a.semi_major_m, b.semi_major_m) && near(a.semi_minor_m, b.semi_minor_m) && corners.into_iter().all(agrees)
}

/// The refusal of a sidecar file.
fn refused(path: &Path, problem: String) -> TerrainError {
    TerrainError::Sidecar { path: path.to_path_buf(), problem }
}

fn name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// `dem.tif` and `aux.xml` make `dem.tif.aux.xml`, if there is such a file, in small or capital letters.
fn with_suffix(path: &Path, suffix: &str) -> Option<PathBuf> {
    named_alike(path, &format!("{}.{suffix}", name(path)))
}

/// `dem.tif` and `prj` make `dem.prj`, if there is such a file, in small or capital letters, and it is not the raster itself.
fn with_extension(path: &Path, extension: &str) -> Option<PathBuf> {
    named_alike(path, &name(&path.with_extension(extension))).filter(|file| file != path)
}

/// The file beside another one that has this name, in whatever letters: names of Windows do not distinguish them.
fn named_alike(path: &Path, wanted: &str) -> Option<PathBuf> {
    let exact = path.with_file_name(wanted);
    if exact.is_file() {
        return Some(exact);
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    let names = std::fs::read_dir(folder).ok()?.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut alike: Vec<String> = names.filter(|name| name.eq_ignore_ascii_case(wanted)).collect();
    alike.sort();
    alike.into_iter().map(|name| path.with_file_name(name)).find(|file| file.is_file())
}

/// The text of a sidecar file.
///
/// # Errors
/// [`TerrainError::Sidecar`] if it cannot be read or is not a text of sensible length.
fn text_of(path: &Path) -> Result<String, TerrainError> {
    use std::io::Read;
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(LARGEST_TEXT).read_to_end(&mut bytes))
        .map_err(|error| refused(path, format!("it cannot be read ({error}), expected a text; check its permissions")))?;
    if bytes.len() as u64 == LARGEST_TEXT {
        return Err(refused(
            path,
            "it has over 64 MiB, expected a text of some kilobytes; remove it, or cut it to what is needed".to_owned(),
        ));
    }
    let utf16 = |big_endian: bool| {
        let pairs = bytes[2..].chunks_exact(2).map(|pair| if big_endian { [pair[1], pair[0]] } else { [pair[0], pair[1]] });
        String::from_utf16_lossy(&pairs.map(u16::from_le_bytes).collect::<Vec<_>>())
    };
    Ok(match bytes.get(..2) {
        Some([0xff, 0xfe]) => utf16(false),
        Some([0xfe, 0xff]) => utf16(true),
        _ => String::from_utf8_lossy(&bytes).trim_start_matches('\u{feff}').to_owned(),
    })
}

/// A finite number of a text, or the problem.
fn number(what: &str, text: &str) -> Result<f64, String> {
    let value = text.trim().parse().ok().filter(|value: &f64| value.is_finite());
    value
        .ok_or_else(|| format!("a {what} of '{}', expected a finite number; correct it", crate::quantity::excerpt(text.trim(), 40)))
}
