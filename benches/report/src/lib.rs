//! Speed against error: halfgap and its peers on scenes whose answers are known.
//!
//! `scene` is the neutral description, `on_joint` what acts on joints in it, `scene_file` the same as JSON,
//! `scenes` a file each, `reference` how answers are computed independently of every engine, `engines` a file
//! each, `measure` one run, `sweep` all of them, `csv` the table of runs, `levels` the times per level of error, `plot` the pictures, `gas` impacts per second. The
//! bench `speed_vs_error` drives it:
//!
//! ```text
//! cargo bench -p halfgap-report --bench speed_vs_error -- [--quick] [--only NAME]... [--engine NAME]
//! ```

#![forbid(unsafe_code)]

pub mod csv;
pub mod engines;
pub mod gas;
pub mod levels;
pub mod measure;
pub mod on_joint;
pub mod pile_runs;
pub mod plot;
mod reference;
pub mod scene;
pub mod scene_file;
pub mod scenes;
pub mod sweep;
