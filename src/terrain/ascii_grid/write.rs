//! Writes an ASCII grid.

use std::io::Write;

use crate::terrain::{Dem, GeoReference, TerrainError};

/// The no-data value; another one is chosen if some elevation has this value.
const NO_DATA: f64 = -9999.0;

/// Writes a DEM as an ESRI ASCII grid with centre coordinates, with the shortest digits that read back as the same numbers.
///
/// The format has no map projection, so that of a GeoTIFF is lost. The north-west post reads back exactly if some double for
/// the south-west post gives it, otherwise within one unit in the last place.
///
/// # Errors
/// [`TerrainError::Io`] if `out` cannot be written to.
pub fn write_ascii_grid(dem: &Dem, out: impl Write) -> Result<(), TerrainError> {
    write_text(dem, out).map_err(TerrainError::writing)
}

fn write_text(dem: &Dem, out: impl Write) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(out);
    let map = dem.georeference();
    let no_data = free_mark(dem);
    writeln!(out, "ncols {}\nnrows {}", dem.cols(), dem.rows())?;
    writeln!(out, "xllcenter {}\nyllcenter {}", map.north_west().x, south_of(map, dem.rows()))?;
    if map.dx_m() == map.dy_m() {
        writeln!(out, "cellsize {}", map.dx_m())?;
    } else {
        writeln!(out, "dx {}\ndy {}", map.dx_m(), map.dy_m())?;
    }
    writeln!(out, "NODATA_value {no_data}")?;
    for row in 0..dem.rows() {
        for col in 0..dem.cols() {
            let separator = if col == 0 { "" } else { " " };
            write!(out, "{separator}{}", dem.elevation(row, col).unwrap_or(no_data))?;
        }
        writeln!(out)?;
    }
    out.flush()
}

/// The northing of the southernmost row, chosen so that the reader's sum gives back the original double for the northernmost
/// row.
fn south_of(map: &GeoReference, rows: usize) -> f64 {
    let south = map.post(rows - 1, 0).y;
    #[expect(clippy::cast_precision_loss, reason = "rows stay far below 2^53")]
    let height = (rows - 1) as f64 * map.dy_m();
    let gives_north = |candidate: &f64| candidate + height == map.north_west().y;
    [south, south.next_up(), south.next_down()].into_iter().find(gives_north).unwrap_or(south)
}

fn free_mark(dem: &Dem) -> f64 {
    let mut mark = NO_DATA;
    while dem.elevations().any(|elevation| elevation == Some(mark)) {
        mark = mark * 10.0 - 9.0;
    }
    mark
}
