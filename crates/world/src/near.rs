//! Pairs of bodies whose boxes overlap, found from the boxes alone, without the memory of the advance.

use halfgap_collision::BodyId;
use halfgap_geometry::Aabb;

/// Finds pairs of bodies that are near each other; reuses its buffers.
#[derive(Clone, Debug, Default)]
pub(crate) struct NearPairs {
    boxes: Vec<Boxed>,
    excluded: Vec<(BodyId, BodyId)>,
    pairs: Vec<(BodyId, BodyId)>,
}

/// A body and its box, with the extent of the box along the axis of the sweep [m].
#[derive(Clone, Copy, Debug)]
struct Boxed {
    from: f64,
    to: f64,
    bounds: Aabb,
    body: BodyId,
    is_fixed: bool,
}

impl NearPairs {
    /// Returns the pairs of bodies whose boxes overlap, sorted, without pairs of two fixed bodies and without the
    /// excluded ones. `boxes` gives for each body its box, and whether it is fixed.
    ///
    /// A sweep along the longer side of the scene: D. Baraff, "Dynamic simulation of non-penetrating rigid
    /// bodies", thesis, Cornell University 1992, 8.2.
    pub(crate) fn find(
        &mut self,
        boxes: impl Iterator<Item = (Aabb, bool)>,
        excluded: &[(BodyId, BodyId)],
    ) -> &[(BodyId, BodyId)] {
        self.excluded.clear();
        self.excluded.extend(excluded.iter().map(|&(a, b)| (a.min(b), a.max(b))));
        self.excluded.sort_unstable();
        self.list(boxes);
        self.pairs.clear();
        for (place, own) in self.boxes.iter().enumerate() {
            let others = &self.boxes[place + 1..];
            for other in others.iter().take_while(|other| other.from <= own.to) {
                let pair = (own.body.min(other.body), own.body.max(other.body));
                if own.bounds.overlaps(&other.bounds)
                    && !(own.is_fixed && other.is_fixed)
                    && self.excluded.binary_search(&pair).is_err()
                {
                    self.pairs.push(pair);
                }
            }
        }
        self.pairs.sort_unstable();
        &self.pairs
    }

    /// Lists the boxes in the order of the sweep.
    fn list(&mut self, boxes: impl Iterator<Item = (Aabb, bool)>) {
        self.boxes.clear();
        self.boxes.extend((0..).zip(boxes).map(|(index, (bounds, is_fixed))| Boxed {
            from: bounds.min.x,
            to: bounds.max.x,
            bounds,
            body: BodyId(index),
            is_fixed,
        }));
        let Some(around) = self.boxes.iter().map(|own| own.bounds).reduce(|a, b| a.union(b)) else { return };
        if around.size().y > around.size().x {
            for own in &mut self.boxes {
                (own.from, own.to) = (own.bounds.min.y, own.bounds.max.y);
            }
        }
        self.boxes.sort_unstable_by(|a, b| a.from.total_cmp(&b.from));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use proptest::prelude::*;

    /// Boxes of many sizes, most of them small, some of them fixed.
    fn boxes() -> impl Strategy<Value = Vec<(Aabb, bool)>> {
        let place = prop::array::uniform2(-4.0..4.0).prop_map(DVec2::from);
        let one = (place, -6.0f64..2.0, prop::bool::weighted(0.2));
        prop::collection::vec(
            one.prop_map(|(at, size, fixed)| (Aabb::around_disc(at, size.exp2()), fixed)),
            0..40,
        )
    }

    proptest! {
        #[test]
        fn the_sweep_finds_what_is_found_one_by_one(
            boxes in boxes(),
            stretch in (0.1..10.0, 0.1..10.0).prop_map(|(x, y)| DVec2::new(x, y)),
            excluded in prop::collection::vec((0u32..40, 0u32..40), 0..20),
        ) {
            let boxes: Vec<_> = boxes
                .into_iter()
                .map(|(own, fixed)| (Aabb { min: own.min * stretch, max: own.max * stretch }, fixed))
                .collect();
            let excluded: Vec<_> = excluded.into_iter().map(|(a, b)| (BodyId(a), BodyId(b))).collect();
            let mut expected = Vec::new();
            for (b, second) in (0..).zip(&boxes) {
                for (a, first) in (0..b).zip(&boxes) {
                    let pair = (BodyId(a), BodyId(b));
                    let passes = excluded.contains(&pair) || excluded.contains(&(pair.1, pair.0));
                    if first.0.overlaps(&second.0) && !(first.1 && second.1) && !passes {
                        expected.push(pair);
                    }
                }
            }
            expected.sort_unstable();
            let mut near = NearPairs::default();
            // The second search must not see anything of the first.
            for _ in 0..2 {
                prop_assert_eq!(near.find(boxes.iter().copied(), &excluded), expected.as_slice());
            }
        }
    }
}
