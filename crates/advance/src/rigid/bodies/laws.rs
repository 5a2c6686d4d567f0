//! The force laws of a system and the bodies that each acts on.

use crate::rigid::bodies::by_body::ByBody;
use crate::rigid::bodies::law::{ForceLaw, Snapshot};
use halfgap_collision::BodyId;
use std::sync::Arc;

/// All force laws; a law is named by its place among them.
#[derive(Clone, Debug)]
pub(crate) struct Laws {
    pub(crate) all: Vec<Arc<dyn ForceLaw>>,
    /// Indices of the laws that act on each body.
    of: ByBody<usize>,
    /// Whether each law has a potential.
    pub(crate) has_potential: Vec<bool>,
}

impl Laws {
    /// Lists the laws of a number of bodies; a snapshot at any time tells which laws have a potential.
    pub(crate) fn new(all: Vec<Arc<dyn ForceLaw>>, body_count: usize, snapshot: &Snapshot<'_>) -> Self {
        Self {
            of: ByBody::new(body_count, all.iter().map(|law| law.bodies()).enumerate()),
            has_potential: all.iter().map(|law| law.potential(snapshot).is_some()).collect(),
            all,
        }
    }

    /// Indices of the laws that act on a body.
    pub(crate) fn of(&self, body: BodyId) -> &[usize] {
        self.of.of(body)
    }

    /// Lists in `laws` the indices of the laws that act on any of some bodies, each once, ascending.
    pub(crate) fn list(&self, bodies: &[BodyId], laws: &mut Vec<usize>) {
        laws.clear();
        laws.extend(bodies.iter().flat_map(|&body| self.of(body)));
        laws.sort_unstable();
        laws.dedup();
    }
}
