//! What is remembered of the contacts of a pair of bodies from one step to the next.
//!
//! *Invariant*: two features have at most one contact, and no two contacts of a pair lie at one place.

use glam::DVec2;
use halfgap_collision::{Moving, Nearness, turned, visit_near_features};
use halfgap_geometry::{DirectionRange, Feature, FeatureId, GapSample, Pose, Shape};

/// Where a contact sticks.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum Hold {
    /// It slips, or carries no force.
    Slips,
    /// It sticks where it is next measured.
    Here,
    /// It sticks at this value [m] of the coordinate along the surface.
    At(f64),
}

/// Two features of a pair that are near each other.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Contact {
    /// Features of the two bodies, in the order of the pair.
    pub(super) features: [FeatureId; 2],
    /// Forces [N, N, N m] of the last step along the normal, along the surface, and against rolling.
    pub(super) forces: [f64; 3],
    /// It carried a force in the last step.
    pub(super) presses: bool,
    /// Callers know that it carries a force.
    pub(super) is_told: bool,
    /// Whether it sticks, and where.
    pub(super) hold: Hold,
    /// Angle [rad] of the normal with its whole turns.
    pub(super) normal_angle: f64,
    /// Speed [m/s] at which it touches at the end of the step, if that is an impact.
    pub(super) arrival: Option<f64>,
    /// It has a row in the present step.
    pub(super) is_listed: bool,
}

impl Contact {
    /// Forgets what it carried.
    pub(super) fn let_go(&mut self) {
        (self.forces, self.presses, self.hold, self.arrival) = ([0.0; 3], false, Hold::Slips, None);
        self.is_told = false;
    }

    fn new(features: [FeatureId; 2], normal: DVec2) -> Self {
        Self {
            features,
            forces: [0.0; 3],
            presses: false,
            is_told: false,
            hold: Hold::Slips,
            normal_angle: turned(normal, 0.0),
            arrival: None,
            is_listed: false,
        }
    }
}

/// A contact as it is found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    features: [FeatureId; 2],
    pub(super) sample: GapSample,
}

impl Found {
    /// The unit normal from the second body of the pair to the first.
    pub(super) fn normal(&self) -> DVec2 {
        if self.sample.primary_is_a { self.sample.normal } else { -self.sample.normal }
    }

    /// The place of the contact, between the points of both bodies [m].
    fn middle(&self) -> DVec2 {
        0.5 * (self.sample.point_primary + self.sample.point_normal)
    }
}

/// Directions of normals that differ by less than this sine belong to one place.
const ONE_PLACE: f64 = 0.1;

/// Finds the contacts of two bodies anew in `contacts`; those that go on keep what is remembered of them, and those that come
/// take it from the nearest that went, such as a disc that rolls from one edge to the next.
pub(super) fn find_contacts(
    [a, b]: [(&Shape, &Moving); 2],
    nearness: &Nearness,
    contacts: &mut Vec<Contact>,
    found: &mut Vec<Found>,
    gone: &mut Vec<Contact>,
) {
    found.clear();
    visit_near_features([a, b], nearness, &mut |features, sample| {
        found.push(Found { features, sample: *sample });
    });
    if found.len() > 1 {
        drop_doubles([a.0, b.0], found, nearness);
    }
    gone.clear();
    gone.append(contacts);
    // What overlaps more than is looked for is known from before.
    for old in gone.iter() {
        let [p, q] = [a.0.feature(old.features[0]), b.0.feature(old.features[1])];
        let sample = measure([a, b], old.features);
        let is_deep = |sample: &GapSample| {
            sample.gap < -nearness.depth
                && sample.overrun <= nearness.overrun
                && !has_left_arc(sample, [(p, &a.1.pose), (q, &b.1.pose)])
        };
        found.extend(sample.filter(is_deep).map(|sample| Found { features: old.features, sample }));
    }
    for Found { features, sample } in found.iter() {
        let old = gone.iter().position(|contact| contact.features == *features);
        contacts.push(match old {
            Some(place) => gone.swap_remove(place),
            None => Contact::new(*features, sample.normal),
        });
    }
    // What pressed and is gone has become the nearest of those that are new.
    for old in gone.iter_mut().filter(|old| old.presses) {
        let Some(place) =
            measure([a, b], old.features).map(|sample| Found { features: old.features, sample })
        else {
            continue;
        };
        let distance = |next: &Found| (next.middle() - place.middle()).length();
        let heirs = contacts.iter_mut().zip(found.iter()).filter(|(contact, next)| {
            !contact.presses
                && contact.arrival.is_none()
                && next.normal().dot(place.normal()) > 0.0
                && distance(next) <= nearness.reach
        });
        if let Some((heir, _)) =
            heirs.min_by(|(_, one), (_, other)| distance(one).total_cmp(&distance(other)))
        {
            let Contact { features, .. } = *heir;
            // The coordinate is another one: its value is set where it is next measured.
            let hold = if old.hold == Hold::Slips { Hold::Slips } else { Hold::Here };
            *heir = Contact { features, hold, ..*old };
            old.is_told = false;
        }
    }
}

/// Measures two features, however far apart they are; `None` if they have no normal.
pub(super) fn measure([a, b]: [(&Shape, &Moving); 2], features: [FeatureId; 2]) -> Option<GapSample> {
    let [p, q] = [a.0.feature(features[0]), b.0.feature(features[1])];
    GapSample::measure_unbounded(p, &a.1.pose, q, &b.1.pose)
}

/// Measures the contacts of two bodies where they are now; false if one has run off its features, so that they are to be found anew.
pub(super) fn measure_contacts(
    [a, b]: [(&Shape, &Moving); 2],
    overrun: f64,
    contacts: &[Contact],
    found: &mut Vec<Found>,
) -> bool {
    found.clear();
    contacts.iter().all(|contact| {
        let [p, q] = [a.0.feature(contact.features[0]), b.0.feature(contact.features[1])];
        let Some(sample) = measure([a, b], contact.features) else { return false };
        found.push(Found { features: contact.features, sample });
        sample.overrun <= overrun && !has_left_arc(&sample, [(p, &a.1.pose), (q, &b.1.pose)])
    })
}

/// True if a contact lies beyond the end of an arc; beyond the normal cone of a corner it goes on for a while.
fn has_left_arc(sample: &GapSample, sides: [(&Feature, &Pose); 2]) -> bool {
    let is_arc = |feature: &Feature| match feature {
        Feature::Round(round) => round.radius != 0.0 && round.range != DirectionRange::Full,
        Feature::Line(_) => false,
    };
    if !(is_arc(sides[0].0) || is_arc(sides[1].0)) {
        return false;
    }
    let mut sample = *sample;
    sample.find_excess(sides);
    sample.excess_primary > 0.0 || sample.excess_normal > 0.0
}

/// Drops what is found twice at one place, by a corner and by the edge beside it: what overlaps more stays, or the earlier; two corners go, since
/// where they lie on each other their normal is rounding.
fn drop_doubles([a, b]: [&Shape; 2], found: &mut Vec<Found>, nearness: &Nearness) {
    let are_corners = |found: &Found| {
        let [p, q] = [a.feature(found.features[0]), b.feature(found.features[1])];
        [p, q].into_iter().all(|feature| feature.radius() == Some(0.0))
    };
    let mut kept = 0;
    for next in 0..found.len() {
        let own = found[next];
        let double = (0..kept).find(|&place| {
            let other = &found[place];
            let (p, q) = (own.normal(), other.normal());
            let near = own.sample.gap.abs().max(other.sample.gap.abs()) + nearness.overrun;
            p.dot(q) > 0.0
                && p.perp_dot(q).abs() < ONE_PLACE
                && (own.middle() - other.middle()).length() <= near
        });
        match double {
            Some(other) => {
                let sharp = [&own, &found[other]].map(are_corners);
                let is_better = own.sample.gap < found[other].sample.gap;
                if sharp[1] && !sharp[0] || sharp[0] == sharp[1] && is_better {
                    found[other] = own;
                }
            }
            None => {
                found[kept] = own;
                kept += 1;
            }
        }
    }
    found.truncate(kept);
}
