//! Connectors or force laws by body, in two flat lists for all bodies: those that have none cost little memory.

use halfgap_collision::BodyId;

/// Lists of items, connectors or force laws, by body.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ByBody<T> {
    /// Index in `items` of the first item of each body, and behind them the end of the last.
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T: Copy + Ord> ByBody<T> {
    /// Lists for each of `count` bodies the items that name it, ascending and each once.
    pub(crate) fn new<L: AsRef<[BodyId]>>(count: usize, items: impl Iterator<Item = (T, L)>) -> Self {
        let mut named = Vec::new();
        for (item, bodies) in items {
            let movable = bodies.as_ref().iter().filter(|body| !body.is_world());
            named.extend(movable.map(|body| (body.index(), item)));
        }
        named.sort_unstable();
        named.dedup();
        let ends = (0..=count).map(|body| named.partition_point(|&(other, _)| other < body));
        let starts = ends.map(|end| u32::try_from(end).unwrap_or(u32::MAX)).collect();
        Self { starts, items: named.into_iter().map(|(_, item)| item).collect() }
    }

    /// Items that name a body, ascending.
    #[inline]
    pub(crate) fn of(&self, body: BodyId) -> &[T] {
        let range = self.starts[body.index()] as usize..self.starts[body.index() + 1] as usize;
        &self.items[range]
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn each_body_has_the_items_that_name_it() {
        let [first, second, third] =
            [&[BodyId(2), BodyId(0)][..], &[BodyId(2), BodyId(2), BodyId::WORLD], &[BodyId(3)]];
        let by_body = ByBody::new(5, [('c', third), ('a', first), ('b', second)].into_iter());
        let of = |body| by_body.of(BodyId(body)).to_vec();
        assert_eq!(
            [of(0), of(1), of(2), of(3), of(4)],
            [vec!['a'], vec![], vec!['a', 'b'], vec!['c'], vec![]]
        );
    }
}
