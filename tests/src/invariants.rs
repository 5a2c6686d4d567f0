//! Invariants of all scenes: runs a scene step by step and checks them.
//!
//! No panic, no number that is not finite, no penetration, no energy from nothing, connectors together, contacts that
//! touch and push, and an end within the budget: finished, or a clean error. All checks are independent of the engine:
//! distances come from the geometry alone, energy from the states.

use crate::touching::wrong_contact;
use cpu_time::ThreadTime;
use halfgap::force::{Moving, Snapshot, Wrench, Wrenches};
use halfgap::geometry::{DVec2, Pose, Relation};
use halfgap::scene::{ConnectorData, ForceData, Scene, SceneFormat};
use halfgap::{BodyId, ConnectorId, RemedyCounts, RemedySet, RunError, World, WorldBuilder};
use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

/// Number of intervals between the states that are checked in each run.
const LOOKS: u32 = 50;
/// Number of stops from one check to the next, at which only the clock and the energy are read: this tells a run
/// without events from one that hangs, and shows the energy of bodies that pass close by each other.
const STOPS: u32 = 40;
/// Error allowed in the energy books, in tolerances of the energy turned over; one more is allowed for each step.
const ENERGY_TOLERANCES: f64 = 1e4;
/// Error allowed in the energy books for rounding, as a fraction of the energy turned over.
const ENERGY_ROUNDING: f64 = 1e-9;
/// Fraction of the energy turned over that captures may take, beside the error allowed in the books: contacts begin
/// slowly. A larger share means that an impact was taken for a contact.
const CAPTURED: f64 = 5e-2;
/// Error allowed in a connector, in tolerances of the largest coordinate.
const CONNECTOR_TOLERANCES: f64 = 10.0;
/// Error allowed in a connector for rounding, as a fraction of the largest coordinate.
const CONNECTOR_ROUNDINGS: f64 = 1e4 * f64::EPSILON;

/// Fraction of the duration: a run crawls if it covers less than this in the second half of its budget.
const CRAWLS: f64 = 1e-5;
/// Factor by which the budget of a run that seems to crawl is raised once: light bodies between heavy ones rattle for a
/// while, and nothing is wrong.
const PATIENCE: u32 = 4;

/// Default step [s] after which sunk bodies are put back where contacts carry impulses only.
const IMPULSE_STEP: f64 = 0.025;
/// Depth to which a body may sink before it is stopped again, as a fraction of its bounding radius.
const SUNK_SHARE: f64 = 1e-2;

/// Number of directions in which a body is shifted to measure its depth.
const DIRECTIONS: u32 = 16;
/// Number of halvings of the interval between two powers of ten in which the depth lies.
const HALVINGS: u32 = 5;

/// Largest cost of a run.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Number of events.
    pub events: u64,
    /// Time of a core: other processes on the machine spend none of it.
    pub core: Duration,
}

impl Default for Budget {
    fn default() -> Self {
        Self { events: 300_000, core: Duration::from_secs(3) }
    }
}

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It came to its end, and all invariants held.
    Finished,
    /// It came to its end, but bodies overlapped by less than the target gap.
    Shallow(String),
    /// The scene could not be built: a clean error.
    Refused(String),
    /// It stopped early with an error.
    Stopped(String),
    /// The budget was spent while it went on well.
    Unfinished(String),
    /// An invariant did not hold.
    Broken(Broken),
}

/// A broken invariant.
#[derive(Clone, Debug, PartialEq)]
pub struct Broken {
    /// A word or two by which failures are counted.
    pub kind: String,
    /// Time, bodies and size of the violation.
    pub what: String,
}

impl Verdict {
    /// The kind by which runs are counted: failures by their kind, errors by their words without numbers and names.
    #[must_use]
    pub fn kind(&self) -> String {
        match self {
            Self::Finished => "finished".to_owned(),
            Self::Shallow(_) => "finished, with overlaps within the target gap".to_owned(),
            Self::Refused(why) => format!("refused: {}", without_numbers(why)),
            Self::Stopped(why) => format!("stopped: {}", without_numbers(why)),
            Self::Unfinished(_) => "went on beyond its budget".to_owned(),
            Self::Broken(broken) => format!("BROKEN {}", broken.kind),
        }
    }

    /// True if the run ended worse than another: over budget, in an error, or with a broken invariant.
    #[must_use]
    pub fn is_worse_than(&self, other: &Self) -> bool {
        let rank = |verdict: &Self| match verdict {
            Self::Finished | Self::Refused(_) => 0,
            Self::Shallow(_) => 1,
            Self::Unfinished(_) => 2,
            Self::Stopped(_) => 3,
            Self::Broken(_) => 4,
        };
        rank(self) > rank(other)
    }

    /// True if an invariant is broken.
    #[must_use]
    pub fn is_broken(&self) -> bool {
        matches!(self, Self::Broken(_))
    }
}

fn without_numbers(text: &str) -> String {
    let mut inside = false;
    let plain = text.chars().filter(|&c| {
        inside ^= c == '"';
        !inside && c != '"' && !c.is_ascii_digit() && !"-.".contains(c)
    });
    plain.collect::<String>().split_whitespace().collect::<Vec<_>>().join(" ")
}

thread_local! {
    static LAST_PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Keeps panics from being printed; their messages are reported as failures.
pub fn silence_panics() {
    std::panic::set_hook(Box::new(|info| {
        let text = info.to_string().replace('\n', " ");
        LAST_PANIC.with(|last| last.replace(text));
    }));
}

/// Payload of the panic that ends a run whose budget is spent.
struct Spent {
    crawls: bool,
    what: String,
}

/// Runs a scene, given as JSON.
#[must_use]
pub fn trial(json: &str, budget: Budget) -> Verdict {
    trial_without(json, budget, RemedySet::NONE).0
}

/// Runs a scene, given as JSON, with some remedies switched off; tells how often the others acted.
#[must_use]
pub fn trial_without(json: &str, budget: Budget, without: RemedySet) -> (Verdict, RemedyCounts) {
    let acted = Cell::new(RemedyCounts::default());
    let verdict = match catch_unwind(AssertUnwindSafe(|| run(json, budget, without, &acted))) {
        Ok(verdict) => verdict,
        Err(payload) => match payload.downcast::<Spent>() {
            Ok(spent) if spent.crawls => {
                Verdict::Broken(Broken { kind: "crawls".to_owned(), what: spent.what })
            }
            Ok(spent) => Verdict::Unfinished(spent.what),
            Err(_) => Verdict::Broken(last_panic()),
        },
    };
    (verdict, acted.get())
}

fn last_panic() -> Broken {
    let what = LAST_PANIC.with(|last| last.take());
    let place = what.split_whitespace().find(|word| word.contains(".rs:")).unwrap_or("somewhere");
    Broken { kind: format!("panic {}", place.trim_end_matches(':')), what }
}

fn run(json: &str, budget: Budget, without: RemedySet, acted: &Cell<RemedyCounts>) -> Verdict {
    let scene = match Scene::parse(json, SceneFormat::Json) {
        Ok(scene) => scene,
        Err(error) => return Verdict::Refused(error.to_string()),
    };
    let mut purse = Purse::new(budget, scene.run.start_time, scene.run.duration);
    let built = WorldBuilder::from_scene(&scene).map_err(|error| error.to_string());
    let built = built.and_then(|mut builder| {
        builder.settings_mut().without = without;
        builder.build().map_err(|error| error.to_string())
    });
    let mut world = match built {
        Ok(world) => world,
        Err(why) => return Verdict::Refused(why),
    };
    let mut inspector = Inspector::new(&scene, &world);
    for stop in 0..=LOOKS * STOPS {
        let time = scene.run.start_time + scene.run.duration * f64::from(stop) / f64::from(LOOKS * STOPS);
        let outcome = world.advance_to(time, &mut |event| {
            purse.events += 1;
            purse.spend(event.time());
        });
        acted.set(world.statistics().remedies);
        // A broken invariant that the world itself reports need not be searched for.
        if let Err(error @ RunError::Astray { .. }) = outcome {
            return Verdict::Stopped(error.to_string());
        }
        inspector.note_turnover(&world);
        let is_look = stop % STOPS == 0 || outcome.is_err();
        if let Some(broken) = is_look.then(|| inspector.look(&world)).and_then(Result::err) {
            return Verdict::Broken(broken);
        }
        if let Err(error) = outcome {
            return Verdict::Stopped(error.to_string());
        }
        purse.spend(world.time());
    }
    inspector.shallow.map_or(Verdict::Finished, Verdict::Shallow)
}

/// The budget of a run, and the part of it that is spent.
struct Purse {
    budget: Budget,
    started: ThreadTime,
    events: u64,
    start: f64,
    duration: f64,
    /// Time of the run [s] when half of the budget was spent.
    half_way: Option<f64>,
    /// The budget was extended already.
    is_extended: bool,
}

impl Purse {
    fn new(budget: Budget, start: f64, duration: f64) -> Self {
        Self {
            budget,
            started: ThreadTime::now(),
            events: 0,
            start,
            duration,
            half_way: None,
            is_extended: false,
        }
    }

    /// Panics with [`Spent`] once the budget is spent, with the run at a time [s]; a run that crawls gets more, once.
    fn spend(&mut self, time: f64) {
        let spent = self.started.elapsed();
        let half_way = self.half_way;
        if 2 * self.events > self.budget.events || 2 * spent > self.budget.core {
            self.half_way.get_or_insert(time);
        }
        if self.events > self.budget.events || spent > self.budget.core {
            let since_half = half_way.map_or(f64::INFINITY, |half_way| time - half_way);
            let crawls = since_half < CRAWLS * self.duration;
            if crawls && !self.is_extended {
                self.is_extended = true;
                self.half_way = None;
                self.budget.events *= u64::from(PATIENCE);
                self.budget.core *= PATIENCE;
                return;
            }
            let (events, part) = (self.events, (time - self.start) / self.duration);
            let what = format!("{events} events in {spent:.1?}, {:.1} parts in 100 of the way", 100.0 * part);
            std::panic::panic_any(Spent { crawls, what });
        }
    }
}

/// The quantities that are checked, with their bounds.
struct Inspector {
    /// Pairs that may not penetrate.
    pairs: Vec<(BodyId, BodyId)>,
    /// Kind of each connector, and error [m] allowed in it beside its tolerance: ropes and stops are taut within their
    /// zone.
    connectors: Vec<(&'static str, f64)>,
    tolerance: f64,
    /// Depth [m] to which slow bodies sink where contacts carry impulses only, beside a fraction of their own size;
    /// `None` where they carry forces.
    sinks: Option<f64>,
    /// True if the scene gives the speed that counts as slow: captures may then take any energy.
    slow_is_given: bool,
    turned_over: f64,
    start_potential: f64,
    /// Energy [J] that counts as rounding.
    no_energy: f64,
    /// The first overlap that was less deep than the target gap.
    shallow: Option<String>,
}

impl Inspector {
    fn new(scene: &Scene, world: &World) -> Self {
        let bodies: Vec<BodyId> = world.bodies().collect();
        let pairs = bodies.iter().enumerate().flat_map(|(index, &a)| {
            let others = bodies[index + 1..].iter().map(move |&b| (a, b));
            others.filter(|&(a, b)| may_collide(scene, world, a, b))
        });
        Self {
            pairs: if scene.run.collisions { pairs.collect() } else { Vec::new() },
            connectors: scene
                .connectors
                .iter()
                .map(|connector| (connector.key(), zone(connector, world)))
                .collect(),
            tolerance: scene.run.tolerance_or_default(),
            sinks: (!scene.run.contacts)
                .then(|| world.tolerances().velocity_tol * scene.run.time_step.unwrap_or(IMPULSE_STEP)),
            slow_is_given: scene.run.velocity_tol.is_some(),
            turned_over: 0.0,
            start_potential: world.energy().potential,
            no_energy: no_energy(scene, world),
            shallow: None,
        }
    }

    fn look(&mut self, world: &World) -> Result<(), Broken> {
        let broken = |kind: &str, what: String| {
            Err(Broken { kind: kind.to_owned(), what: format!("t = {} s: {what}", world.time()) })
        };
        let mut coordinate: f64 = 0.0;
        for body in world.bodies() {
            let state = world.state(body);
            coordinate = coordinate.max(state.position.abs().max_element());
            let spin = [state.angle, state.angular_velocity];
            if !(state.position.is_finite()
                && state.velocity.is_finite()
                && spin.iter().all(|x| x.is_finite()))
            {
                return broken("not finite", format!("{}: {state:?}", world.name(body)));
            }
        }
        for &(a, b) in &self.pairs {
            if let Some(relation) = penetration(world, a, b) {
                let (depth, names) = (depth(world, a, b), [a, b].map(|body| world.name(body)));
                let gap = world.tolerances().target_gap + self.may_sink(world, [a, b]);
                let what = format!("{names:?}: {relation:?}, about {depth:.0e} m deep, gap {gap:.1e} m");
                if depth > gap {
                    return broken("penetration", what);
                }
                self.shallow.get_or_insert(format!("t = {} s: {what}", world.time()));
            }
        }
        let allowed = (CONNECTOR_TOLERANCES * self.tolerance + CONNECTOR_ROUNDINGS) * coordinate;
        for (connector, &(kind, zone)) in (0..).map(ConnectorId).zip(&self.connectors) {
            let error = world.connector_error(connector);
            // A NaN is not within the bounds either.
            if error.is_nan() || error > allowed.max(zone) {
                return broken("connector off", format!("{kind} {} is off by {error:e} m", connector.0));
            }
        }
        if let Some((kind, what)) =
            wrong_contact(world, CONNECTOR_ROUNDINGS * coordinate, self.no_energy / coordinate)
        {
            return broken(kind, what);
        }
        self.look_at_energy(world).or_else(|(kind, what)| broken(kind, what))
    }

    /// Depth [m] to which two bodies may sink into each other beyond the target gap.
    fn may_sink(&self, world: &World, bodies: [BodyId; 2]) -> f64 {
        let reach = bodies.map(|body| world.shape(body).reach());
        let by_impulses = self.sinks.map_or(0.0, |slow| slow + SUNK_SHARE * reach[0].min(reach[1]));
        by_impulses.max(world.room_to_sink(bodies))
    }

    /// Notes the energy that has been turned over.
    fn note_turnover(&mut self, world: &World) {
        let ledger = world.ledger();
        let turned = ledger.now.kinetic
            + (ledger.now.potential - self.start_potential).abs()
            + ledger.force_laws.iter().map(|law| law.work.abs()).sum::<f64>()
            + ledger.surfaces.abs()
            + ledger.drives.abs();
        self.turned_over = self.turned_over.max(turned);
    }

    fn look_at_energy(&self, world: &World) -> Result<(), (&'static str, String)> {
        let ledger = world.ledger();
        let work =
            ledger.force_laws.iter().map(|law| law.work).sum::<f64>() + ledger.surfaces + ledger.drives;
        let potential = ledger.now.potential.abs().max(self.start_potential.abs());
        let tolerances = ENERGY_TOLERANCES + world.statistics().steps as f64;
        let allowed = (tolerances * self.tolerance + ENERGY_ROUNDING) * self.turned_over
            + CONNECTOR_ROUNDINGS * potential
            + self.no_energy;
        let gained = ledger.now.total() - ledger.start - work;
        if gained > allowed {
            return Err(("energy gained", format!("{gained:e} J, {allowed:e} J allowed: {ledger:?}")));
        }
        if !self.slow_is_given && ledger.captures < -(CAPTURED * self.turned_over + allowed) {
            let captures = ledger.captures;
            return Err(("captures", format!("{captures:e} J, {:e} J turned over", self.turned_over)));
        }
        let error = ledger.integration_error();
        if error.is_nan() || error.abs() > allowed {
            return Err(("energy books", format!("{error:e} J, {allowed:e} J allowed: {ledger:?}")));
        }
        Ok(())
    }
}

/// Error [m] allowed in a connector beside its tolerance.
fn zone(connector: &ConnectorData, world: &World) -> f64 {
    match connector {
        ConnectorData::Rope(_) | ConnectorData::RailStop(_) => world.tolerances().accuracy,
        _ => 0.0,
    }
}

/// Relation of two bodies; `None` if they are apart.
fn penetration(world: &World, a: BodyId, b: BodyId) -> Option<Relation> {
    let pose = |body| world.state(body).pose();
    let (first, second) = (world.shape(a), world.shape(b));
    let (box_a, box_b) = (first.bounds_at(&pose(a)), second.bounds_at(&pose(b)));
    if box_a.min.cmpgt(box_b.max).any() || box_b.min.cmpgt(box_a.max).any() {
        return None;
    }
    let relation = first.distance(&pose(a), second, &pose(b)).relation;
    (relation != Relation::Apart).then_some(relation)
}

/// Estimate of the least shift [m] of a body that frees it of another, rather too large than too small.
fn depth(world: &World, a: BodyId, b: BodyId) -> f64 {
    let (of_a, of_b) = (world.state(a).pose(), world.state(b).pose());
    let frees = |depth: f64| {
        (0..DIRECTIONS).any(|direction| {
            let way = DVec2::from_angle(f64::from(direction) * TAU / f64::from(DIRECTIONS));
            let shifted = Pose { position: of_a.position + depth * way, ..of_a };
            world.shape(a).distance(&shifted, world.shape(b), &of_b).relation == Relation::Apart
        })
    };
    let size = world.shape(a).reach().max(world.shape(b).reach());
    let gap = world.tolerances().target_gap;
    let mut depths: Vec<f64> = (-16..1).map(|power| size * 10f64.powi(power)).chain([gap]).collect();
    depths.sort_by(f64::total_cmp);
    let Some(first) = depths.iter().position(|&depth| frees(depth)) else { return f64::INFINITY };
    // Bisection between that power of ten and the one before.
    let (mut less, mut enough) = (if first > 0 { depths[first - 1] } else { 0.0 }, depths[first]);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (less + enough);
        *(if frees(middle) { &mut enough } else { &mut less }) = middle;
    }
    enough
}

/// Energy [J] that counts as rounding: that of a speed at the rounding of coordinates, and the work of weights and
/// other forces along a distance within the tolerance of a body's size, of torques along the angle that goes with it.
/// Where a spring or a motor presses on a held body, steps err by that much and projections take it back, though
/// nothing moves.
fn no_energy(scene: &Scene, world: &World) -> f64 {
    let masses = world.bodies().filter_map(|body| world.inertia(body)).map(|inertia| inertia.mass);
    let reach = world.bodies().filter(|&body| !world.is_fixed(body)).map(|body| world.shape(body).reach());
    let coordinate =
        world.bodies().map(|body| world.state(body).position.abs().max_element() + world.shape(body).reach());
    let speed = coordinate.fold(0.0, f64::max) / scene.run.duration;
    let turned = CONNECTOR_TOLERANCES * scene.run.tolerance_or_default();
    let lifted = turned * reach.fold(0.0, f64::max);
    let weight: f64 = scene.forces.iter().map(|force| gravity(&force.data)).sum();
    let (forces, torques) = acting(scene, world);
    masses.sum::<f64>() * (CONNECTOR_ROUNDINGS * speed * speed + weight * lifted)
        + forces * lifted
        + torques * turned
}

/// Sums of the sizes of the forces [N] and torques [N m] of laws on all bodies, and of motors.
fn acting(scene: &Scene, world: &World) -> (f64, f64) {
    let movings: Vec<Moving> = world.bodies().map(|body| Moving::from(&world.state(body))).collect();
    let now = Snapshot::new(world.time(), &movings);
    let mut sums = vec![Wrench::default(); movings.len()];
    world.forces().for_each(|law| law.apply(&now, &mut Wrenches::new(&mut sums)));
    let mut forces: f64 = sums.iter().map(|wrench| wrench.force.length()).sum();
    let mut torques: f64 = sums.iter().map(|wrench| wrench.torque.abs()).sum();
    for connector in &scene.connectors {
        let motor = connector.data.joint().and_then(|joint| joint.motor).map_or(0.0, |motor| motor.max);
        *(if matches!(connector.data, ConnectorData::Pin(_)) { &mut torques } else { &mut forces }) += motor;
    }
    (forces, torques)
}

/// Size of the uniform gravity [m/s^2] of a force; 0 for other forces.
fn gravity(force: &ForceData) -> f64 {
    match force {
        ForceData::Gravity(gravity) => DVec2::from(gravity.acceleration).length(),
        _ => 0.0,
    }
}

fn may_collide(scene: &Scene, world: &World, a: BodyId, b: BodyId) -> bool {
    if world.is_fixed(a) && world.is_fixed(b) {
        return false;
    }
    let passes = |a: BodyId, b: BodyId| {
        let name = world.name(b);
        scene.bodies[a.index()].passes_through.iter().any(|other| other == name)
    };
    let is = |body: BodyId, name: &str| world.name(body) == name;
    let joined = scene.connectors.iter().any(|connector| {
        let [Some(first), Some(second)] = connector.points() else { return false };
        let both = (is(a, &first.body) && is(b, &second.body)) || (is(b, &first.body) && is(a, &second.body));
        let joins = matches!(
            connector.data,
            ConnectorData::Pin(_)
                | ConnectorData::Slot(_)
                | ConnectorData::Weld(_)
                | ConnectorData::Slider(_)
        );
        both && joins && !connector.options().collide
    });
    !joined && !passes(a, b) && !passes(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world_of;

    #[test]
    fn overlapping_bodies_are_seen() {
        let disc = "shape = { disc = { radius = 1.0 } }\nmass = 1.0\n";
        let world = world_of(&format!(
            "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = {{ duration = 1.0, collisions = false }}\n\
             [[body]]\nname = \"a\"\n{disc}[[body]]\nname = \"b\"\n{disc}position = [1.5, 0.0]\n\
             [[body]]\nname = \"c\"\n{disc}position = [3.6, 0.0]\n"
        ));
        assert_eq!(penetration(&world, BodyId(0), BodyId(1)), Some(Relation::Crossing));
        assert_eq!(penetration(&world, BodyId(1), BodyId(2)), None);
    }

    #[test]
    fn errors_are_counted_without_names_and_numbers() {
        let verdict = Verdict::Stopped("at 1.5 s in an impact of \"body1\": cycled 30 times".to_owned());
        assert_eq!(verdict.kind(), "stopped: at s in an impact of : cycled times");
    }
}
