//! `chta fan`: slices in all directions from one point.

use chta::{
    figure::draw_rose,
    graph::PointSpacing,
    quantity::Angle,
    reach::{FanRequest, fan},
    report::{Document, DocumentKind, FanAnswer},
    study::{Extremes, Overlays, coarse_dem_warning, constant_gravity_warnings, dem_on_body},
    terrain::check_scale,
};
use nalgebra::Vector2;

use super::{captions::conditions, search::use_threads, slice::place};
use crate::cli::{
    Answer, Failure,
    args::{AnswerArgs, FanArgs, Format},
    effects::Purpose,
    inputs,
    load::{Bare, load_bare, raster_files},
    output,
    progress::Progress,
    wrong_thing::Role,
};

/// The meaning of `auto` here, where there is no single path to refine for.
const POINTS_PER_SEGMENT: PointSpacing = PointSpacing::PerSegment(1);

/// Analyses all directions.
pub(crate) fn run(args: &FanArgs) -> Result<Answer, Failure> {
    let FanArgs {
        dem: dem_file,
        from,
        from_lonlat,
        headings,
        length,
        output: table,
        plot,
        answer: AnswerArgs { threads, format },
        search,
        common,
    } = args;
    inputs::look_at(common.input_max_gib, &[(Some(dem_file), Role::Dem), (common.scenario.as_deref(), Role::ScenarioOption)])?;
    use_threads(*threads)?;
    let failed = |error: &(dyn std::error::Error + 'static)| Failure::of(error);
    let Bare { dem: dem_file, scenario, base, document, mut warnings } = load_bare(dem_file, common, search, Purpose::Fan)?;
    let dem_file = dem_file.as_path();
    let (dem, of_dem) = dem_on_body(&scenario, dem_file).map_err(|e| Failure::about(dem_file, &e))?;
    warnings.extend(of_dem);
    let projection = dem.georeference().projection();
    let from = place("from", *from, *from_lonlat)?.on_map("from", projection.as_ref(), dem.bounds()).map_err(|e| failed(&e))?;
    let overlays =
        Overlays::read(&scenario, &base, Some(&dem.georeference().coordinate_system), dem.bounds()).map_err(|e| failed(&e))?;
    // Opened before the computation, which may take long.
    let picture = plot.as_deref().map(|path| output::begin_picture("--plot", path)).transpose()?;
    let spacing = scenario.search.spacing.unwrap_or(POINTS_PER_SEGMENT);
    let ground = overlays.ground(dem, &scenario);
    let dem = ground.terrain().dem();
    let request = FanRequest { ground: &ground, from, headings: *headings, length_m: *length, spacing };
    let rays = fan(&request, &Progress::new(common.quiet)).map_err(|e| failed(&e))?;
    let accepted = common.accept_map_scale || scenario.accept_map_scale;
    warnings.extend(overlays.without_effect_on_dem(dem.bounds()));
    warnings.extend(coarse_dem_warning(&scenario.hopper, dem.georeference()));
    for ray in &rays {
        let heading = Angle::from_degrees(ray.heading_deg).radians();
        let end = from + Vector2::new(libm::sin(heading), libm::cos(heading)) * ray.length_m;
        let scale =
            check_scale(dem, projection.as_ref(), [from, end], accepted, dem_file).map_err(|e| Failure::about(dem_file, &e))?;
        warnings.extend(scale.warning().filter(|warning| !warnings.contains(warning)));
    }
    // Some hop of the fewest to the end of a band is at least the mean of them.
    let bands = rays.iter().flat_map(|ray| &ray.bands);
    #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
    let range_m = bands.filter_map(|band| Some(band.to_m / band.hops.filter(|hops| *hops > 0)? as f64)).fold(0.0, f64::max);
    warnings.extend(constant_gravity_warnings(&scenario.body, Extremes { range_m, ..Extremes::default() }));
    for warning in &warnings {
        output::warn(common.quiet, warning);
    }
    let mut answer = FanAnswer::new(from, *length, &rays, projection.as_ref().ok());
    match spacing {
        PointSpacing::PerSegment(points) => answer.points_per_segment = Some(points),
        PointSpacing::AtMostM(spacing_m) => answer.node_spacing_max_m = Some(spacing_m),
    }
    let mut csv = Vec::new();
    if table.is_some() {
        answer.write_csv(&mut csv).map_err(|e| failed(&e))?;
    }
    if let Some(file) = picture {
        let name = dem_file.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let title = format!("How far in how few hops: {name}");
        let rose = draw_rose(&answer, &title, &subtitle(&answer, &scenario));
        let encoded = output::encoded(Ok(rose), file.path())?;
        output::finish(vec![(file, encoded)])?;
    }
    if let Some(path) = table {
        output::to_file_or_stdout(Some(path), &csv)?;
        if path == std::path::Path::new("-") {
            return Ok(Answer::Yes);
        }
    }
    let text = match format {
        Format::Text => answer.text(),
        Format::Json => {
            let mut inputs = raster_files(dem_file)?;
            for overlay in Overlays::files(&scenario) {
                inputs.extend(raster_files(&base.join(overlay))?);
            }
            Document::new(DocumentKind::Fan, document, inputs, warnings, answer).on_map(projection.as_ref().ok()).to_json()?
        }
    };
    output::to_stdout(text.as_bytes())?;
    Ok(Answer::Yes)
}

/// Numbers under the title of the picture.
fn subtitle(answer: &FanAnswer, scenario: &chta::scenario::Scenario) -> String {
    let [x, y] = answer.from_m;
    format!(
        "{} headings from ({x}, {y}) m, at most {} m; {}; {} headings lead to their far end",
        answer.headings,
        answer.length_m,
        conditions(scenario),
        answer.reached_ends()
    )
}
