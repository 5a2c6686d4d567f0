//! Names of bodies in a picture, where there is room for them: within the body, else beside it.
//!
//! A name never meets another, lies wholly on the part of the page that shows the world, and covers no other body: in a
//! crowd most bodies go without.

use super::scene::{Drawn, pose};
use super::svg::{Svg, TextStyle};
use super::view::{FOOT, HEAD, View};
use crate::names::short_names;
use crate::world::World;
use glam::DVec2;
use halfgap_collision::BodyState;
use halfgap_geometry::{Aabb, Shape};

/// Font size [px].
const SIZE: f64 = 12.0;
/// Largest length of a name; longer ones are shortened.
const LONGEST: usize = 24;
/// Space around a name [px].
const SPACE: f64 = 3.0;
/// Largest number of bodies of which each may get a name: among more there is little room, and looking for it takes a
/// time that grows with their square. Measured with discs in a square grid: of 400, 120 get names, in 1 ms; of 5,000,
/// 43 would, in 0.1 s, twice the time of the rest of the picture.
const MOST: usize = 400;
/// Height of the letters above the line on which they stand, as a fraction of the font size.
const ASCENT: f64 = 0.75;

/// A body on the page.
struct Placed<'a> {
    shape: &'a Shape,
    state: BodyState,
    /// Box on the page [px], y up.
    bounds: Aabb,
}

/// Draws the names of bodies, in their order, over all of them.
pub(super) fn draw_names(svg: &mut Svg, world: &World, bodies: &[Drawn], view: &View) {
    // A body without a name is not to be covered by that of another.
    let placed: Vec<_> = bodies.iter().map(|drawn| Placed::new(world, drawn, view)).collect();
    let names = short_names(bodies.iter().take(MOST).map(|drawn| world.name(drawn.body)), LONGEST);
    let page = Aabb {
        min: DVec2::new(SPACE, FOOT - view.page_height() + SPACE),
        max: DVec2::new(view.page_width() - SPACE, -HEAD - SPACE),
    };
    let style = TextStyle { size: SIZE, anchor: "middle", color: "#22272b" };
    let mut taken: Vec<Aabb> = Vec::new();
    let attributes = [
        ("paint-order", "stroke"),
        ("stroke", "#fdfdfb"),
        ("stroke-width", "2.5"),
        ("stroke-opacity", "0.8"),
    ];
    svg.open_group(&attributes);
    for (index, name) in names.iter().enumerate() {
        let half = 0.5 * DVec2::new(style.width_of(name), SIZE);
        let has_room = |center: &DVec2| {
            let room = Aabb { min: *center - half, max: *center + half };
            page.contains(&room)
                && !taken.iter().any(|other| other.overlaps(&room.grown(SPACE)))
                && is_clear(&placed, index, &room, view)
        };
        if let Some(center) = places(&placed[index], half, page).into_iter().find(has_room) {
            taken.push(Aabb { min: center - half, max: center + half });
            svg.text((center.x, -center.y + 0.5 * ASCENT * SIZE), style, name);
        }
    }
    svg.close_group();
}

impl<'a> Placed<'a> {
    fn new(world: &'a World, drawn: &Drawn, view: &View) -> Self {
        let shape = world.shape(drawn.body);
        let bounds = shape.bounds_at(&pose(&drawn.state));
        let [min, max] = [bounds.min, bounds.max].map(|corner| up(view.to_page(corner)));
        Self { shape, state: drawn.state, bounds: Aabb { min, max } }
    }

    /// True if a point of the page [px, y up] lies on the body.
    fn covers(&self, point: DVec2, view: &View) -> bool {
        let world_point = view.to_world((point.x, -point.y));
        self.shape.contains(pose(&self.state).point_to_body(world_point))
    }
}

/// Places for the middle of a name [px, y up] with half of its size, the best first: within the body clear of its
/// middle, where its centre of mass and its hand are, then around it.
fn places(body: &Placed<'_>, half: DVec2, page: Aabb) -> Vec<DVec2> {
    let shown = Aabb { min: body.bounds.min.max(page.min), max: body.bounds.max.min(page.max) };
    let (middle, size) = (shown.center(), shown.size());
    let aside = half + DVec2::splat(SPACE);
    let [below, just_below] = [0.25 * size.y, aside.y].map(|far| DVec2::new(0.0, far.max(aside.y)));
    let corner = 0.5 * size + aside;
    let away = |x: f64, y: f64| middle + DVec2::new(x * corner.x, y * corner.y);
    let within = [middle - below, middle + below, middle - just_below, middle + just_below, middle];
    let around = [away(0.0, 1.0), away(0.0, -1.0), away(1.0, 0.0), away(-1.0, 0.0)];
    within.into_iter().chain(around).collect()
}

/// True if a box [px, y up] lies wholly on its own body or wholly off it, and off all others, as far as 27 points, nine
/// in each of three lines, tell.
fn is_clear(placed: &[Placed<'_>], own: usize, room: &Aabb, view: &View) -> bool {
    let near = |body: &&Placed<'_>| body.bounds.overlaps(room);
    let mut others =
        placed.iter().enumerate().filter(|(index, _)| *index != own).map(|(_, body)| body).filter(near);
    let points = || {
        let parts = (0..=8).map(|part| f64::from(part) / 8.0);
        parts.flat_map(|x| [0.0, 0.5, 1.0].map(|y| room.min + room.size() * DVec2::new(x, y)))
    };
    let on_own = points().filter(|&point| placed[own].covers(point, view)).count();
    (on_own == 0 || on_own == points().count())
        && !others.any(|body| points().any(|point| body.covers(point, view)))
}

/// A point of the page with y up.
fn up((x, y): (f64, f64)) -> DVec2 {
    DVec2::new(x, -y)
}
