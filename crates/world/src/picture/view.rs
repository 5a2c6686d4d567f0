//! The part of the world that a picture shows, and its place on the page.

use glam::DVec2;
use halfgap_geometry::Aabb;

/// Least size of the box shown, as a fraction of its distance from the origin: smaller ones are lost in rounding.
const LEAST_SIZE: f64 = 1e-9;

/// Longer side of the part of the page that shows the world [px].
const LONG_SIDE: f64 = 800.0;
/// Least length of the shorter side of that part [px].
const SHORT_SIDE: f64 = 240.0;
/// Margin around that part [px].
const MARGIN: f64 = 20.0;
/// Height of the room for the title [px].
pub(super) const HEAD: f64 = 56.0;
/// Height of the room for the scale bar [px].
pub(super) const FOOT: f64 = 44.0;

/// A map from the world to the page.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    center: DVec2,
    scale: f64,
    width: f64,
    height: f64,
}

impl View {
    /// Makes the view that shows a box of the world; a box without size or limits is replaced by one that has them.
    pub(super) fn of_box(shown: Option<Aabb>) -> Self {
        let usable =
            |bounds: &Aabb| bounds.min.is_finite() && bounds.max.is_finite() && bounds.size().is_finite();
        let shown = shown.filter(usable).unwrap_or(Aabb::around(DVec2::ZERO));
        let center = 0.5 * shown.min + 0.5 * shown.max;
        // A point, or coordinates so large that the size is lost in their rounding.
        let least = (LEAST_SIZE * center.abs().max_element()).max(f64::MIN_POSITIVE.sqrt());
        let size = shown.size().max(DVec2::splat(least));
        let scale = LONG_SIDE / size.max_element();
        let inner = (size * scale).max(DVec2::splat(SHORT_SIDE));
        Self { center, scale, width: inner.x + 2.0 * MARGIN, height: inner.y + 2.0 * MARGIN }
    }

    /// Pixels per metre.
    pub(super) fn scale(self) -> f64 {
        self.scale
    }

    /// Width of the page [px].
    pub(super) fn page_width(self) -> f64 {
        self.width
    }

    /// Height of the page [px].
    pub(super) fn page_height(self) -> f64 {
        HEAD + self.height + FOOT
    }

    /// Returns the point of the world [m] at a position on the page [px].
    pub(super) fn to_world(self, (x, y): (f64, f64)) -> DVec2 {
        let offset = DVec2::new(x - 0.5 * self.width, HEAD + 0.5 * self.height - y);
        self.center + offset / self.scale
    }

    /// Returns the position on the page [px] of a point of the world [m].
    pub(super) fn to_page(self, point: DVec2) -> (f64, f64) {
        let offset = (point - self.center) * self.scale;
        (0.5 * self.width + offset.x, HEAD + 0.5 * self.height - offset.y)
    }
}
