//! What moves: a body with its segment (`flyer`), its motion along it (`path`), what predictions read of that
//! (`lane`), and what a force law is (`law`). Nothing here knows other bodies.

pub(super) mod flyer;
pub(super) mod lane;
pub(super) mod law;
pub(super) mod path;
