//! Disjoint sets of places, joined step by step (union-find with path halving).

/// Disjoint sets of the places from 0 on.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Forest {
    /// For each place another place of its set, itself at the root.
    parents: Vec<usize>,
}

impl Forest {
    /// Puts each of a number of places into a set of its own.
    pub(crate) fn reset(&mut self, count: usize) {
        self.parents.clear();
        self.parents.extend(0..count);
    }

    /// Root of a place's set: the least place of the set.
    pub(crate) fn root(&mut self, mut place: usize) -> usize {
        while self.parents[place] != place {
            self.parents[place] = self.parents[self.parents[place]];
            place = self.parents[place];
        }
        place
    }

    /// Joins the sets of two places; false if they are in one already.
    pub(crate) fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b)] = a.min(b);
        a != b
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn joined_places_have_the_least_of_them_as_their_root() {
        let mut forest = Forest::default();
        forest.reset(6);
        assert!(forest.join(4, 2) && forest.join(5, 4) && forest.join(1, 3));
        assert!(!forest.join(2, 5));
        assert_eq!([0, 1, 2, 3, 4, 5].map(|place| forest.root(place)), [0, 1, 2, 1, 2, 2]);
        forest.reset(2);
        assert_eq!(forest.root(1), 1);
    }
}
