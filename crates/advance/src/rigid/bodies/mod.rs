//! Bodies: their motions at the present time, the force laws that act on them, and every elementary query about them.
//!
//! **Invariant**: each trajectory is valid from its start to the present time; a fixed body moves only as prescribed; whole turns are
//! taken out of angles only where a flight starts. The room knows no contact and no connector; of groups it knows who
//! leads a body, and until when.
//!
//! `assembly`: all bodies, what others ask first · `trajectory`: one body and its segment · `path`: the motion along it ·
//! `thresholds`: what counts as rest, and as deep · `force_law`, `force_laws`, `by_body`: force laws and where they act · `squeezed`:
//! masses too different to be held together · `moved`: fixed bodies that are moved · `instant`: when two events are at one time · `saved`: bodies and force laws that were saved.

pub(super) mod assembly;
pub(super) mod by_body;
pub(super) mod force_law;
pub(super) mod force_laws;
pub(super) mod instant;
pub(super) mod moved;
pub(super) mod path;
#[cfg(feature = "save")]
mod saved;
pub(super) mod squeezed;
pub(super) mod thresholds;
pub(super) mod trajectory;
