//! Sound TIFFs in an encoding that `tiff-reader` does not decode: named, with the command that makes a readable file.

use tiff_reader::{Ifd, TiffError};

use super::image::damaged;
use crate::terrain::TerrainError;

/// Compressions that are decoded, by their code.
const DECODED: [u16; 7] = [1, 5, 8, 32773, 32946, 34887, 50000];

/// Other compressions, by their code (libtiff's `tiff.h`).
const COMPRESSIONS: [(u16, &str); 29] = [
    (2, "CCITT run-length"),
    (3, "CCITT fax 3"),
    (4, "CCITT fax 4"),
    (6, "old JPEG"),
    (7, "JPEG"),
    (9, "JBIG"),
    (10, "JBIG"),
    (32766, "NeXT"),
    (32771, "CCITT run-length by words"),
    (32809, "ThunderScan"),
    (32908, "Pixar film"),
    (32909, "Pixar log"),
    (32947, "Kodak DCS"),
    (33003, "JPEG 2000"),
    (33004, "JPEG 2000"),
    (33005, "JPEG 2000"),
    (34661, "JBIG"),
    (34676, "SGI log luminance"),
    (34677, "SGI log luminance"),
    (34712, "JPEG 2000"),
    (34892, "lossy JPEG"),
    (34925, "LZMA"),
    (34926, "ZSTD under an old code"),
    (34927, "WebP under an old code"),
    (34933, "PNG"),
    (34934, "JPEG XR"),
    (50001, "WebP"),
    (50002, "JPEG XL"),
    (52546, "JPEG XL"),
];

const DECODED_SAMPLES: &str = "integers of 1 to 16, 32 or 64 bits or floats of 32 or 64 bits";

/// Refuses an image that is in order but cannot be decoded.
pub(super) fn refuse_undecodable(image: &Ifd) -> Result<(), TerrainError> {
    refuse_compression(image.compression())?;
    let formats = image.sample_format().map_err(unreadable)?;
    let bits = image.bits_per_sample().map_err(unreadable)?;
    if let (Some(format), Some(bits)) = (formats.first(), bits.first()) {
        refuse_samples(*format, *bits)?;
        refuse_predictor(image.predictor(), *format, *bits)?;
    }
    Ok(())
}

/// The error of the decoder, as damage only if it is some.
pub(super) fn unreadable(error: TiffError) -> TerrainError {
    match error {
        TiffError::Io(reason, _) => TerrainError::reading(reason),
        TiffError::UnsupportedCompression(code) => undecodable_compression(code),
        TiffError::UnsupportedPredictor(code) => undecodable(format!("samples stored with predictor {code}")),
        TiffError::UnsupportedBitsPerSample(bits) => undecodable(format!("samples of {bits} bits")),
        TiffError::UnsupportedSampleFormat(format) => undecodable(format!("samples in sample format {format}")),
        TiffError::UnsupportedPlanarConfiguration(code) => undecodable(format!("bands in planar configuration {code}")),
        other => damaged(other.to_string()),
    }
}

fn undecodable(found: String) -> TerrainError {
    TerrainError::Unsuitable {
        found,
        expected: DECODED_SAMPLES,
        mend: "gdal_translate -ot Float64 in.tif out.tif, if GDAL reads the file".to_owned(),
    }
}

fn refuse_compression(code: u16) -> Result<(), TerrainError> {
    if DECODED.contains(&code) { Ok(()) } else { Err(undecodable_compression(code)) }
}

fn undecodable_compression(code: u16) -> TerrainError {
    let name = COMPRESSIONS.iter().find(|(known, _)| *known == code).map(|(_, name)| *name);
    let found = match name {
        Some(name) => format!("{name} compression (TIFF code {code})"),
        None => format!("a compression that is not known here (TIFF code {code})"),
    };
    TerrainError::Unsuitable {
        found,
        expected: "deflate, LZW, PackBits, ZSTD, LERC or no compression",
        mend: "gdal_translate -co COMPRESS=DEFLATE in.tif out.tif".to_owned(),
    }
}

fn refuse_samples(format: u16, bits: u16) -> Result<(), TerrainError> {
    let (found, mend) = match (format, bits) {
        (1 | 4, 1..=16 | 32 | 64) | (2, 8 | 16 | 32 | 64) | (3, 32 | 64) => return Ok(()),
        (1 | 4, 17..=63) => (format!("unsigned integers of {bits} bits"), "gdal_translate -ot Float64 in.tif out.tif"),
        // GDAL reads signed samples of odd widths without their sign.
        (2, _) => (
            format!("signed integers of {bits} bits"),
            "another export of the product, with 16-bit integers or 32-bit floats (gdal_translate would lose the signs)",
        ),
        (3, 16 | 24) => (format!("floats of {bits} bits"), "gdal_translate -ot Float32 in.tif out.tif"),
        (5 | 6, _) => (
            format!("complex numbers of {bits} bits"),
            "gdal_translate -ot Float32 in.tif out.tif, which keeps their real part, if this is the elevation",
        ),
        (1 | 3 | 4, _) => return Err(undecodable(format!("samples of {bits} bits"))),
        _ => return Err(undecodable(format!("samples of {bits} bits in sample format {format}, which TIFF does not define"))),
    };
    Err(TerrainError::Unsuitable { found, expected: DECODED_SAMPLES, mend: mend.to_owned() })
}

fn refuse_predictor(predictor: u16, format: u16, bits: u16) -> Result<(), TerrainError> {
    let kind = match predictor {
        1 => return Ok(()),
        2 if matches!(bits, 8 | 16 | 32 | 64) => return Ok(()),
        3 if format == 3 && matches!(bits, 32 | 64) => return Ok(()),
        2 => "horizontal differences",
        3 => "the predictor of floats",
        _ => "a predictor that is not known here",
    };
    Err(TerrainError::Unsuitable {
        found: format!("samples of {bits} bits stored with {kind} (predictor {predictor})"),
        expected: "no predictor, horizontal differences of 8, 16, 32 or 64 bits, or the predictor of floats with floats",
        mend: "gdal_translate -co COMPRESS=DEFLATE -co PREDICTOR=1 in.tif out.tif, if GDAL reads the file".to_owned(),
    })
}
