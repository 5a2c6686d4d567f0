//! The force laws of a system and the bodies that each acts on.

use crate::rigid::bodies::by_body::ByBody;
use crate::rigid::bodies::force_law::{ForceLaw, Snapshot};
use halfgap_collision::BodyId;
use std::sync::Arc;

/// All force laws; a law is named by its place among them.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ForceLaws {
    #[cfg_attr(feature = "save", serde(skip))]
    pub(crate) all: Vec<Arc<dyn ForceLaw>>,
    /// Whether each law acts; one that was removed does not.
    is_on: Vec<bool>,
    /// Indices of the laws that act on each body.
    of: ByBody<usize>,
    /// Whether each law has a potential.
    pub(crate) has_potential: Vec<bool>,
    body_count: usize,
}

impl ForceLaws {
    /// Lists the laws of a number of bodies; a snapshot at any time tells which laws have a potential.
    pub(crate) fn new(all: Vec<Arc<dyn ForceLaw>>, body_count: usize, snapshot: &Snapshot<'_>) -> Self {
        Self {
            of: ByBody::new(body_count, all.iter().map(|law| law.bodies()).enumerate()),
            has_potential: all.iter().map(|law| law.potential(snapshot).is_some()).collect(),
            is_on: vec![true; all.len()],
            all,
            body_count,
        }
    }

    /// Adds a law that acts from now on.
    pub(crate) fn add(&mut self, law: Arc<dyn ForceLaw>, has_potential: bool) {
        self.has_potential.push(has_potential);
        self.is_on.push(true);
        self.all.push(law);
        self.list_by_body();
    }

    /// Removes a law: it keeps its index and its name, but acts no more.
    pub(crate) fn remove(&mut self, law: usize) {
        self.is_on[law] = false;
        self.list_by_body();
    }

    /// Number of laws, those that were removed and those that have yet to be put back after loading included.
    #[cfg(feature = "save")]
    pub(super) fn count(&self) -> usize {
        self.is_on.len()
    }

    /// True for a law that acts, false for one that was removed or is not there.
    pub(crate) fn is_on(&self, law: usize) -> bool {
        self.is_on.get(law).is_some_and(|&is_on| is_on)
    }

    fn list_by_body(&mut self) {
        let acting = self.all.iter().map(|law| law.bodies()).enumerate();
        self.of = ByBody::new(self.body_count, acting.filter(|&(index, _)| self.is_on[index]));
    }

    /// Indices of the laws that act on a body.
    pub(crate) fn of(&self, body: BodyId) -> &[usize] {
        self.of.of(body)
    }

    /// Lists in `laws` the indices of the laws that act on any of some bodies, each once, ascending.
    pub(crate) fn list(&self, bodies: &[BodyId], force_laws: &mut Vec<usize>) {
        force_laws.clear();
        force_laws.extend(bodies.iter().flat_map(|&body| self.of(body)));
        force_laws.sort_unstable();
        force_laws.dedup();
    }
}
