//! Tests that run the command `chta`.

#[path = "../support/desk.rs"]
mod desk;
#[path = "../support/installed.rs"]
mod installed;
#[path = "../support/tower.rs"]
mod tower;

mod arena;
mod batch;
mod bends;
mod bounces;
mod cli_answers;
mod cli_bad_input;
mod cli_options;
mod command_steps;
mod documents;
mod drift;
mod effects;
mod escape;
mod exit_status;
mod footprint;
mod free_route;
mod free_studies;
mod gdal_docs;
#[cfg(feature = "gdal")]
mod gdal_feature;
mod gis;
mod guide;
mod hop_on_map;
#[cfg(unix)]
mod interrupt;
mod layer_costs;
mod legs_dem;
mod map_command;
mod map_layers;
mod map_starts;
mod maps_command;
mod measured_errors;
mod mesh_command;
mod mesh_inputs;
mod mesh_map;
mod mesh_plan;
mod missing_data;
mod objective;
mod opened;
mod outages;
mod picture_files;
#[cfg(unix)]
mod pipes;
mod propulsion;
mod real_terrain;
mod report;
mod same_answers;
mod schemas;
mod sentences;
mod setup;
mod shipped_scenarios;
mod simulate_command;
mod sites;
mod stance;
mod stated_maps;
mod studies;
mod success;
mod takeoff_speeds;
mod targets;
mod trade_compare;
mod trajectory;
mod travel;
mod trials_causes;
mod trials_parts;
mod verbose;
mod wrong_things;
mod zones_and_fan;
