//! Broken invariants of a run: connectors that are off, overlaps, and energy books that do not close.
//!
//! A simulation that goes wrong mostly ends in numbers that look like any others. These invariants can be checked
//! without knowing the answer, now and then and at the end of every run. So can what its author hardly meant
//! (`unmeant`).

use crate::invariant_monitor::InvariantMonitor;
use crate::ledger::Books;
use crate::near::NearPairs;
use crate::overlap::overlap_depth;
use crate::world::World;
use crate::world_error::ConnectorName;
use glam::DVec2;
use halfgap_collision::{BodyId, ConnectorId};
use halfgap_geometry::Rounded;

// The energy in play is the largest sum seen of the kinetic energy, the change of the potential energy and the work of
// force laws.

/// Error allowed in a connector, in tolerances of the largest coordinate.
const CONNECTOR_TOLERANCES: f64 = 10.0;
/// Error allowed in a connector for rounding, as a fraction of the largest coordinate.
const CONNECTOR_ROUNDINGS: f64 = 1e4 * f64::EPSILON;
/// Overlap allowed, in target gaps.
const GAPS: f64 = 1.0;
/// Factor on the errors of connectors and the overlaps allowed where steps of a given length may err by any amount.
const ROUGHLY: f64 = 10.0;
/// Where the settings promise nothing: error allowed in a connector, as a fraction of the largest coordinate, and in
/// the books, as a fraction of the energy in play. More would be plain to see.
const PLAINLY: f64 = 1e-2;
/// Overlap allowed where contacts carry no forces, as a multiple of the room that bodies have to sink between impulses.
const SINKING: f64 = 1.25;
/// Error allowed in the books, in errors of a step relative to the energy in play.
const BOOKS_ERRORS: f64 = 1e3;
/// Error allowed in the books for rounding, as a fraction of the energies.
const BOOKS_ROUNDINGS: f64 = 1e6 * f64::EPSILON;
/// Error of the books beyond which the run is astray, in tolerances of the energy in play.
const ASTRAY: f64 = 5e3;
/// Further error of the books allowed for each step, in tolerances of the energy in play.
const ASTRAY_PER_STEP: f64 = 0.5;
/// Error allowed in the books, in works of the forces along a target gap: far from the origin rounding makes gaps wide,
/// and each event may err by a fraction of one.
const ROUGH: f64 = 3e4;
/// Least value of the energy in play, as a fraction of the energy that is usual in the scene.
const SELDOM: f64 = 1e-2;
/// Fraction of the energy in play that captures may take, beside the error allowed in the books. Contacts begin slowly:
/// where more is taken, a real impact was taken for a slow contact. Where `velocity_tol` is given, projections may take
/// as much.
const CAPTURED: f64 = 5e-2;

/// A broken invariant of a run, or what its author can hardly have meant.
///
/// `turned_over` is the energy in play: see [`World::findings`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Finding {
    /// A connector is off.
    ConnectorOff {
        /// The connector.
        connector: ConnectorName,
        /// Error of the connector [m].
        error: f64,
        /// Time at which the error was seen [s].
        time: f64,
    },
    /// Two bodies overlap.
    Overlap {
        /// Name of one body.
        first: String,
        /// Name of the other body.
        second: String,
        /// Depth of the overlap [m].
        depth: f64,
        /// Time at which the overlap was seen [s].
        time: f64,
    },
    /// The energy books do not close: a change of the energy has no booked cause.
    OpenBooks {
        /// Size of the change [J].
        error: f64,
        /// The energy in play [J].
        turned_over: f64,
    },
    /// Projections onto contacts and connectors changed the energy by more than errors of steps; near a position where
    /// a linkage can go on in several ways this may be a jump.
    Projected {
        /// Size of the change [J].
        energy: f64,
        /// The energy in play [J].
        turned_over: f64,
    },
    /// Captures, which stop slow or too frequent contacts without elasticity, removed a large part of the energy: some
    /// of these contacts were real impacts.
    Captured {
        /// Energy removed [J].
        energy: f64,
        /// The energy in play [J].
        turned_over: f64,
        /// Speed [m/s] below which a collision is a contact.
        slow: f64,
    },
    /// The point at which a force law pushes a body is fixed in the world, and the body has left it.
    PointLeft {
        /// Name of the law.
        law: String,
        /// Name of the body.
        body: String,
        /// The point [m].
        point: DVec2,
        /// Time at which the point was first seen outside of the body [s].
        time: f64,
    },
    /// No body ever moved, and no force acts on any.
    NothingMoved,
}

/// A finding without its time, for errors that have one of their own.
struct WithoutTime<'a>(&'a Finding);

impl std::fmt::Display for WithoutTime<'_> {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            Finding::ConnectorOff { connector, error, .. } => {
                write!(out, "{connector} is off by {} m", Rounded(*error))
            }
            Finding::Overlap { first, second, depth, .. } => {
                write!(out, "\"{first}\" and \"{second}\" overlap by {} m", Rounded(*depth))
            }
            Finding::OpenBooks { error, turned_over } => write!(
                out,
                "the energy books do not close: {} J of {} J in play are not accounted for",
                Rounded(*error),
                Rounded(*turned_over)
            ),
            Finding::Projected { energy, turned_over } => write!(
                out,
                "projections onto contacts and connectors changed the energy by {} J of {} J in play",
                Rounded(*energy),
                Rounded(*turned_over)
            ),
            Finding::Captured { energy, turned_over, slow } => write!(
                out,
                "stopping slow (< {} m/s) or too frequent contacts removed {} J of {} J in play; lower `tolerance`, or set \
                 `velocity_tol` if that is wanted",
                Rounded(*slow),
                Rounded(*energy),
                Rounded(*turned_over)
            ),
            Finding::PointLeft { law, body, point, .. } => write!(
                out,
                "the point ({}, {}) m at which \"{law}\" pushes \"{body}\" is outside of that body: with `frame = \"world\"` the \
                 point stays where it is while the body moves, and the force turns it; `frame = \"body\"` keeps the point on \
                 the body, and turns the force with it",
                Rounded(point.x),
                Rounded(point.y)
            ),
            Finding::NothingMoved => write!(
                out,
                "nothing moved: all bodies start at rest, and no force acts on any (a body is given a `velocity`, and \
                 `[[force]]` acts on bodies)"
            ),
        }
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Self::ConnectorOff { time, .. } | Self::Overlap { time, .. } | Self::PointLeft { time, .. } =
            self
        {
            write!(out, "at {} s ", Rounded(*time))?;
        }
        WithoutTime(self).fmt(out)
    }
}

/// Findings in the course of a run, each connector and pair of bodies once, when it was worst.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    found: Vec<Finding>,
    near: NearPairs,
}

impl Findings {
    /// Checks whether connectors are together and bodies apart, unless the monitor has just found that they are.
    pub(crate) fn look(&mut self, world: &World) {
        if world.monitor.is_sound {
            return;
        }
        let mut found = Vec::new();
        world.find_connectors_off(&mut found);
        world.find_overlaps(&mut self.near, &mut found);
        found.into_iter().for_each(|finding| self.add(finding));
    }

    fn add(&mut self, finding: Finding) {
        match self.found.iter_mut().find(|known| known.is_of_same(&finding)) {
            Some(known) if finding.is_worse_than(known) => *known = finding,
            Some(_) => (),
            None => self.found.push(finding),
        }
    }

    /// Notes force laws whose point has left its body, each once, when that is first seen.
    pub(crate) fn look_at_points(&mut self, world: &World) {
        let mut found = Vec::new();
        let is_told = |name: &str| {
            self.found.iter().any(|known| matches!(known, Finding::PointLeft { law, .. } if law == name))
        };
        world.find_points_left(is_told, &mut found);
        found.into_iter().for_each(|finding| self.add(finding));
    }

    /// Returns all findings, with those at the end and in the energy books.
    pub(crate) fn at_end(mut self, world: &World, turned_over: f64) -> Vec<Finding> {
        self.look(world);
        self.look_at_points(world);
        world.look_at_books(&Books::from(&world.ledger()), turned_over, &mut self.found);
        self.found
    }
}

impl Finding {
    /// Formats the finding without its time.
    pub(crate) fn without_time(&self) -> impl std::fmt::Display + '_ {
        WithoutTime(self)
    }

    /// True for two findings about one connector, one pair of bodies, or the point of one law.
    fn is_of_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::ConnectorOff { connector: a, .. }, Self::ConnectorOff { connector: b, .. }) => a == b,
            (
                Self::Overlap { first: a, second: b, .. },
                Self::Overlap { first: other_a, second: other_b, .. },
            ) => (a, b) == (other_a, other_b),
            (Self::PointLeft { law: a, .. }, Self::PointLeft { law: b, .. }) => a == b,
            _ => false,
        }
    }

    /// True if the finding is worse than another; NaN is worst.
    fn is_worse_than(&self, other: &Self) -> bool {
        let size = |finding: &Self| match finding {
            Self::ConnectorOff { error: size, .. }
            | Self::Overlap { depth: size, .. }
            | Self::OpenBooks { error: size, .. }
            | Self::Projected { energy: size, .. }
            | Self::Captured { energy: size, .. } => *size,
            Self::PointLeft { .. } | Self::NothingMoved => 0.0,
        };
        size(self).total_cmp(&size(other)).is_gt()
    }
}

impl World {
    /// Checks whether connectors are together, bodies are apart, and the energy books close, to the accuracy that the
    /// settings promise, or roughly where they promise none. Returns an empty list if all is well.
    ///
    /// `turned_over` is the energy in play [J]: the largest sum of the kinetic energy, the change of the potential
    /// energy since the start and the work of force laws that was seen in the run.
    #[must_use]
    pub fn findings(&self, turned_over: f64) -> Vec<Finding> {
        Findings::default().at_end(self, turned_over)
    }

    pub(crate) fn find_connectors_off(&self, findings: &mut Vec<Finding>) {
        let share = CONNECTOR_TOLERANCES * self.tolerance() + CONNECTOR_ROUNDINGS;
        let is_projected = self.rigid_settings().projection;
        self.connectors_off(if is_projected { self.leniency() * share } else { PLAINLY }, findings);
    }

    /// Lists connectors that are off by more than a fraction of the largest coordinate. Ropes and stops count as taut
    /// within their target zone and, where contacts carry impulses only, within the depth that bodies sink in a step.
    fn connectors_off(&self, share: f64, findings: &mut Vec<Finding>) {
        if self.connectors().is_empty() {
            return;
        }
        let farthest = self.bodies().map(|body| {
            let state = self.state(body);
            state.position.abs().max_element() + self.shape(body).reach()
        });
        let at_target = share * farthest.fold(0.0, f64::max);
        for (index, connector) in (0..).map(ConnectorId).zip(self.connectors()) {
            let error = self.connector_error(index);
            let sinks = self.rigid_settings().search.depth;
            let zone = if connector.is_bilateral() { 0.0 } else { self.tolerances().accuracy.max(sinks) };
            let allowed = at_target.max(zone);
            if error.is_nan() || error > allowed {
                let connector = self.joints.name(index, &self.bodies);
                findings.push(Finding::ConnectorOff { connector, error, time: self.time() });
            }
        }
    }

    pub(crate) fn find_overlaps(&self, near: &mut NearPairs, findings: &mut Vec<Finding>) {
        if self.rigid_settings().collisions {
            self.overlaps(self.pairs_that_pass(), near, findings);
        }
    }

    /// Lists overlaps of all pairs but the excluded ones.
    fn overlaps(&self, excluded: &[(BodyId, BodyId)], near: &mut NearPairs, findings: &mut Vec<Finding>) {
        let allowed = self.leniency() * GAPS * self.tolerances().target_gap;
        let pose = |body: BodyId| self.state(body).pose();
        // Two bodies overlap by no more than their boxes do along either side, and bricks that lie flush overlap by
        // rounding: boxes shrunk by half of the allowed depth leave out what need not be measured.
        let core = |body: BodyId| self.shape(body).bounds_at(&pose(body)).grown(-0.5 * allowed);
        let boxes = self.bodies().map(|body| (core(body), self.is_fixed(body)));
        for &(a, b) in near.find(boxes, excluded) {
            let depth = overlap_depth(self.shape(a), &pose(a), self.shape(b), &pose(b));
            // Without contact forces bodies sink a little between impacts.
            let allowed = allowed + SINKING * self.room_to_sink([a, b]);
            if let Some(depth) = depth.filter(|depth| *depth > allowed) {
                let [first, second] = [a, b].map(|body| self.name(body).to_owned());
                findings.push(Finding::Overlap { first, second, depth, time: self.time() });
            }
        }
    }

    /// Checks whether the books close, and how much energy projections and captures have taken.
    fn look_at_books(&self, books: &Books, turned_over: f64, findings: &mut Vec<Finding>) {
        let of_steps = BOOKS_ERRORS * self.rigid_settings().steps.local_error;
        let share = if self.keeps_to_tolerance() { of_steps } else { PLAINLY };
        // Errors of steps and rounding are relative to the usual energy; where nothing moves or falls, to that of
        // motion by rounding.
        let scales = &self.monitor.scales;
        let least = SELDOM * scales.usual;
        let is_told = |energy: &f64| {
            let is_much = exceeds(*energy, books, turned_over.max(least), share);
            let rounding = if scales.usual > 0.0 { scales.left } else { scales.lost };
            is_much && (energy.is_nan() || *energy > rounding)
        };
        let open = Some(books.error().abs()).filter(is_told);
        findings.extend(open.map(|error| Finding::OpenBooks { error, turned_over }));
        // Projections stop slow contacts, too, and without contact forces they put back sunk bodies.
        let is_blow = |energy: &f64| exceeds(*energy, books, turned_over.max(least), CAPTURED);
        let projected = Some(books.projections.abs()).filter(|energy| {
            let puts_back = self.rigid_settings().impulse_step.is_some();
            !puts_back && is_told(energy) && (!self.monitor.slow_is_given || is_blow(energy))
        });
        findings.extend(projected.map(|energy| Finding::Projected { energy, turned_over }));
        if scales.usual > 0.0 {
            let turned = turned_over.max(least);
            let allowed = books_rounding(books, turned) + scales.lost;
            findings.extend(self.captured(books, [turned_over, turned], allowed));
        }
    }

    /// Returns a finding if the books are open by far more than [`World::findings`] reports, or captures have taken a
    /// large part of the energy. A monitor that looks seldom does not see all of the energy in play: it takes it for at
    /// least a fraction of the usual energy of the scene.
    pub(crate) fn books_astray(&self, books: &Books, turned_over: f64) -> Option<Finding> {
        let InvariantMonitor { scales, is_watchful, .. } = &self.monitor;
        if scales.usual == 0.0 {
            // Nothing moves or falls: all energy is rounding.
            return None;
        }
        let share = (ASTRAY + ASTRAY_PER_STEP * self.steps() as f64) * self.tolerance();
        let allowed = if *is_watchful {
            let rounding = ASTRAY * f64::EPSILON * books.now.potential.abs().max(books.start.abs());
            share * turned_over + rounding + scales.lost
        } else {
            let turned = turned_over.max(SELDOM * scales.usual);
            (share * turned + books_rounding(books, turned)).max(ROUGH * scales.rough)
        };
        let allowed = allowed + scales.left;
        let error = books.error().abs();
        if error.is_nan() || error > allowed {
            return Some(Finding::OpenBooks { error, turned_over });
        }
        self.captured(books, [turned_over; 2], allowed)
    }

    /// Returns a finding if captures have taken a large part of the energy in play `taken_for` [J], and more than
    /// `allowed` [J] beside the energy that interventions have put in: gentle pushes are slow.
    fn captured(&self, books: &Books, [turned_over, taken_for]: [f64; 2], allowed: f64) -> Option<Finding> {
        let (energy, slow) = (-books.captures, self.tolerances().velocity_tol);
        let is_blow = energy > CAPTURED * taken_for + books.given.max(0.0) + allowed;
        (is_blow && !self.is_slow_asked_for()).then_some(Finding::Captured { energy, turned_over, slow })
    }

    /// True if captures are wanted whatever they take: the caller has given the speed that counts as slow, or the
    /// target gap, within which bounces come to rest, or contacts carry impulses only.
    fn is_slow_asked_for(&self) -> bool {
        let InvariantMonitor { slow_is_given, gap_is_given, .. } = self.monitor;
        slow_is_given || gap_is_given || self.rigid_settings().impulse_step.is_some()
    }

    /// Factor on the errors of connectors and the overlaps allowed.
    fn leniency(&self) -> f64 {
        if self.keeps_to_tolerance() { 1.0 } else { ROUGHLY }
    }

    /// False where steps of a given length may err by any amount, or states are not projected.
    pub(crate) fn keeps_to_tolerance(&self) -> bool {
        let settings = self.rigid_settings();
        !self.strategy.is_stepping() && settings.projection && settings.method.is_adaptive()
    }
}

/// Error [J] of the books that may be rounding.
fn books_rounding(books: &Books, turned_over: f64) -> f64 {
    BOOKS_ROUNDINGS * (turned_over + books.now.potential.abs() + books.start.abs())
}

/// True if an energy [J] is NaN, or more than a fraction of the energy in play [J] plus rounding.
fn exceeds(energy: f64, books: &Books, turned_over: f64, share: f64) -> bool {
    energy.is_nan() || energy > share * turned_over + books_rounding(books, turned_over)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::Energy;
    use crate::{BodySpec, ConnectorSpec, Stabilization, ToleranceOverrides, WorldBuilder, WorldSettings};
    use halfgap_collision::{Anchor, BodyState, Connector, ConnectorKind};
    use halfgap_geometry::Shape;

    fn disc(name: &str, x: f64) -> BodySpec {
        let shape = Shape::disc(0.5).expect("a fine radius");
        let state = BodyState { position: DVec2::new(x, 0.0), ..BodyState::default() };
        BodySpec::movable(name, shape, 1.0, state)
    }

    #[test]
    fn books_that_lack_more_than_steps_may_err_are_open() {
        let now = Energy { kinetic: 3.0, potential: 1.0 };
        let books = Books { now, start: 5.0, booked: -0.9, ..Books::default() };
        let error = books.error().abs();
        assert!(!exceeds(error, &books, 4.0, 0.05) && exceeds(error, &books, 4.0, 0.01));
        let expected = "the energy books do not close: 0.1 J of 4 J in play are not accounted for";
        assert_eq!(Finding::OpenBooks { error, turned_over: 4.0 }.to_string(), expected);
    }

    #[test]
    fn energy_that_projections_take_is_told() {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        let body = builder.add(disc("falling", 1.0));
        builder.add_gravity(body, DVec2::new(0.0, -10.0));
        let world = builder.build().expect("it falls");
        let told = |projections: f64| {
            let mut findings = Vec::new();
            let books = Books { projections, ..Books::from(&world.ledger()) };
            world.look_at_books(&books, 10.0, &mut findings);
            findings.iter().map(Finding::to_string).collect::<Vec<_>>()
        };
        assert_eq!(told(1e-9), Vec::<String>::new());
        assert_eq!(
            told(-1.0),
            ["projections onto contacts and connectors changed the energy by 1 J of 10 J in play"]
        );
    }

    #[test]
    fn where_it_is_given_what_is_slow_projections_may_stop_it() {
        let overrides = ToleranceOverrides { velocity_tol: Some(0.5), ..ToleranceOverrides::default() };
        let mut builder = WorldBuilder::new(WorldSettings { overrides, ..WorldSettings::default() });
        let body = builder.add(disc("falling", 1.0));
        builder.add_gravity(body, DVec2::new(0.0, -10.0));
        let world = builder.build().expect("it falls");
        for (projections, is_told) in [(-0.1, false), (-1.0, true)] {
            let mut findings = Vec::new();
            let books = Books { projections, ..Books::from(&world.ledger()) };
            world.look_at_books(&books, 10.0, &mut findings);
            let told = findings.iter().any(|finding| matches!(finding, Finding::Projected { .. }));
            assert_eq!(told, is_told, "{projections} J");
        }
    }

    #[test]
    fn rounding_where_nothing_else_moves_is_no_energy() {
        let settings = WorldSettings { duration: Some(1.0), ..WorldSettings::default() };
        let mut builder = WorldBuilder::new(settings);
        builder.add(disc("still", 1.0));
        let world = builder.build().expect("it rests");
        for (energy, is_told) in [(1e-33, false), (1e-20, false), (1e-6, true)] {
            let mut world = world.clone();
            world.start.energy -= energy;
            assert_eq!(!world.findings(energy).is_empty(), is_told, "{energy} J");
        }
    }

    #[test]
    fn bodies_that_overlap_are_named_unless_they_may() {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        let [a, b] = [("a", 0.0), ("b", 0.75)].map(|(name, x)| builder.add(disc(name, x)));
        builder.let_pass(a, b);
        let world = builder.build().expect("they pass through each other");
        assert_eq!(world.findings(0.0), []);
        let mut findings = Vec::new();
        world.overlaps(&[], &mut NearPairs::default(), &mut findings);
        let [Finding::Overlap { first, second, depth, .. }] = findings.as_slice() else {
            panic!("{findings:?}")
        };
        assert_eq!([first.as_str(), second.as_str()], ["a", "b"]);
        assert!((depth - 0.25).abs() < 1e-12, "{depth}");
    }

    #[test]
    fn the_worst_finding_of_a_kind_is_told_once() {
        let world = WorldBuilder::new(WorldSettings::default()).build().expect("nothing in it");
        let overlap = |depth, time| Finding::Overlap { first: "a".into(), second: "b".into(), depth, time };
        let mut findings = Findings::default();
        for (depth, time) in [(0.5, 1.0), (0.7, 2.0), (0.6, 3.0)] {
            findings.add(overlap(depth, time));
        }
        // A finding stays although the overlap is over.
        assert_eq!(findings.at_end(&world, 0.0), [overlap(0.7, 2.0)]);
    }

    #[test]
    fn a_connector_that_has_drifted_off_is_named() {
        let settings = WorldSettings { stabilization: Stabilization::None, ..WorldSettings::default() };
        let mut builder = WorldBuilder::new(settings);
        let body = builder.add(disc("bob", 1.0));
        let [a, b] =
            [(BodyId::WORLD, DVec2::ZERO), (body, DVec2::ZERO)].map(|(body, point)| Anchor { body, point });
        let rod = Connector::new(ConnectorKind::Rod { a, b, length: 1.0 }, 0.0).expect("a fine rod");
        builder.add_connector(ConnectorSpec::new(rod));
        builder.add_gravity(body, DVec2::new(0.0, -10.0));
        let mut world = builder.build().expect("it hangs");
        world.advance_to(10.0, &mut |_| ()).expect("it swings");
        // Without stabilization a drift is no finding.
        assert_eq!(world.findings(10.0), []);
        let mut findings = Vec::new();
        world.connectors_off(0.0, &mut findings);
        let told: Vec<_> = findings.iter().map(Finding::to_string).collect();
        let start = "at 10 s connector 0 (rod of \"world\" and \"bob\") is off by ";
        assert!(told.len() == 1 && told[0].starts_with(start), "{told:?}");
    }
}
