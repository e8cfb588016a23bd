//! Measures a roadmap on a mesh: pairs a second, and what its best paths take, over as many contacts as are wanted.
//!
//! `cargo run --release --example mesh_roadmap -- SCENARIO.toml [CONTACTS] [SEEDS]`
//!
//! The scenario has `terrain.mesh` with `route = "free"`. For every seed one line: the contacts, the pairs and windows, the seconds and pairs
//! a second of all threads (`RAYON_NUM_THREADS=1` for one), the shortest arcs and their hops, and the fewest hops and their arcs. A last
//! line has the number of contacts at which the first path was found by adding one eighth at a time, as the mean of the seeds.

#![expect(clippy::print_stdout, reason = "the figures are its output")]

use std::{error::Error, path::Path, time::Instant};

use chta::{
    ballistics::TakeoffChoice,
    ground::{MeshContact, MeshGround},
    planner::{
        Amount, Budgets, LabelCap, Objective, SearchedCommands,
        roadmap::{ContactSampler, Roadmap, RoadmapQuestion},
    },
    scenario::{Entries, Scenario, TerrainSource},
    terrain::{MeshTree, read_mesh_with},
};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("expected a scenario with a mesh and route = \"free\"")?;
    let count: usize = arguments.next().map_or(Ok(2000), |text| text.parse())?;
    let seeds: u64 = arguments.next().map_or(Ok(1), |text| text.parse())?;
    let scenario =
        Scenario::new(Entries::from_toml(&std::fs::read_to_string(&file)?)).map_err(|problems| format!("{problems:?}"))?;
    let Some(TerrainSource::MeshInSpace { path, scale, start_m, goal_m }) = &scenario.terrain else {
        return Err("expected a mesh with route = \"free\"".into());
    };
    let base = Path::new(&file).parent().unwrap_or(Path::new(""));
    let mesh = read_mesh_with(&base.join(path), *scale, scenario.no_data)?.mesh;
    let ground = MeshGround::new(MeshTree::new(mesh), &scenario.hopper, scenario.body.gravity, &scenario.surface)?;
    let ends = [ground.contact(*start_m)?, ground.contact(*goal_m)?];
    let mut first_paths = Vec::new();
    for seed in 0..seeds {
        let mut sampler = ContactSampler::new(&ground, scenario.mesh_search.bounds, 0.0, seed)?;
        let contacts = sampler.all_over(count.saturating_sub(2), &|_| true);
        let (mut roadmap, began) = (Roadmap::new(), Instant::now());
        roadmap.extend(&ground, ends.iter().chain(&contacts).cloned().collect(), &())?;
        let seconds = began.elapsed().as_secs_f64();
        let best = |amounts: Vec<Amount>| -> Result<String, Box<dyn Error>> {
            let objective = Objective::new(amounts)?;
            let route = roadmap.route(&ground, (0, 1), &question(&objective))?;
            Ok(route.path.map_or("no path".to_owned(), |path| {
                format!("{:.2} m in {} hops", path.totals.of(Amount::ArcLength), path.totals.of(Amount::Hops))
            }))
        };
        #[expect(clippy::cast_precision_loss, reason = "a rate for reading")]
        let rate = roadmap.pairs_tested() as f64 / seconds / 1e6;
        println!(
            "seed {seed}: {} contacts, {} pairs, {} windows, {seconds:.3} s, {rate:.2} million pairs/s; shortest {}; fewest {}",
            roadmap.contact_count(),
            roadmap.pairs_tested(),
            roadmap.window_count(),
            best(vec![Amount::ArcLength])?,
            best(vec![Amount::Hops, Amount::ArcLength])?
        );
        first_paths.extend(first_path(&ground, &ends, &contacts)?);
    }
    #[expect(clippy::cast_precision_loss, reason = "means for reading")]
    let mean = |of: &dyn Fn(&(usize, f64)) -> f64| first_paths.iter().map(of).sum::<f64>() / first_paths.len() as f64;
    #[expect(clippy::cast_precision_loss, reason = "a count for reading")]
    let contacts = mean(&|(contacts, _)| *contacts as f64);
    println!(
        "first path of {} of {seeds} seeds: {contacts:.0} contacts, {:.4} s",
        first_paths.len(),
        mean(&|(_, seconds)| *seconds)
    );
    Ok(())
}

fn question(objective: &Objective) -> RoadmapQuestion<'_> {
    let (commands, takeoff) = (SearchedCommands::Distinct, TakeoffChoice::LeastSpeed);
    RoadmapQuestion { objective, budgets: &Budgets::NONE, commands, takeoff, cap: LabelCap::default() }
}

/// At how many contacts, added one eighth at a time, and after how many seconds there is a path.
fn first_path(
    ground: &MeshGround,
    ends: &[MeshContact; 2],
    contacts: &[MeshContact],
) -> Result<Option<(usize, f64)>, Box<dyn Error>> {
    let (mut roadmap, began) = (Roadmap::new(), Instant::now());
    roadmap.extend(ground, ends.to_vec(), &())?;
    let mut rest = contacts;
    while !rest.is_empty() {
        let (next, after) = rest.split_at((roadmap.contact_count() / 8).max(8).min(rest.len()));
        roadmap.extend(ground, next.to_vec(), &())?;
        if roadmap.hops_to(1)[0].is_some() {
            return Ok(Some((roadmap.contact_count(), began.elapsed().as_secs_f64())));
        }
        rest = after;
    }
    Ok(None)
}
