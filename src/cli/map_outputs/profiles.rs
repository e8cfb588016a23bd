//! The profiles of all hops of a map's paths, as a grid on as many pages as they need.

use std::path::{Path, PathBuf};

use chta::{
    ballistics::limits::ClearanceProfile,
    figure::{Caption, HopProfile, HopProfilesFigure, draw_hop_profiles},
    path::execute,
    reach::map::MapHop,
    study::conditions,
    terrain::MapProjection,
};

use crate::cli::{Failure, map_input::MapInput, pictures};

/// The hops of each path where a first one is chosen: those of a page.
const CHOSEN: usize = 8;

/// The pages of the hops to all goals, in the format of the file's extension; all hops, or eight of every path from the given one on.
pub(super) fn pages(
    input: &MapInput,
    goal_hops: &[Option<Vec<MapHop>>],
    projection: Option<&MapProjection>,
    (file, from): (&Path, Option<u32>),
) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let (name, scenario) = (input.title(), &input.bare.scenario);
    let (skipped, most) = from.map_or((0, usize::MAX), |from| (from as usize - 1, CHOSEN));
    let longest = goal_hops.iter().flatten().map(Vec::len).max().unwrap_or(0);
    if longest > 0 && skipped >= longest {
        let found = skipped + 1;
        return Err(Failure::message(format!("--profiles-from: found {found}, expected a hop of a path, 1 to {longest}")));
    }
    let mut profiles = Vec::new();
    for (goal, hops) in goal_hops.iter().enumerate() {
        let hops = hops.as_deref().unwrap_or_default();
        for (number, hop) in hops.iter().enumerate().skip(skipped).take(most) {
            let name = format!("goal {}, hop {} of {}", goal + 1, number + 1, hops.len());
            profiles.extend(profile(hop, name, projection));
        }
    }
    let count = match profiles.len() {
        0 => "no goal is reached by a hop".to_owned(),
        1 => "1 hop".to_owned(),
        many => format!("{many} hops, row by row"),
    };
    let caption = Caption { title: format!("Hop by hop: {name}"), lines: vec![conditions(scenario), count] };
    let figure = HopProfilesFigure { caption, clearance: ClearanceProfile::of(scenario.hopper.limits()), hops: profiles };
    pictures::encoded(draw_hop_profiles(&figure), file)
}

/// One hop over its slice, flown again to find its least clearance.
fn profile(hop: &MapHop, name: String, projection: Option<&MapProjection>) -> Option<HopProfile> {
    let flown = execute(hop.test.chain(), &hop.path, None);
    let least = flown.flights.first().and_then(|flight| flight.as_ref()?.least_clearance);
    let test = &hop.test;
    let hop = *hop.path.hops.first()?;
    let takeoff = hop.takeoff.map();
    Some(HopProfile {
        name,
        ground: test.chain().geometry().vertices().to_vec(),
        hop,
        heading_true_deg: takeoff.zip(projection).and_then(|(at, projection)| projection.true_heading_deg(at, hop.heading_deg)),
        least_clearance_m: least.map(|clearance| (clearance.x_m, clearance.height_m)),
    })
}
