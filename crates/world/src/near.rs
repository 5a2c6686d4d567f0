//! Which bodies are near each other, and may collide.

use halfgap_collision::{BodyId, BroadPhase};
use halfgap_geometry::Aabb;

/// Finds pairs of bodies that are near each other, and keeps its room for the next time.
#[derive(Clone, Debug, Default)]
pub(crate) struct NearPairs {
    broad: BroadPhase,
    fixed: Vec<bool>,
    near: Vec<BodyId>,
    pairs: Vec<(BodyId, BodyId)>,
}

impl NearPairs {
    /// Pairs of bodies whose boxes overlap, sorted; not those of two fixed bodies, nor those that pass through each other. For
    /// each body its box, and whether it is fixed.
    pub(crate) fn find(
        &mut self,
        boxes: impl Iterator<Item = (Aabb, bool)>,
        excluded: &[(BodyId, BodyId)],
    ) -> &[(BodyId, BodyId)] {
        let Self { broad, fixed, near, pairs } = self;
        broad.clear();
        fixed.clear();
        pairs.clear();
        for (index, (bounds, is_fixed)) in boxes.enumerate() {
            let body = BodyId(u32::try_from(index).unwrap_or(u32::MAX));
            fixed.push(is_fixed);
            broad.find_overlapping(&bounds, near);
            for &other in &*near {
                let both_fixed = is_fixed && fixed[other.index()];
                let passes =
                    excluded.iter().any(|&(a, b)| (a, b) == (other, body) || (a, b) == (body, other));
                if !both_fixed && !passes {
                    pairs.push((other, body));
                }
            }
            broad.set(body, bounds);
        }
        pairs.sort_unstable();
        pairs
    }
}
