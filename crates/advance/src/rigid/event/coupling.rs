//! Which places of a region share their steps: active rows, force laws and contacts without force couple them.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::forest::Forest;
use crate::rigid::region::touching::Region;
use halfgap_collision::BodyId;

/// Buffers for the sets of places that share their steps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coupling {
    /// Places of a region, in sets that share their steps.
    sets: Forest,
    /// True for places that need an integrator.
    integrated: Vec<bool>,
}

impl Coupling {
    fn reset(&mut self, count: usize) {
        self.sets.reset(count);
        self.integrated.clear();
        self.integrated.resize(count, false);
    }

    /// The least place of the set of a place.
    pub(super) fn root(&mut self, place: usize) -> usize {
        self.sets.root(place)
    }

    /// True for a place that leads a set which needs an integrator.
    pub(super) fn leads_group(&mut self, place: usize) -> bool {
        self.integrated[place] && self.sets.root(place) == place
    }

    fn join(&mut self, places: impl Iterator<Item = usize>) {
        let mut first = None;
        for place in places {
            self.integrated[place] = true;
            let first = *first.get_or_insert(place);
            self.sets.join(first, place);
        }
    }
}

/// Joins the places of a region that share their steps.
pub(crate) fn couple(
    assembly: &Assembly,
    connectors: &Connectors,
    coupling: &mut Coupling,
    region: &Region,
    settling: &Settling,
) {
    let count = region.bodies().len();
    coupling.reset(count);
    for (_, row) in settling.active() {
        coupling.join(row.all_bodies().filter_map(|body| region.place(body)));
    }
    let held = settling.held().iter().map(|row| row.bodies);
    for bodies in held.chain(settling.pulled().iter().map(|pull| pull.bodies)) {
        coupling.join(bodies.into_iter().filter_map(|body| region.place(body)));
    }
    for &body in region.bodies() {
        for &law in assembly.force_laws().of(body) {
            let named = assembly.force_laws().all[law].bodies();
            coupling.join(named.iter().filter_map(|&body| region.place(body)));
        }
    }
    for place in 0..count {
        for &id in connectors.of(region.bodies()[place]) {
            // A group watches when a stop is met.
            if connectors.connector(id).is_stop() {
                let bodies = connectors.connector(id).bodies();
                coupling.join(bodies.into_iter().filter_map(|body| region.place(body)));
            }
        }
    }
    couple_touching(assembly, coupling, region, settling);
    // A set is integrated if any of its places is.
    for place in 0..count {
        if coupling.integrated[place] {
            let root = coupling.root(place);
            coupling.integrated[root] = true;
        }
    }
}

/// Joins bodies that touch without force, neither closing nor opening, if they are integrated or one of them turns or is moved:
/// a group watches such a contact from step to step, where the search would go on in steps as short as the contact
/// takes to sink by next to nothing.
fn couple_touching(assembly: &Assembly, coupling: &mut Coupling, region: &Region, settling: &Settling) {
    if assembly.settings().impulse_step.is_some() {
        return;
    }
    let rest = assembly.rest_speed();
    for (&touch, gap) in region.touches().iter().zip(region.motions()) {
        if !gap.rests(rest) || settling.is_active(touch) {
            continue;
        }
        let mut places = touch.bodies.into_iter().filter_map(|body| region.place(body));
        let are_integrated = places.all(|place| coupling.integrated[place]);
        let varies = |&body: &BodyId| assembly.turns_about(body) || assembly.is_moved(body);
        if are_integrated || touch.bodies.iter().any(varies) {
            coupling.join(touch.bodies.into_iter().filter_map(|body| region.place(body)));
        }
    }
}
