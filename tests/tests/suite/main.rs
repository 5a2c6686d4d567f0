//! Scenarios that cross the layers.

mod connectors_drift;
mod dependency_tree;
mod determinism;
mod estimate_error;
mod groups;
mod heaps;
mod impacts;
mod laws;
mod mirror;
mod parser_fuzz;
mod rail_corners;
mod rail_stops;
mod reference_failures;
mod reference_scenes;
mod region_steps;
mod release;
mod remedies;
mod rest;
mod saving;
mod slots_rods_ropes;
mod spline_rails;
mod stacks;
mod start;
mod steps;
mod tolerance_slope;
mod walls;
