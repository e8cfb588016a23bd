//! Reads a PDS3 image, whole or in parts.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::image::ImageObject;
use super::label::{LONGEST_LABEL, Label, begins_label, shown, unsuitable};
use super::projection::place;
use crate::terrain::dem::Posts;
use crate::terrain::format::ReadContext;
use crate::terrain::parts::{CheckedParts, StoredParts};
use crate::terrain::stored::{Scaling, StoredRaster, StoredStep};
use crate::terrain::{Dem, DemFile, DemReader, NoData, NoDataRule, PostLattice, TerrainError, Window};

/// The reader of the PDS3 format.
pub(in crate::terrain) struct Pds3Reader;

impl DemReader for Pds3Reader {
    fn name(&self) -> &'static str {
        "PDS3 image"
    }

    fn recognises(&self, beginning: &[u8]) -> bool {
        begins_label(beginning)
    }

    fn read_bytes(&self, bytes: Vec<u8>, context: &ReadContext) -> Result<Dem, TerrainError> {
        let label = Label::parse(&bytes[..bytes.len().min(LONGEST_LABEL)])?;
        let image = ImageObject::of(&label)?;
        if let Some(name) = &image.file {
            let found = format!("its image in another file, {}", shown(name));
            return Err(unsuitable(found, "label and image on disk side by side"));
        }
        OpenPds3::new(&label, image, Source::Bytes(bytes), context)?.read_all(context)
    }

    fn read_path(&self, path: &Path, context: &ReadContext) -> Result<Dem, TerrainError> {
        open_file(path, context)?.read_all(context)
    }

    fn open_path(&self, path: &Path, context: ReadContext) -> Result<Box<dyn DemFile>, TerrainError> {
        Ok(Box::new(CheckedParts::new(open_file(path, &context)?, context)))
    }
}

/// Reads a PDS3 image with attached label from memory.
///
/// Supports one band of integers or reals in any byte order of the standard. `SCALING_FACTOR`, OFFSET and UNIT (m, km) are
/// applied, and gaps come from `MISSING_CONSTANT` and similar keys. If OFFSET is a radius, elevations are distances from the
/// body's centre, as the label states.
///
/// # Errors
/// [`TerrainError::Damaged`] if the label or the image is cut short; [`TerrainError::Unsuitable`] if the label points to
/// another file, or does not describe a north-up map of elevations; [`TerrainError::InvalidDem`] if the numbers do not form a
/// raster.
pub fn read_pds3_bytes(bytes: Vec<u8>) -> Result<Dem, TerrainError> {
    Pds3Reader.read_bytes(bytes, &ReadContext::default())
}

fn open_file(path: &Path, context: &ReadContext) -> Result<OpenPds3, TerrainError> {
    let mut beginning = Vec::new();
    let file = File::open(path).map_err(TerrainError::reading)?;
    (&file).take(LONGEST_LABEL as u64).read_to_end(&mut beginning).map_err(TerrainError::reading)?;
    let label = Label::parse(&beginning)?;
    let image = ImageObject::of(&label)?;
    let file = match &image.file {
        None => file,
        Some(name) => {
            let beside = beside(path, name)?;
            File::open(&beside).map_err(|error| TerrainError::reading(error).in_file(&beside))?
        }
    };
    OpenPds3::new(&label, image, Source::File(file), context)
}

/// The file of a detached label: a file of that name in the same folder, in the label's case, in lower or in upper case.
fn beside(label: &Path, name: &str) -> Result<PathBuf, TerrainError> {
    if name.is_empty() || name.contains(['/', '\\']) || name == ".." {
        return Err(unsuitable(format!("^IMAGE in {}", shown(name)), "the plain name of a file beside the label"));
    }
    let candidates = [name.to_owned(), name.to_ascii_lowercase(), name.to_ascii_uppercase()].map(|name| label.with_file_name(name));
    let found = candidates.iter().find(|path| path.is_file());
    found
        .cloned()
        .ok_or_else(|| unsuitable(format!("its image in {}, which does not exist", shown(name)), "the image beside its label"))
}

/// The source of the bytes.
enum Source {
    File(File),
    Bytes(Vec<u8>),
}

impl Source {
    fn length(&self) -> Result<u64, TerrainError> {
        match self {
            Self::File(file) => Ok(file.metadata().map_err(TerrainError::reading)?.len()),
            Self::Bytes(bytes) => Ok(bytes.len() as u64),
        }
    }

    /// Fills a buffer from an offset.
    fn read(&self, start: u64, buffer: &mut [u8]) -> Result<(), TerrainError> {
        match self {
            Self::File(file) => {
                let mut file = file;
                file.seek(SeekFrom::Start(start)).and_then(|_| file.read_exact(buffer)).map_err(TerrainError::reading)
            }
            Self::Bytes(bytes) => {
                let from = usize::try_from(start).ok().and_then(|start| bytes.get(start..)?.get(..buffer.len()));
                buffer.copy_from_slice(from.ok_or_else(|| damaged("the image ends early".to_owned()))?);
                Ok(())
            }
        }
    }
}

fn damaged(reason: String) -> TerrainError {
    TerrainError::Damaged { format: "PDS3 image", reason }
}

/// A PDS3 image whose lines are read on demand.
struct OpenPds3 {
    image: ImageObject,
    line_bytes: usize,
    source: Source,
    lattice: PostLattice,
    /// Of the user or a sidecar file, beside the marks of the label.
    no_data: Option<NoData>,
}

impl OpenPds3 {
    fn new(label: &Label, mut image: ImageObject, source: Source, context: &ReadContext) -> Result<Self, TerrainError> {
        let ReadContext { no_data: rule, sidecars, .. } = context;
        let no_data = sidecars.no_data(*rule, None)?;
        if *rule != NoDataRule::AsStated {
            image.marks.clear();
        }
        let own = Scaling { scale: image.scale, offset_m: image.offset };
        let scaling = sidecars.scaling((own != Scaling::NONE).then_some(own))?;
        (image.scale, image.offset) = (scaling.scale, scaling.offset_m);
        let (georeference, _) = sidecars.place(place(label)?, (image.rows, image.cols), false)?;
        let length = source.length()?;
        let Some((line_bytes, _)) = image.extent().filter(|(_, end)| *end <= length) else {
            return Err(damaged(format!(
                "its label declares {} lines of {} samples of {} bytes from byte {} on, which a file of {length} bytes cannot hold",
                image.rows,
                image.cols,
                image.sample.bytes(),
                image.start
            )));
        };
        let lattice = PostLattice::new(image.rows, image.cols, georeference)?;
        Ok(Self { image, line_bytes, source, lattice, no_data })
    }

    fn read_all(&self, context: &ReadContext) -> Result<Dem, TerrainError> {
        let ImageObject { rows, cols, .. } = self.image;
        let mut posts = Vec::new();
        posts.try_reserve_exact(rows * cols).map_err(|error| damaged(error.to_string()))?;
        for row in 0..rows {
            self.append(row, 0, cols, &mut posts)?;
        }
        StoredRaster {
            rows,
            cols,
            posts: Posts::Double(posts),
            georeference: self.lattice.georeference().clone(),
            states_metres: true,
            south_up: false,
            scaling: self.scaling(),
            step: self.step(),
        }
        .finish(context)
    }

    /// Appends the elevations of part of a line.
    fn append(&self, row: usize, first_col: usize, cols: usize, posts: &mut Vec<f64>) -> Result<(), TerrainError> {
        let image = &self.image;
        let width = image.sample.bytes();
        let skipped = row * self.line_bytes + image.prefix + first_col * width;
        let mut bytes = vec![0; cols * width];
        self.source.read(image.start + skipped as u64, &mut bytes)?;
        posts.extend(bytes.chunks_exact(width).map(|sample| {
            let stored = image.sample.decode(sample, &image.marks);
            if self.no_data.is_some_and(|mark| mark.is_double(stored)) { f64::NAN } else { image.elevation(stored) }
        }));
        Ok(())
    }
}

impl StoredParts for OpenPds3 {
    fn lattice(&self) -> &PostLattice {
        &self.lattice
    }

    fn south_up(&self) -> bool {
        false
    }

    fn scaling(&self) -> Scaling {
        let ImageObject { scale, offset, metres_per_unit, .. } = self.image;
        Scaling { scale: scale * metres_per_unit, offset_m: offset * metres_per_unit }
    }

    fn step(&self) -> StoredStep {
        match self.image.sample.float_bits() {
            None => StoredStep::Fixed(self.scaling().scale.abs()),
            Some(32) => StoredStep::Single(self.scaling()),
            Some(_) => StoredStep::Fine,
        }
    }

    fn window(&self, Window { first_row, first_col, rows, cols }: Window) -> Result<Vec<f64>, TerrainError> {
        let mut posts = Vec::with_capacity(rows * cols);
        for row in first_row..first_row + rows {
            self.append(row, first_col, cols, &mut posts)?;
        }
        Ok(posts)
    }
}
