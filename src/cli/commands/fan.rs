//! `chta fan`: slices in all directions from one point.

use chta::{
    graph::PointSpacing,
    quantity::Angle,
    reach::{FanRequest, fan},
    report::{Document, FanAnswer, figure::draw_rose},
    scenario::{Extent, Overlays, body_warnings, check_extent, escape_warnings},
    terrain::{check_scale, read_dem},
};
use nalgebra::Vector2;

use super::{captions::conditions, search::use_threads, slice::place};
use crate::cli::{
    Answer, Failure,
    args::{AnswerArgs, FanArgs, Format},
    effects::Purpose,
    load::{Bare, input_file, load_bare},
    output,
    progress::Progress,
};

/// The meaning of `auto` here, where there is no single path to refine for.
const POINTS_PER_SEGMENT: PointSpacing = PointSpacing::PerSegment(1);

/// Analyses all directions.
pub(crate) fn run(args: &FanArgs) -> Result<Answer, Failure> {
    let FanArgs {
        dem: file,
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
    use_threads(*threads)?;
    let failed = |error: &(dyn std::error::Error + 'static)| Failure::of(error);
    let Bare { scenario, base, document, mut warnings } = load_bare(file, common, search, Purpose::Fan)?;
    let dem = read_dem(file).map_err(|e| failed(&e))?;
    let projection = dem.georeference().projection();
    let from = place("from", *from, *from_lonlat)?.on_map("from", projection.as_ref(), dem.bounds()).map_err(|e| failed(&e))?;
    let overlays =
        Overlays::read(&scenario, &base, Some(&dem.georeference().coordinate_system), dem.bounds()).map_err(|e| failed(&e))?;
    warnings.extend(body_warnings(&scenario.body));
    warnings.extend(escape_warnings(&scenario, None));
    let extent = Extent::of_dem(dem.bounds(), projection.is_ok());
    warnings.extend(check_extent(&scenario.body, &extent).map_err(|e| Failure::about(file, &e))?);
    let spacing = scenario.search.spacing.unwrap_or(POINTS_PER_SEGMENT);
    let ground = overlays.ground(dem, &scenario);
    let dem = ground.terrain().dem();
    let request = FanRequest { ground: &ground, from, headings: *headings, length_m: *length, spacing };
    let rays = fan(&request, &Progress::new(common.quiet)).map_err(|e| failed(&e))?;
    let accepted = common.accept_map_scale || scenario.accept_map_scale;
    warnings.extend(overlays.without_effect_on_dem(dem.bounds()));
    for ray in &rays {
        let heading = Angle::from_degrees(ray.heading_deg).radians();
        let end = from + Vector2::new(libm::sin(heading), libm::cos(heading)) * ray.length_m;
        let scale = check_scale(dem, projection.as_ref(), [from, end], accepted, file).map_err(|e| failed(&e))?;
        warnings.extend(scale.warning().filter(|warning| !warnings.contains(warning)));
    }
    for warning in &warnings {
        output::warn(common.quiet, warning);
    }
    let mut answer = FanAnswer::new(from, *length, &rays);
    match spacing {
        PointSpacing::PerSegment(points) => answer.points_per_segment = Some(points),
        PointSpacing::AtMostM(spacing_m) => answer.node_spacing_max_m = Some(spacing_m),
    }
    let mut csv = Vec::new();
    if table.is_some() {
        answer.write_csv(&mut csv).map_err(|e| failed(&e))?;
    }
    if let Some(path) = plot {
        let name = file.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let title = format!("How far in how few hops: {name}");
        let svg = draw_rose(&answer, &title, &subtitle(&answer, &scenario)).map_err(|e| failed(&e))?;
        output::to_file(path, svg.as_bytes())?;
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
            let mut inputs = vec![input_file(file)?];
            for overlay in Overlays::files(&scenario) {
                inputs.push(input_file(&base.join(overlay))?);
            }
            Document::new("fan", document, inputs, warnings, answer).on_map(projection.as_ref().ok()).to_json()?
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
