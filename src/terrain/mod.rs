//! Elevation rasters and what is cut from them.
