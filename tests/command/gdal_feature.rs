//! ISIS and PDS4 through the optional feature `gdal`: a file rewritten by GDAL into either gives the same slice.

#![allow(clippy::unwrap_used, reason = "a test that cannot make its files should stop")]

use std::process::Command;

use chta::{quantity::MapPoint, terrain::slice_file};

use crate::{installed::has_gdal, real_terrain::real};

#[test]
fn isis_and_pds4_give_the_slice_of_the_geotiff_they_were_made_from() {
    let Some(lola) = real("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif").filter(|_| has_gdal()) else { return };
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (MapPoint::new(75_500.0, 38_600.0), MapPoint::new(76_500.0, 39_500.0));
    let expected = slice_file(&lola, from, to).unwrap();
    for (format, name) in [("ISIS3", "lola.cub"), ("PDS4", "lola.xml")] {
        let file = folder.path().join(name);
        let made = Command::new("gdal_translate").args(["-q", "-of", format]).arg(&lola).arg(&file).output().unwrap();
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        assert_eq!(slice_file(&file, from, to).unwrap(), expected, "{format}");
    }
}
