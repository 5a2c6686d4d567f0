//! Members of the groups that are made from a region: bodies, active rows and touching features. They are listed once for
//! all groups, as there may be as many groups as bodies.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::contacts::pulls::Pull;
use crate::rigid::contacts::rows::ActiveRow;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::region::touching::Region;
use halfgap_collision::BodyId;

/// Pairs of a group's root, which is a place in the region, and an index, both ascending.
type ByRoot = Vec<(usize, usize)>;

/// The members of all groups that are made of a region.
#[derive(Clone, Debug, Default)]
pub(crate) struct Members {
    places: ByRoot,
    active: ByRoot,
    touches: ByRoot,
    held: ByRoot,
    pulled: ByRoot,
}

impl Members {
    /// Lists all members, given the root of each place.
    pub(super) fn list(
        &mut self,
        region: &Region,
        settling: &Settling,
        mut root: impl FnMut(usize) -> usize,
    ) {
        self.places.clear();
        self.places.extend((0..region.bodies().len()).map(|place| (root(place), place)));
        let places = &self.places;
        // A row or touch belongs to the group of the first of its bodies that moves.
        let place_of = |body: BodyId| region.place(body).map(|place| places[place].0);
        self.active.clear();
        let active = settling.active().iter().enumerate();
        let of_row = |row: &ActiveRow| row.all_bodies().find_map(place_of);
        self.active.extend(active.filter_map(|(index, (_, row))| Some((of_row(row)?, index))));
        self.touches.clear();
        let touches = region.touches().iter().enumerate();
        let of_touch = |touch: &Touch| touch.bodies.into_iter().find_map(place_of);
        self.touches.extend(touches.filter_map(|(index, touch)| Some((of_touch(touch)?, index))));
        self.held.clear();
        let held = settling.held().iter().enumerate();
        self.held.extend(held.filter_map(|(index, row)| Some((of_row(row)?, index))));
        self.pulled.clear();
        let pulled = settling.pulled().iter().enumerate();
        let of_pull = |pull: &Pull| pull.bodies.into_iter().find_map(place_of);
        self.pulled.extend(pulled.filter_map(|(index, pull)| Some((of_pull(pull)?, index))));
        let Self { places, active, touches, held, pulled } = self;
        for list in [places, active, touches, held, pulled] {
            list.sort_unstable();
        }
    }

    /// Places in the region of the bodies of a group.
    pub(super) fn places(&self, root: usize) -> impl Iterator<Item = usize> {
        of_root(&self.places, root)
    }

    /// The active rows of a group, and those that hold a coordinate.
    pub(super) fn active(&self, settling: &Settling, root: usize) -> impl Iterator<Item = ActiveRow> + Clone {
        let held = of_root(&self.held, root).map(|index| settling.held()[index]);
        of_root(&self.active, root).map(|index| settling.active()[index].1).chain(held)
    }

    /// What pulls with all its force on a group.
    pub(super) fn pulled(&self, settling: &Settling, root: usize) -> impl Iterator<Item = Pull> {
        of_root(&self.pulled, root).map(|index| settling.pulled()[index])
    }

    /// Indices of the touches of a group's bodies.
    pub(super) fn touches(&self, root: usize) -> impl Iterator<Item = usize> {
        of_root(&self.touches, root)
    }
}

fn of_root(list: &[(usize, usize)], root: usize) -> impl Iterator<Item = usize> + Clone {
    let from = list.partition_point(|&(of, _)| of < root);
    list[from..].iter().take_while(move |&&(of, _)| of == root).map(|&(_, index)| index)
}
