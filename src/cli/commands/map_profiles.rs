//! The profiles of all hops of a map's paths, one picture below the other.

use std::fmt::Write;

use chta::{
    ballistics::HopTest,
    graph::{PointSpacing, SearchOptions, search},
    quantity::VertexId,
    reach::map::MapHop,
    report::figure::{FigureInput, FigureTitle, draw},
    scenario::Scenario,
};

use super::plan::ground_words;
use crate::cli::Failure;

/// The pictures of all hops to all goals as one SVG.
pub(super) fn sheet(scenario: &Scenario, ways: &[Option<Vec<MapHop>>]) -> Result<String, Failure> {
    let mut pictures = Vec::new();
    for (goal, way) in ways.iter().enumerate() {
        let hops = way.as_deref().unwrap_or_default();
        for (number, hop) in hops.iter().enumerate() {
            let name = format!("goal {}, hop {} of {}", goal + 1, number + 1, hops.len());
            pictures.push(profile(scenario, hop, name)?);
        }
    }
    Ok(stacked(&pictures))
}

/// One hop over its slice, as `chta plan` draws it.
fn profile(scenario: &Scenario, hop: &MapHop, name: String) -> Result<String, Failure> {
    let failed = |error: &dyn std::error::Error| Failure::message(error.to_string());
    let test = HopTest::new(&hop.chain, &scenario.hopper, scenario.body.gravity_m_s2);
    let geometry = hop.chain.geometry();
    let (start, goal) = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(0)), ..SearchOptions::default() };
    let answer = search(&test, start, goal, &options, &mut |_| {}).map_err(|e| failed(&e))?;
    let body = scenario.body.name.clone().unwrap_or_default();
    let title = FigureTitle { name, body, ground: ground_words(scenario) };
    draw(&FigureInput { test: &test, answer: &answer, path: Some(&hop.path), start, goal, title }).map_err(|e| failed(&e))
}

/// Pictures in millimetres, one below the other.
fn stacked(pictures: &[String]) -> String {
    let size_mm = |picture: &str, side: &str| {
        let value = picture.split_once(&format!(" {side}=\"")).and_then(|(_, rest)| rest.split_once("mm\""));
        value.and_then(|(number, _)| number.parse::<f64>().ok()).unwrap_or(0.0)
    };
    let (mut inner, mut width_mm, mut height_mm) = (String::new(), 0.0f64, 0.0);
    for picture in pictures {
        let Some((head, rest)) = picture.split_once("<svg ").and_then(|(_, rest)| rest.split_once('>')) else { continue };
        // Writing to a String cannot fail.
        let _ = writeln!(inner, "<svg y=\"{height_mm}\" {}>{}", head.replace("mm\"", "\""), rest.trim_end());
        width_mm = width_mm.max(size_mm(picture, "width"));
        height_mm += size_mm(picture, "height");
    }
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width_mm}mm\" height=\"{height_mm}mm\" \
         viewBox=\"0 0 {width_mm} {height_mm}\">\n{inner}</svg>\n"
    )
}
