//! A pool that keeps equal shapes in memory once, so that data shared by many bodies stays in the cache.

use crate::shape::Shape;
use std::collections::BTreeMap;

/// Pool of the different shapes passed to [`ShapePool::share`] so far.
#[derive(Clone, Debug, Default)]
pub struct ShapePool {
    /// Shapes by the number of their features and the bits of reach and area: few different shapes agree in these.
    by_size: BTreeMap<(usize, u64, u64), Vec<Shape>>,
}

impl ShapePool {
    /// Returns a shape passed before whose edges are exactly equal, else `shape` itself, which the pool then keeps.
    pub fn share(&mut self, shape: Shape) -> Shape {
        let size = (shape.features().len(), shape.reach().to_bits(), shape.mass_properties().area.to_bits());
        let alike = self.by_size.entry(size).or_default();
        if let Some(known) = alike.iter().find(|known| known.paths() == shape.paths()) {
            return known.clone();
        }
        alike.push(shape.clone());
        shape
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn equal_shapes_are_kept_once() {
        let mut pool = ShapePool::default();
        let disc = |radius| Shape::disc(radius).expect("a fine radius");
        let (first, again, other) = (pool.share(disc(0.5)), pool.share(disc(0.5)), pool.share(disc(0.6)));
        assert!(first.is_shared_with(&again));
        assert!(!first.is_shared_with(&other));
        let moved = pool.share(disc(0.5).translated(DVec2::new(0.1, 0.0)));
        assert!(!first.is_shared_with(&moved), "it lies elsewhere in its body");
    }
}
