//! Merging of records: where two detectors find one spot, the more exact record stays.

use crate::march::direction_rounding;
use crate::record::{Collision, Detector};
use std::cmp::Ordering;

/// Sine of the angle between two normals [-] below which they count as one: far more than rounding, far less than the
/// turn at a corner.
const PARALLEL: f64 = 1e-6;

/// Sine of the angle between two normals [-] below which they count as one if one of the contacts lies beyond its edge.
const OVERHANG: f64 = 0.1;

/// Angle by which the normal of two corners may differ from another, in multiples of its rounding [-].
const UNKNOWN_SHARE: f64 = 4.0;

/// Distance outside of its features at which a contact counts as within, as a fraction of the accuracy [-].
const HAIR: f64 = 1.0 / 64.0;

/// True if two records describe one physical collision: the same two bodies touch at one place along one
/// normal. A row of a connector is never the same as another record.
///
/// Places within `distance_tol` of each other count as one: they cannot be told apart.
#[must_use]
pub fn is_same_collision(a: &Collision, b: &Collision) -> bool {
    let bodies = |c: &Collision| {
        let [p, n] = c.bodies();
        (p.min(n), p.max(n))
    };
    if a.connector().is_some() || b.connector().is_some() {
        return false;
    }
    if bodies(a) != bodies(b) || a.parties.bilateral != b.parties.bilateral {
        return false;
    }
    let swapped = a.parties.primary.body != b.parties.primary.body;
    let normal_b = if swapped { -b.geometry.normal } else { b.geometry.normal };
    let normal_a = a.geometry.normal;
    let middle = |c: &Collision| 0.5 * (c.geometry.point_primary + c.geometry.point_normal);
    let apart = (middle(a) - middle(b)).length();
    let sine = PARALLEL.max(lean(a, b)).max(overhang(a, b, apart)).max(unknown(a)).max(unknown(b));
    let parallel = normal_a.dot(normal_b) > 0.0 && normal_a.perp_dot(normal_b).abs() < sine;
    let near = a.tolerances.distance_tol().max(b.tolerances.distance_tol());
    parallel && apart <= near
}

/// Sine [-] of the angle that is allowed between the normals of two records within the accuracy of each other, exactly
/// one of which lies beyond its edge; else 0.
fn overhang(a: &Collision, b: &Collision, apart: f64) -> f64 {
    let is_one_beyond = (beyond(a) > 0.0) != (beyond(b) > 0.0);
    let is_near = apart <= a.tolerances.accuracy.max(b.tolerances.accuracy);
    if is_one_beyond && is_near { OVERHANG } else { 0.0 }
}

/// Angle [rad] that is allowed for the rounding of the normal of two corners, which is the direction between them as a
/// search found it and as it is measured now; 0 for other records.
fn unknown(record: &Collision) -> f64 {
    if record.parties.detector != Detector::CornerCorner {
        return 0.0;
    }
    let [a, b] = [record.geometry.point_primary, record.geometry.point_normal];
    UNKNOWN_SHARE * direction_rounding(a, b)
}

/// Angle [rad] that is allowed between the normals of one spot found on both sides of a seam. Times the least radius of
/// the arcs it is twice the accuracy, the distance by which detection lets a contact lie outside of its feature.
fn lean(a: &Collision, b: &Collision) -> f64 {
    let radii = [a, b].map(|c| [c.geometry.radius_primary, c.geometry.radius_normal]);
    let curved = radii.into_iter().flatten().flatten().map(f64::abs).filter(|&radius| radius > 0.0);
    2.0 * a.tolerances.accuracy.max(b.tolerances.accuracy) / curved.fold(f64::INFINITY, f64::min)
}

/// Drops records of the same physical collision as a more exact one ([`is_same_collision`]): the one within its edges
/// wins, then edge-edge over vertex-edge over corner-corner, then the lesser distance, then the earlier place in the
/// list. Keeps the order. What must be handled still must be, by whichever record.
pub fn merge_collisions(records: &mut Vec<Collision>) {
    let mut kept = 0;
    for index in 0..records.len() {
        let candidate = records[index];
        match records[..kept].iter().position(|other| is_same_collision(other, &candidate)) {
            None => {
                records[kept] = candidate;
                kept += 1;
            }
            Some(place) => {
                let must_handle = records[place].must_handle || candidate.must_handle;
                if is_better(&candidate, &records[place]) {
                    records[place] = candidate;
                }
                records[place].must_handle = must_handle;
            }
        }
    }
    records.truncate(kept);
}

/// Distance [m] by which a contact lies outside of its features; 0 if it is at most [`HAIR`] of the accuracy, which may
/// be rounding. The normal of two corners that lie on each other is all rounding: they must not win by a hair.
fn beyond(record: &Collision) -> f64 {
    let outside = record.geometry.outside;
    if outside > HAIR * record.tolerances.accuracy { outside } else { 0.0 }
}

fn is_better(candidate: &Collision, other: &Collision) -> bool {
    let by_place = beyond(other).total_cmp(&beyond(candidate));
    let by_detector = candidate.parties.detector.cmp(&other.parties.detector);
    let by_distance = other.geometry.distance.total_cmp(&candidate.geometry.distance);
    by_place.then(by_detector).then(by_distance) == Ordering::Greater
}
