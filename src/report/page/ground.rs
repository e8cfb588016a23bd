//! The ground of a page, as its script reads it: what is drawn, not what is answered.

use base64::{Engine as _, engine::general_purpose::STANDARD};
use serde::{Serialize, Serializer};

/// The ground of a page.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PageGround {
    /// Stretches of the ground under the path, or of a whole chain.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pieces: Vec<ProfilePiece>,
    /// The same over a mesh, where several surfaces may lie over one another.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cuts: Vec<ProfileCut>,
    /// The posts of an elevation raster.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub posts: Option<PagePosts>,
    /// The facets of a mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub facets: Option<PageFacets>,
    /// Where overlays refuse contact, for the same posts.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<PageLayer>,
}

/// A stretch of ground as a polyline.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ProfilePiece {
    /// The index of its leg, from whose beginning x is measured; `None` for a chain, along which it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leg: Option<usize>,
    /// Horizontal positions, m.
    pub x_m: Vec<f64>,
    /// Heights, m.
    pub z_m: Vec<f64>,
    /// Eastings, where they are known, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map_x_m: Option<Vec<f64>>,
    /// Northings, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map_y_m: Option<Vec<f64>>,
}

/// The segments in which the plane of a leg cuts the facets of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProfileCut {
    /// The index of the leg, from whose beginning x is measured.
    pub leg: usize,
    /// Each segment: x and z of both ends, m.
    pub segments_m: Vec<[f64; 4]>,
}

/// Posts of an elevation raster, row after row from the north-west.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PagePosts {
    /// Rows of the page.
    pub rows: usize,
    /// Columns of the page.
    pub columns: usize,
    /// Rows of the raster.
    pub of_rows: usize,
    /// Columns of the raster.
    pub of_columns: usize,
    /// Every so many rows and columns of the raster are there.
    pub stride: usize,
    /// Easting of the first column, m.
    pub west_m: f64,
    /// Northing of the first row, m.
    pub north_m: f64,
    /// Spacing of columns, m.
    pub dx_m: f64,
    /// Spacing of rows, m.
    pub dy_m: f64,
    /// Height of step 0, m.
    pub z_min_m: f64,
    /// Height of one step, m.
    pub z_step_m: f64,
    /// Heights in steps, 65535 without data.
    #[serde(serialize_with = "words")]
    pub steps: Vec<u16>,
}

/// Facets of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PageFacets {
    /// The point that vertices are measured from, m.
    pub origin_m: [f64; 3],
    /// Coordinates of the vertices from there, m, three each.
    #[serde(serialize_with = "floats")]
    pub vertices: Vec<f32>,
    /// Numbers of the vertices of each facet, three each.
    #[serde(serialize_with = "longs")]
    pub corners: Vec<u32>,
    /// How many corners there are: three for each facet.
    pub corners_count: usize,
    /// Facets of the whole mesh.
    pub of_facets: usize,
}

/// Where an overlay refuses contact.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PageLayer {
    /// What it is, for the legend.
    pub name: String,
    /// One bit for each post, from the least significant of the first byte.
    #[serde(serialize_with = "bytes")]
    pub bits: Vec<u8>,
}

fn base64<S: Serializer>(bytes: impl AsRef<[u8]>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&STANDARD.encode(bytes))
}

fn bytes<S: Serializer>(values: &[u8], serializer: S) -> Result<S::Ok, S::Error> {
    base64(values, serializer)
}

fn words<S: Serializer>(values: &[u16], serializer: S) -> Result<S::Ok, S::Error> {
    base64(values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>(), serializer)
}

fn longs<S: Serializer>(values: &[u32], serializer: S) -> Result<S::Ok, S::Error> {
    base64(values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>(), serializer)
}

fn floats<S: Serializer>(values: &[f32], serializer: S) -> Result<S::Ok, S::Error> {
    base64(values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>(), serializer)
}
