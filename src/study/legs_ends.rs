//! The ground of a robot with legs, of a mesh or of a DEM, with start and goal.

use std::{path::Path, sync::Arc};

use nalgebra::Point3;

use super::{
    LegsRouteError, MeshHopError, Overlays,
    mesh_ends::{MeshEnds, mesh_ends, within},
    mesh_hop::on_mesh,
    on_body::dem_on_body,
    stance::faces_down,
};
use crate::{
    ground::{MeshContact, MeshGround},
    quantity::{MapPoint, format_number},
    report::{LegsGroundKind, LegsGroundRecord},
    scenario::{Scenario, TerrainSource},
    terrain::{Dem, MapBounds, MapPlace, MapProjection, MeshTree, OverlaidDem, Triangles, check_scale, mesh_of_dem},
    world::Robot,
};

/// The most posts whose facets are taken as a mesh: some 300 bytes each.
pub(super) const POSTS_MAX: usize = 2_000_000;

/// The ground, with start and goal on it.
#[derive(Clone, Debug)]
pub(super) struct LegsEnds {
    /// The facets under the limits that planning may use.
    pub(super) ground: MeshGround,
    /// The DEM with its overlays, where the facets are those between its posts.
    pub(super) map: Option<OverlaidDem>,
    /// The reference system of its map, if it is known.
    pub(super) projection: Option<MapProjection>,
    /// Metres per unit of the file of a mesh.
    pub(super) scale: f64,
    /// Start and goal as given, m.
    pub(super) given_m: [Point3<f64>; 2],
    /// Start and goal on the surface.
    pub(super) surface: [MeshContact; 2],
    /// The ground in the answer.
    pub(super) record: LegsGroundRecord,
    /// Warnings about the ground and its ends.
    pub(super) warnings: Vec<String>,
}

/// Reads the terrain of a scenario and finds start and goal on it.
///
/// # Errors
/// [`LegsRouteError`].
pub(super) fn legs_ends(scenario: &Scenario, base: &Path, robot: &Robot) -> Result<LegsEnds, LegsRouteError> {
    let Some(TerrainSource::Dem { path, start, goal }) = &scenario.terrain else {
        let MeshEnds { ground, scale, given_m, surface, mut warnings, .. } = mesh_ends(scenario, base, 0.0)?;
        warnings.extend(["start", "goal"].iter().zip(&surface).filter_map(|(end, at)| faces_down(at, end)));
        let facets = ground.tree().mesh().triangle_count();
        let record = LegsGroundRecord { kind: LegsGroundKind::Mesh, facets, post_spacing_m: None, no_data_posts: None };
        return Ok(LegsEnds { ground, map: None, projection: None, scale, given_m, surface, record, warnings });
    };
    let DemGroundOfLegs { ground, map, record, mut warnings } = dem_ground_of_legs(scenario, base, (&base.join(path), robot))?;
    let dem = map.dem();
    let projection = dem.georeference().projection();
    let ends = [("start", start), ("goal", goal)].map(|(end, place)| on_dem(dem, end, place));
    let [start, goal] = ends;
    let given_m = [start?, goal?];
    let scale = check_scale(dem, projection.as_ref(), given_m.map(|at| at.xy()), scenario.accept_map_scale, &base.join(path))?;
    warnings.extend(scale.warning());
    let bounds = scenario.mesh_search.bounds;
    let mut contact = |at: usize, end| {
        Ok::<_, LegsRouteError>(within(
            bounds,
            end,
            on_mesh(&ground, given_m[at], end, &mut warnings).map_err(super::MeshRouteError::from)?,
        )?)
    };
    let surface = [contact(0, "start")?, contact(1, "goal")?];
    Ok(LegsEnds { ground, projection: projection.ok(), scale: 1.0, given_m, surface, record, warnings, map: Some(map) })
}

/// The facets of a DEM as the ground of a robot with legs.
#[derive(Clone, Debug)]
pub(super) struct DemGroundOfLegs {
    /// The facets under the limits that planning may use.
    pub(super) ground: MeshGround,
    /// The DEM with its overlays.
    pub(super) map: OverlaidDem,
    /// The ground in the answer.
    pub(super) record: LegsGroundRecord,
    /// Warnings.
    pub(super) warnings: Vec<String>,
}

/// Reads a DEM with its overlays and takes the facets between its posts, of the whole map or those about `search.bounds_m`, as a mesh.
///
/// # Errors
/// [`LegsRouteError`].
pub(super) fn dem_ground_of_legs(
    scenario: &Scenario,
    base: &Path,
    (file, robot): (&Path, &Robot),
) -> Result<DemGroundOfLegs, LegsRouteError> {
    let (dem, mut warnings) = dem_on_body(scenario, file)?;
    let overlays = Overlays::read(scenario, base, Some(&dem.georeference().coordinate_system), dem.bounds())?;
    warnings.extend(overlays.without_effect_on_dem(dem.bounds()));
    let whole = dem.bounds();
    // Feet stand and trunks fly beyond the contacts.
    let beside_m = robot.reach_m() + robot.leg_length_m() + robot.trunk_radius_m();
    let part = scenario.mesh_search.bounds.map_or(whole, |bounds| MapBounds {
        min: MapPoint::new(bounds.min.x - beside_m, bounds.min.y - beside_m),
        max: MapPoint::new(bounds.max.x + beside_m, bounds.max.y + beside_m),
    });
    let posts = posts_within(&dem, part);
    if posts > POSTS_MAX {
        return Err(LegsRouteError::TooManyPosts { posts });
    }
    let mesh = mesh_of_dem(&dem, part)?;
    let (spacing_m, legs_m) = (dem.georeference().dx_m().max(dem.georeference().dy_m()), robot.reach_m());
    if spacing_m > legs_m && legs_m > 0.0 {
        warnings.push(format!(
            "the posts are {} m apart and the feet reach {} m from the root: the feet stand on plane facets, and the rocks and holes between posts, \
             which decide where legs stand, are not known",
            format_number(spacing_m),
            format_number(legs_m)
        ));
    }
    let gaps = dem.elevations().filter(Option::is_none).count();
    let record = LegsGroundRecord {
        kind: LegsGroundKind::Dem,
        facets: mesh.triangle_count(),
        post_spacing_m: Some(spacing_m),
        no_data_posts: Some(gaps),
    };
    let planned = scenario.derated();
    let planned = planned.as_ref().unwrap_or(scenario);
    let hopper = planned.hopper.with_any_command();
    let ground = MeshGround::new(MeshTree::new(mesh), &hopper, scenario.body.gravity, &planned.surface).map_err(MeshHopError::from);
    let ground = ground.map_err(super::MeshRouteError::from)?;
    Ok(DemGroundOfLegs { ground, map: overlays.laid_over(dem), record, warnings })
}

/// How many posts lie within a rectangle, about.
fn posts_within(dem: &Dem, part: MapBounds) -> usize {
    let (bounds, map) = (dem.bounds(), dem.georeference());
    let count = |low: f64, high: f64, step_m: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most the posts of the raster")]
        let count = ((high - low).max(0.0) / step_m) as usize + 1;
        count
    };
    count(part.min.x.max(bounds.min.x), part.max.x.min(bounds.max.x), map.dx_m()).saturating_mul(count(
        part.min.y.max(bounds.min.y),
        part.max.y.min(bounds.max.y),
        map.dy_m(),
    ))
}

/// A place of a map on its ground.
pub(super) fn on_dem(dem: &Dem, end: &'static str, place: &MapPlace) -> Result<Point3<f64>, LegsRouteError> {
    let (map, bounds) = (dem.georeference(), dem.bounds());
    let at = place.on_map(end, map.projection().as_ref(), bounds)?;
    if !bounds.contains(at) {
        return Err(LegsRouteError::OffTheMap { end, at, bounds });
    }
    let ground = Triangles::of(dem);
    let (z_m, _) = ground.at(at, ground.nominal()).ok_or(LegsRouteError::NoElevation { end, at })?;
    Ok(Point3::new(at.x, at.y, z_m))
}

/// A map of the limits that planning may use: a share of the friction of its raster counts.
pub(super) fn planned_map(map: &OverlaidDem, scenario: &Scenario) -> OverlaidDem {
    if scenario.derating.is_none() {
        return map.clone();
    }
    OverlaidDem::new(map.shared_dem(), Arc::new(map.overlays().with_friction_share(scenario.derating.friction)))
}
