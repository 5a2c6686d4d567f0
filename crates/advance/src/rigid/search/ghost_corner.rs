//! Corners that pass over each other where two surfaces are flush.
//!
//! A resting body has its target gap under it. A block on a fixed table and a cart beside it are both lifted by that,
//! so that the block, as it slides from the table onto the cart, has its corner at the very height of the cart's:
//! whether the two meet is for the last digit to say. Where the two edges that lead away from the corners are parallel,
//! or as nearly as contacts in the target zone may leave them, and one is to slide along the other, the corners do not
//! meet.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::pairs::PairId;
use crate::rigid::contacts::table::Mode;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::remedies::Remedy;
use crate::rigid::search::searching::Searching;
use crate::rigid::shares::{NEGLIGIBLE, SEVERAL};
use glam::DVec2;
use halfgap_collision::{BodyId, Collision, Moving};
use halfgap_geometry::{Edge, Feature, FeatureId};

/// Angle [rad] up to which edges are flush, whatever their lengths. Bodies that rest in a wide target zone may lie
/// askew by more: by the width of the zone at the other end of the shorter edge.
const PARALLEL: f64 = 1e-6;
/// Least length of edges that may be askew, as a multiple of half the zone's width: shorter ones are within it at any
/// angle.
const LONG: f64 = 24.0;

/// Pairs of features that pass each other, that of the lesser body first.
type Passing = [Option<[FeatureId; 2]>; 4];

/// A corner of a body in motion.
#[derive(Clone, Copy, Debug)]
struct Corner {
    id: FeatureId,
    /// The edges that end and start there.
    sides: [FeatureId; 2],
    /// Directions and lengths of these edges, if they are straight.
    straight: [Option<Straight>; 2],
    place: DVec2,
    velocity: DVec2,
}

/// A straight edge.
#[derive(Clone, Copy, Debug)]
struct Straight {
    /// Its direction along the outline.
    direction: DVec2,
    /// Its length [m].
    length: f64,
}

impl Searching<'_> {
    /// True if two features that fire are those of corners that pass over each other: the search skips these from now
    /// on.
    pub(crate) fn passes_over(&mut self, pair: PairId, features: [FeatureId; 2]) -> bool {
        if matches!(self.pairs.mode(pair, features), Some(Mode::Active | Mode::Idle | Mode::Passed)) {
            return false;
        }
        let bodies = self.pairs.bodies(pair);
        let Some(passing) = passing_features(self.assembly, bodies, features) else { return false };
        if !self.assembly.remedies().act(Remedy::GhostCorners) {
            return false;
        }
        for features in passing.into_iter().flatten() {
            self.pairs.set_mode(pair, features, Mode::Passed);
        }
        self.predict(pair);
        true
    }
}

/// True if the features of a record are those of corners that pass over each other.
pub(crate) fn is_ghost_corner(assembly: &Assembly, record: &Collision) -> bool {
    record.gap_state().is_colliding(assembly.rest_speed())
        && Touch::of(record)
            .is_some_and(|touch| passing_features(assembly, touch.bodies, touch.features).is_some())
        && assembly.remedies().act(Remedy::GhostCorners)
}

/// Pairs of features of two corners that pass over each other, where the given features are one of them; `None` if
/// there are no such corners.
fn passing_features(assembly: &Assembly, bodies: [BodyId; 2], features: [FeatureId; 2]) -> Option<Passing> {
    if bodies.iter().any(|&body| assembly.trajectory(body).disc().is_some()) {
        return None;
    }
    let corners = [0, 1].map(|side: usize| {
        let moving = assembly.trajectory(bodies[side]).moving_at(assembly.now());
        corners_at(assembly, bodies[side], &moving, features[side])
    });
    let firsts = corners[0].iter().flatten();
    let mut meetings =
        firsts.flat_map(|first| corners[1].iter().flatten().map(move |second| [first, second]));
    meetings.find_map(|[a, b]| {
        let flush = flush_sides(assembly, [a, b])?;
        // Where one body lies over the other already, only the corners are in each other's way.
        let is_ahead = flush[0] == flush[1];
        let [side_a, side_b] = [a.sides[1 - flush[0]], b.sides[1 - flush[1]]];
        let with_sides = [[a.id, side_b], [side_a, b.id], [side_a, side_b]];
        let with_sides = with_sides.map(|features| is_ahead.then_some(features));
        let passing = [Some([a.id, b.id]), with_sides[0], with_sides[1], with_sides[2]];
        passing.contains(&Some(features)).then_some(passing)
    })
}

/// The corner that a feature is, or those at the ends of the edge that it is.
fn corners_at(assembly: &Assembly, body: BodyId, moving: &Moving, feature: FeatureId) -> [Option<Corner>; 2] {
    let shape = &assembly.trajectory(body).body().shape;
    let corner = |id: FeatureId| {
        let sides = shape.sides_of(id)?;
        let Feature::Round(round) = shape.feature(id) else { return None };
        let place = moving.pose.point_to_world(round.center);
        let velocity = moving.velocity_at(place - moving.pose.position);
        let straight = |side: FeatureId| match shape.edge_of(side) {
            Edge::Line(line) => {
                let direction = moving.pose.vector_to_world(line.direction());
                Some(Straight { direction, length: line.length() })
            }
            Edge::Arc(_) => None,
        };
        Some(Corner { id, sides, straight: sides.map(straight), place, velocity })
    };
    match corner(feature) {
        Some(corner) => [Some(corner), None],
        None => shape.ends_of(feature).map(|end| end.and_then(corner)),
    }
}

/// For two corners that meet and pass over each other, the side of each that is flush with that of the other: 0 for
/// the edge that ends there, 1 for the edge that starts there. `None` if they do not pass.
fn flush_sides(assembly: &Assembly, [first, second]: [&Corner; 2]) -> Option<[usize; 2]> {
    let (gap, accuracy) =
        (assembly.settings().tolerances.target_gap, assembly.settings().tolerances.accuracy);
    let (offset, velocity) = (first.place - second.place, first.velocity - second.velocity);
    if offset.length_squared() > (SEVERAL * gap).powi(2) {
        return None;
    }
    let sides = [[0, 0], [1, 1], [0, 1], [1, 0]];
    sides.into_iter().find(|&[of_first, of_second]| {
        let [Some(edge_first), Some(edge_second)] = [first.straight[of_first], second.straight[of_second]]
        else {
            return false;
        };
        let [along_first, along_second] = [edge_first, edge_second].map(|edge| edge.direction);
        let shorter = edge_first.length.min(edge_second.length);
        let askew = if shorter >= LONG * accuracy { 2.0 * accuracy / shorter } else { 0.0 };
        let tilt = PARALLEL.max(askew);
        let angle = along_first.perp_dot(along_second).abs();
        let is_parallel = along_first.dot(along_second) < 0.0 && angle <= tilt;
        // Edges askew come as near as contacts do, which sink to the end of the zone, and no nearer.
        let lowest = if angle <= PARALLEL { -accuracy } else { gap - accuracy - assembly.sink() };
        // The inside of a body is on the left of its outline.
        let outward = -along_second.perp();
        let (height, rise) = (outward.dot(offset), outward.dot(velocity));
        // From a corner where the edge ends, the way along it is back.
        let inward = if of_second == 0 { -along_second } else { along_second };
        let way = inward.dot(velocity);
        let way = if of_first == of_second { way } else { way.abs() };
        is_parallel && rise.abs() <= NEGLIGIBLE.max(tilt) * way && (lowest..=gap).contains(&height)
    })
}
