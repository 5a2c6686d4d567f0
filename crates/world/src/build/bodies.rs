//! Look-up of the bodies of a scene by name.

use crate::scene::{BodyData, ForceData, Scene};
use halfgap_collision::BodyId;
use std::collections::BTreeMap;

/// A scene, and the ids of its bodies by name.
#[derive(Debug)]
pub(super) struct Bodies<'a> {
    pub(super) scene: &'a Scene,
    ids: BTreeMap<&'a str, BodyId>,
}

impl<'a> Bodies<'a> {
    pub(super) fn of(scene: &'a Scene) -> Self {
        let names = scene.bodies.iter().enumerate();
        let ids = names.map(|(index, body)| (body.name.as_str(), BodyId::from_index(index))).collect();
        Self { scene, ids }
    }

    /// Returns the body with a name, else the background; names have been checked before.
    pub(super) fn find(&self, name: &str) -> BodyId {
        self.ids.get(name).copied().unwrap_or(BodyId::WORLD)
    }

    /// Returns the data of the body with a name; `None` for the background.
    pub(super) fn data(&self, name: &str) -> Option<&'a BodyData> {
        self.scene.bodies.get(self.find(name).index())
    }

    /// Returns the bodies on which a law acts, in the order of the scene: those that it names, else all.
    pub(super) fn acted_on(
        &self,
        force: &ForceData,
    ) -> impl Iterator<Item = (BodyId, &'a BodyData)> + use<'a> {
        let mut ids: Vec<_> = match force.bodies() {
            Some(names) => names.iter().map(|name| self.find(name)).collect(),
            None => (0..self.scene.bodies.len()).map(BodyId::from_index).collect(),
        };
        ids.sort_unstable();
        ids.dedup();
        let scene = self.scene;
        ids.into_iter().filter_map(|id| Some((id, scene.bodies.get(id.index())?)))
    }
}
