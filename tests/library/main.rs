//! Tests of the library that need neither the command nor a process of their own.

#[path = "../support/installed.rs"]
mod installed;
#[path = "../support/mod.rs"]
mod support;
#[path = "../support/tiff.rs"]
mod tiff;
#[path = "../support/tower.rs"]
mod tower;

mod arena_flight;
mod arena_paper;
mod arena_planners;
mod ballistic_paper;
mod ballistics_conflicts;
mod ballistics_precision;
mod ballistics_sampling;
mod bends;
mod beside_line;
mod box_flight;
mod braked;
mod chain_csv_problems;
mod chain_csv_round_trip;
mod citation;
mod clearance;
mod columns_table;
mod command_steps;
mod docs_commands;
mod drift;
mod execute;
mod fly;
mod footprint;
mod formats_table;
mod free_route;
mod free_route_objectives;
mod graph;
mod heading_steps;
mod layers;
mod legs_joints;
mod legs_scenes;
mod map_equality;
mod map_layers;
mod map_nodes;
mod map_objectives;
mod map_projection;
mod map_replan;
mod map_slices;
mod map_sources;
mod map_verified;
mod map_world;
mod margins;
mod mended;
mod mesh_ball;
mod mesh_degenerate;
#[cfg(feature = "plot")]
mod mesh_figure;
mod mesh_flight;
mod mesh_routes;
mod mesh_slices;
mod mesh_verified;
mod mesh_windows;
mod mutations;
mod mutations_chain_csv;
mod mutations_mesh;
mod mutations_overlays;
mod mutations_scenario;
mod mutations_terrain;
mod new_limit;
#[cfg(feature = "plot")]
mod page;
mod paper;
mod pds3;
mod planner;
mod progress;
mod proof;
mod proof_terrain;
mod robot_file;
mod robot_model;
mod scenario_round_trip;
mod schemas;
mod segment_hops;
mod sidecars;
mod slice_file;
mod sound_files;
mod stance_cones;
mod stance_pushes;
mod sweep;
mod takeoff_speeds;
mod targets;
mod terrain_files;
mod terrain_read_once;
mod timetable;
mod true_north;
mod truncations;
mod voids;
