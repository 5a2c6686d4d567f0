//! An event-driven system of its own that has to be integrated: a block on a running belt, held back by a spring.
//!
//! The block sticks to the belt until the spring pulls harder than friction holds, then it slips, faster and
//! faster since friction falls with the sliding speed, swings back and is caught again: the squeal of a
//! brake. While it sticks, its motion and the next event are known in closed form; while it slips, steps of
//! an integrator are its segments, and the catch is found on the motion along a step.
//!
//! Nothing here knows of bodies: only the integrator, the trait, the clock and the queue are used.
//!
//! `cargo run -p halfgap-advance --no-default-features --example stick_slip`

use halfgap_advance::ode::{Method, Ode, Point, SegmentPolynomial, Stepper};
use halfgap_advance::{EventDriven, EventQueue, SourceId, Time, advance_until};
use std::convert::Infallible;

/// Speed of the belt [m/s].
const BELT_SPEED: f64 = 0.1;
/// Stiffness of the spring per mass of the block [1/s^2].
const STIFFNESS: f64 = 40.0;
/// Acceleration of gravity [m/s^2].
const GRAVITY: f64 = 9.81;
/// Friction coefficient at rest [-].
const STATIC_FRICTION: f64 = 0.4;
/// Friction coefficient when sliding fast [-].
const SLIDING_FRICTION: f64 = 0.2;
/// Speed [m/s] over which the coefficient falls from one to the other (Stribeck 1902).
const STRIBECK_SPEED: f64 = 0.1;
/// Just acceptable errors of a step, in position [m] and velocity [m/s].
const ERROR_SCALES: [f64; 2] = [1e-10, 1e-10];
/// Length of the first step of a slip [s].
const FIRST_STEP: f64 = 1e-3;
/// Number of parts in which a step is searched for a catch.
const LOOKS: u32 = 16;

const SLIPS: SourceId = SourceId(0);
const STEP_ENDS: SourceId = SourceId(1);
const CAUGHT: SourceId = SourceId(2);

/// The block while it slips backwards over the belt: its state is position and velocity.
struct Slipping;

impl Ode for Slipping {
    type Error = Infallible;

    fn derivative(&mut self, _offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        let sliding = (BELT_SPEED - state[1]).abs();
        let fallen = (-sliding / STRIBECK_SPEED).exp();
        let friction = SLIDING_FRICTION + (STATIC_FRICTION - SLIDING_FRICTION) * fallen;
        rates.copy_from_slice(&[state[1], friction * GRAVITY - STIFFNESS * state[0]]);
        Ok(())
    }
}

struct Block {
    queue: EventQueue,
    stepper: Stepper,
    /// State at the start of the segment.
    state: [f64; 2],
    start: Time,
    /// Position and velocity along a step, while it slips.
    step: [SegmentPolynomial; 2],
    next_step: f64,
}

/// Report of an event: the block slips, or is caught, at some position [m].
enum Told {
    Slips(f64),
    Caught(f64),
}

impl Block {
    fn new() -> Self {
        let mut block = Self {
            queue: EventQueue::new(),
            stepper: Stepper::new(Method::Dop853),
            state: [0.0; 2],
            start: Time::ZERO,
            step: Default::default(),
            next_step: FIRST_STEP,
        };
        block.stick(Time::ZERO, 0.0);
        block
    }

    /// From now on it moves with the belt, until the spring is as strong as friction can be.
    fn stick(&mut self, now: Time, place: f64) {
        (self.state, self.start) = ([place, BELT_SPEED], now);
        let wait = (STATIC_FRICTION * GRAVITY / STIFFNESS - place) / BELT_SPEED;
        self.queue.set(SLIPS, now.plus(wait.max(0.0)));
    }

    /// Proposes the next segment: a step that is accurate enough, and the catch on it, if there is one.
    fn slip(&mut self, now: Time, state: [f64; 2]) -> Result<(), Infallible> {
        (self.state, self.start) = (state, now);
        let (mut rates, mut end, mut end_rates) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        Slipping.derivative(0.0, &state, &mut rates)?;
        let from = Point { offset: 0.0, state: &state, rates: &rates };
        let length = loop {
            let length = self.next_step;
            self.stepper.step(&mut Slipping, from, length, &mut end)?;
            let error = self.stepper.error_norm(&ERROR_SCALES);
            self.next_step *= self.stepper.method().step_factor(error);
            if error <= 1.0 {
                break length;
            }
        };
        Slipping.derivative(length, &end, &mut end_rates)?;
        let to = Point { offset: length, state: &end, rates: &end_rates };
        self.stepper.dense(&mut Slipping, to, 0..2, &mut self.step)?;
        match self.find_catch(length) {
            Some(offset) => self.queue.set(CAUGHT, now.plus(offset)),
            None => self.queue.set(STEP_ENDS, now.plus(length)),
        }
        Ok(())
    }

    /// Offset [s] on the step at which the velocity comes up to that of the belt: bracketed, then halved down to
    /// rounding.
    fn find_catch(&self, length: f64) -> Option<f64> {
        let slower = |offset: f64| self.step[1].value_at(offset) < BELT_SPEED;
        let at = |look: u32| length * f64::from(look) / f64::from(LOOKS);
        let look = (0..LOOKS).find(|&look| slower(at(look)) && !slower(at(look + 1)))?;
        let (mut before, mut after) = (at(look), at(look + 1));
        while before < 0.5 * (before + after) && 0.5 * (before + after) < after {
            let middle = 0.5 * (before + after);
            if slower(middle) { before = middle } else { after = middle }
        }
        Some(after)
    }
}

impl EventDriven for Block {
    type Report = (Time, Told);
    type Error = Infallible;

    fn next_event(&self) -> Option<Time> {
        self.queue.first().map(|event| event.time)
    }

    fn handle_next(&mut self) -> Result<Option<Self::Report>, Infallible> {
        let Some(event) = self.queue.first() else { return Ok(None) };
        let (now, offset) = (event.time, event.time.since(self.start));
        self.queue.clear(event.source);
        if event.source == SLIPS {
            let place = self.state[0] + BELT_SPEED * offset;
            self.next_step = FIRST_STEP;
            self.slip(now, [place, BELT_SPEED])?;
            return Ok(Some((now, Told::Slips(place))));
        }
        let [place, velocity] = [0, 1].map(|component| self.step[component].value_at(offset));
        if event.source == CAUGHT {
            self.stick(now, place);
            return Ok(Some((now, Told::Caught(place))));
        }
        // Callers need not know of the end of a step.
        self.slip(now, [place, velocity])?;
        Ok(None)
    }
}

fn main() -> Result<(), Infallible> {
    let mut block = Block::new();
    advance_until(&mut block, Time::from_seconds(6.0), |_, (time, told)| match told {
        Told::Slips(place) => println!("{time:.6} s  slips at {place:+.6} m"),
        Told::Caught(place) => println!("{time:.6} s  is caught by the belt at {place:+.6} m"),
    })
}
