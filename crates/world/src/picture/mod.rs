//! Pictures of runs as SVG: the scene, energy over time, and the impacts on a time line.
//!
//! `svg` writes elements, `outline` turns the edges of a shape into path data (arcs stay arcs), `shown` chooses
//! the part of the world to show and `view` maps it to the page; `scene` (with forces as `arrows`, connectors as
//! `ties` and names as `labels`), `energy`, `events` and `probes` are one picture each, the last three on common `axes` with
//! round `ticks`.

mod arrows;
mod axes;
mod energy;
mod events;
mod labels;
mod outline;
mod probes;
mod scene;
mod shown;
mod svg;
mod ticks;
mod ties;
mod view;

pub use energy::energy_picture;
pub use events::events_picture;
pub use probes::probes_picture;
pub use scene::{ScenePictures, scene_picture};

/// Colours of the bodies, in turn.
const PALETTE: [&str; 8] =
    ["#3b6fb6", "#d9822b", "#3f9b6b", "#b5485d", "#7a5fb0", "#2a9db0", "#a8862f", "#5f6f52"];

/// The colour of the movable body at a place.
fn color(place: usize) -> &'static str {
    PALETTE[place % PALETTE.len()]
}
