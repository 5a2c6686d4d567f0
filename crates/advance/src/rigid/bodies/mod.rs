//! The motion of single bodies: a body with its segment (`flyer`), its motion along the segment (`path`), the copy of
//! it that predictions read (`lane`), and the trait of force laws (`law`).

pub(super) mod assembly;
pub(super) mod by_body;
pub(super) mod flyer;
pub(super) mod instant;
pub(super) mod law;
pub(super) mod laws;
pub(super) mod path;
pub(super) mod squeezed;
