//! Lists the rows of a step: contacts that bodies may make within it, and connectors.

use crate::rigid::RowForce;
use crate::stepping::bodies::{Bodies, Motion3, farthest};
use crate::stepping::contacts::{Contact, Found, Hold, find_contacts, measure, measure_contacts};
use crate::stepping::facing::side;
use crate::stepping::pairs::{Pair, Pairs};
use crate::stepping::passing::FAST;
use crate::stepping::rows::{Lengths, Line, Roll, Row, Rows, Slip, Source};
use crate::stepping::sleep::Sleep;
use crate::stepping::ties::Ties;
use halfgap_collision::{
    BodyId, GapKinematics, Nearness, TangentRow, Touch, rolling_radius, turned, visit_near_features,
};
use halfgap_geometry::{GapKind, GapSample};

/// Angle [rad] by which a body, or a normal, may turn in a step so that gaps are predicted to second order: beyond it the terms of
/// that order are larger than what they correct, and what spins would spin faster and faster.
const STRAIGHT: f64 = 0.5;

/// Coefficients of the relative turning of two bodies.
const TURNING: [f64; 6] = [0.0, 0.0, 1.0, 0.0, 0.0, -1.0];

/// Distance beyond the ways of a step up to which contacts are found, as a fraction of the smaller reach [-]: in so many steps more
/// they are only measured.
const MARGIN: f64 = 0.05;
/// Overlap that is looked for, as a multiple of the deepest of a pair in the last step [-]: other features may overlap a little more.
const DEEPER: f64 = 1.5;

/// Overlap that is looked for at most, as a fraction of the lesser thickness [-]: nobody knows to which side bodies belong that are deeper in
/// each other, but by what is known from before. Without a bound, a corner beside a thin wall is taken for one behind its far side.
const DEEPEST: f64 = 0.3;

/// What the listing works with.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Listing {
    /// Bound on the way [m] of each body in the step.
    ways: Vec<f64>,
    #[cfg_attr(feature = "save", serde(skip))]
    found: Vec<Found>,
    gone: Vec<Contact>,
    /// Contacts that end because they have no row in the step, with their last forces.
    pub(super) ended: Vec<RowForce>,
    /// Whether each pair has been listed in the step.
    listed: Vec<bool>,
}

impl Listing {
    /// Lists the rows of a step in `rows`. Bodies set out with velocities `free`, those without contacts in the step.
    pub(super) fn list(
        &mut self,
        bodies: &Bodies,
        (pairs, ties, sleep): (Option<&mut Pairs>, &mut Ties, &mut Sleep),
        free: &[Motion3],
        lengths: Lengths,
        rows: &mut Rows,
    ) {
        rows.clear();
        self.ended.clear();
        ties.follow(bodies);
        let Some(pairs) = pairs else {
            ties.list(bodies, |place| sleep.is_asleep(place), lengths, rows);
            return;
        };
        self.ways.clear();
        self.ways.extend(
            bodies
                .natures
                .iter()
                .zip(free)
                .map(|(nature, &free)| lengths.span * farthest(nature.reach, free)),
        );
        for place in (0..bodies.count()).filter(|&place| !sleep.is_asleep(place)) {
            let motion = free[place].map(|velocity| lengths.span * velocity);
            pairs.cover(bodies, BodyId::from_index(place), motion, lengths.span * lengths.fall);
        }
        self.listed.clear();
        self.listed.resize(pairs.all().len(), false);
        // What is woken has pairs that were passed over.
        while self.list_contacts(bodies, (pairs, ties, sleep), free, lengths, rows) {}
        ties.list(bodies, |place| sleep.is_asleep(place), lengths, rows);
    }

    /// Lists the contacts of bodies that are awake and have not been listed. True if bodies were woken.
    fn list_contacts(
        &mut self,
        bodies: &Bodies,
        (pairs, ties, sleep): (&mut Pairs, &Ties, &mut Sleep),
        free: &[Motion3],
        lengths: Lengths,
        rows: &mut Rows,
    ) -> bool {
        let mut has_woken = false;
        for index in 0..pairs.all().len() {
            let pair = &pairs.all()[index];
            let places = pair.bodies.map(BodyId::index);
            let sleeps = places.map(|place| sleep.is_asleep(place));
            let stays = |side: usize| {
                sleeps[side] || bodies.natures[places[side]].body.is_fixed() && free[places[side]] == [0.0; 3]
            };
            if self.listed[index] || stays(0) && stays(1) {
                continue;
            }
            if sleeps[0] || sleeps[1] {
                // Looked at without changing what is remembered: it sleeps on if nothing comes near.
                if !self.comes_near(bodies, pair, (places, sleeps), free, lengths) {
                    pairs.all_mut()[index].contacts.iter_mut().for_each(|contact| contact.is_listed = false);
                    continue;
                }
                for place in places {
                    has_woken |= sleep.wake(bodies, (pairs, ties), place);
                }
            }
            self.listed[index] = true;
            self.list_pair(bodies, (&mut pairs.all_mut()[index], index), free, lengths, rows);
        }
        has_woken
    }

    /// True if a body may touch one that sleeps within the step.
    fn comes_near(
        &mut self,
        bodies: &Bodies,
        pair: &Pair,
        (places, sleeps): ([usize; 2], [bool; 2]),
        free: &[Motion3],
        lengths: Lengths,
    ) -> bool {
        let sides = places.map(|place| (&bodies.natures[place].body.shape, &bodies.movings[place]));
        let way: f64 = (0..2).map(|side| if sleeps[side] { 0.0 } else { self.ways[places[side]] }).sum();
        let nearness = Nearness {
            reach: way + lengths.target_gap,
            depth: depth_to_find(bodies, pair, places),
            overrun: lengths.slack,
        };
        let still = [0.0; 3];
        let [p, q] = [0, 1].map(|side: usize| if sleeps[side] { &still } else { &free[places[side]] });
        let mut comes = false;
        visit_near_features(sides, &nearness, &mut |_, sample| {
            let (a, b) = if sample.primary_is_a { (0, 1) } else { (1, 0) };
            let motions = [sides[a].1, sides[b].1];
            let line = Line::new(
                GapKinematics::of(sample, motions[0], motions[1]).jacobian,
                [BodyId::WORLD; 2].map(|body| bodies.inertia(body)),
                0.0,
            );
            let rate = if a == 0 { line.rate(p, q) } else { line.rate(q, p) };
            comes |= sample.gap - lengths.target_gap + lengths.span * rate < 0.0;
        });
        comes
    }

    /// Lists the contacts of a pair.
    fn list_pair(
        &mut self,
        bodies: &Bodies,
        (pair, index): (&mut Pair, usize),
        free: &[Motion3],
        lengths: Lengths,
        rows: &mut Rows,
    ) {
        let places = pair.bodies.map(BodyId::index);
        // What contacts make of velocities is in the order of what forces do.
        let past = bodies.way_past(places, places.map(|place| free[place]), lengths.span);
        let way = (self.ways[places[0]] + self.ways[places[1]]).min(past + 2.0 * lengths.span * lengths.fall);
        let gone = bodies.ways[places[0]] + bodies.ways[places[1]];
        let sides = places.map(|place| (&bodies.natures[place].body.shape, &bodies.movings[place]));
        let is_known = gone + way <= pair.known_until
            && measure_contacts(sides, lengths.slack, &pair.contacts, &mut self.found);
        if !is_known {
            let reaches = places.map(|place| bodies.natures[place].reach);
            let reach = way + MARGIN * reaches[0].min(reaches[1]);
            pair.known_until = gone + reach;
            let nearness = Nearness {
                reach: reach + lengths.target_gap,
                depth: depth_to_find(bodies, pair, places) + lengths.slack,
                overrun: lengths.slack,
            };
            find_contacts(sides, &nearness, &mut pair.contacts, &mut self.found, &mut self.gone);
        }
        for old in self.gone.drain(..).filter(|old| old.is_told) {
            let told = |sample| pair.told(old.features, &sample, old.forces[0]);
            self.ended.extend(measure(sides, old.features).map(told));
        }
        pair.deepest = self.found.iter().map(|found| -found.sample.gap).fold(0.0, f64::max);
        let can_face =
            pair.deepest > lengths.slack && places.iter().all(|&place| bodies.natures[place].is_convex);
        let side = if can_face { side(sides, &self.found) } else { None };
        for (contact, found) in self.found.iter().enumerate() {
            pair.contacts[contact].is_listed = found.sample.gap <= way + lengths.target_gap
                && side.is_none_or(|side| found.normal().dot(side) > 0.0);
            if pair.contacts[contact].is_listed {
                add_contact(bodies, pair, (index, contact), &found.sample, lengths, rows);
            } else {
                let Contact { is_told, features, forces, .. } = pair.contacts[contact];
                self.ended.extend(is_told.then(|| pair.told(features, &found.sample, forces[0])));
                pair.contacts[contact].let_go();
            }
        }
    }
}

/// Depth [m] up to which features of a pair that had no row may overlap: faster ones are stopped where they touch.
fn depth_to_find(bodies: &Bodies, pair: &Pair, places: [usize; 2]) -> f64 {
    let thickness = bodies.thinner(places);
    (FAST * thickness + DEEPER * pair.deepest).min(DEEPEST * thickness)
}

/// Adds the row of a contact as it is measured.
fn add_contact(
    bodies: &Bodies,
    pair: &mut Pair,
    (index, place): (usize, usize),
    sample: &GapSample,
    lengths: Lengths,
    rows: &mut Rows,
) {
    let Pair { bodies: of_pair, surface, elasticity, contacts, .. } = pair;
    let contact = &mut contacts[place];
    let sides = if sample.primary_is_a { [0, 1] } else { [1, 0] };
    let ids = sides.map(|side: usize| of_pair[side]);
    let [primary, normal] = ids.map(|body| &bodies.movings[body.index()]);
    let inertia = ids.map(|body| bodies.inertia_in_step(body.index()));
    let kinematics = GapKinematics::of(sample, primary, normal);
    let Lengths { span, since_last, target_gap, slack, .. } = lengths;
    let gap = sample.gap - target_gap;
    // What turns far within a step is on no parabola.
    let turn = kinematics
        .normal_rate
        .length()
        .max(primary.angular_velocity.abs())
        .max(normal.angular_velocity.abs());
    let bend = if span * turn <= STRAIGHT { 0.5 * span } else { 0.0 };
    let mut row = Row {
        places: ids.map(|body| body.0),
        apart: None,
        is_bilateral: false,
        prescribed: None,
        presses: contact.presses,
        touches: contact.presses || gap <= slack,
        roll: None,
        normal: Line::new(kinematics.jacobian, inertia, gap.max(0.0) / span + bend * kinematics.gamma),
        slip: Slip::default(),
        gap,
        gamma: if bend > 0.0 { kinematics.gamma } else { 0.0 },
        elasticity: *elasticity,
        strikes: contact.arrival,
        blows: [0.0; 2],
        arrives: None,
        point: sample.point_primary,
        source: Source::Contact { pair: index as u32, contact: place as u32 },
    };
    row.normal.impulse = span * contact.forces[0];
    let features = contact.features;
    let radii = || {
        sides.map(|side: usize| {
            bodies.natures[of_pair[side].index()].body.shape.feature(features[side]).radius()
        })
    };
    if surface.has_friction() {
        let radii = radii();
        let touch = Touch { sample, radii, bodies: [primary, normal], kept_gap: target_gap };
        let speeds = sides.map(|side: usize| surface.speeds[side]);
        let tangent = TangentRow::of(&touch, &kinematics, speeds);
        let running = speeds[0] + speeds[1];
        let sticking = if contact.hold == Hold::Slips { surface.kinetic } else { surface.sticking };
        row.slip = Slip {
            line: Line::new(tangent.jacobian, inertia, bend * tangent.gamma - running),
            bounds: [sticking, surface.kinetic],
            off: way_off(contact, &touch, since_last * running),
            running,
            elasticity: surface.tangential_elasticity,
        };
        row.slip.line.impulse = span * contact.forces[1];
    }
    if surface.rolling > 0.0
        && let Some(radius) = rolling_radius(radii())
    {
        row.roll = Some(rows.rolls.len() as u32);
        let mut line = Line::new(TURNING, inertia, 0.0);
        line.impulse = span * contact.forces[2];
        rows.rolls.push(Roll { row: rows.all.len() as u32, line, bound: surface.rolling * radius });
    }
    row.meet(kinematics.rate);
    rows.push(row);
}

/// Way [m] along the surface from where a contact sticks. Where surfaces run, the place at which it sticks runs along by `run` [m]
/// from step to step.
fn way_off(contact: &mut Contact, touch: &Touch<'_>, run: f64) -> f64 {
    if contact.hold == Hold::Slips {
        return 0.0;
    }
    if touch.sample.kind == GapKind::CenterCenter {
        contact.normal_angle = turned(touch.sample.normal, contact.normal_angle);
    }
    let now = touch.coordinate(contact.normal_angle);
    let at = if let Hold::At(at) = contact.hold { at + run } else { now };
    contact.hold = Hold::At(at);
    now - at
}
