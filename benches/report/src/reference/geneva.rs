//! A Geneva drive without friction: when it dwells, when it indexes, and how far it has turned at any time.
//!
//! Crank and wheel turn about pivots at a distance c. The pin, a disc at the crank's radius r, has a play of
//! d to either wall of a slot. Seen from the wheel's pivot it is at P(phi) = (c - r cos phi, r sin phi), with
//! the crank at phi from the line of pivots. While it touches a wall, the slot is at psi = arg P -+
//! asin(d/|P|), the sign minus for the wall ahead of it and plus for that behind; without play this is the
//! psi = atan(sin phi/(c/r - cos phi)) of the textbooks. From y = +-d, with y the pin's distance from the
//! middle of the slot and x that along it, psi' = r cos(phi + psi)/x.
//!
//! With r + d = c sin(pi/n) the crank is square to the slot where pin and slot meet and where they part: the
//! wheel starts from rest without a shock and is left at rest, with the next slot in place. In between,
//! energy gives the crank's rate and quadrature the time. The wall ahead is let go where psi' is largest, for
//! there the wheel would have to be pulled on; both bodies then turn evenly until the wall behind catches the
//! pin, in an impact without elasticity. That costs the same part of the energy at every index, after which
//! the crank goes through the dwell at an even, lower rate.
//!
//! A crank that is driven at an even rate has an infinite moment of inertia: all of the above holds with a ratio of 0.

use super::one_freedom::OneFreedom;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Sizes and inertias of a drive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Geneva {
    /// Slots of the wheel.
    pub(crate) slots: u32,
    /// Distance of the pivots [m].
    pub(crate) distance: f64,
    /// Play of the pin to either wall [m].
    pub(crate) play: f64,
    /// Moments of inertia about the pivots [kg m^2]: of the crank with its pin, and of the wheel.
    pub(crate) moments: [f64; 2],
}

/// Angles [rad] of crank and wheel, and their rates [rad/s].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turned {
    /// The crank, from the line of pivots.
    pub(crate) crank: f64,
    /// The middle of the slot that was the first to be entered.
    pub(crate) wheel: f64,
    /// Their rates.
    pub(crate) rates: [f64; 2],
}

/// Which wall the pin touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wall {
    Ahead,
    Behind,
}

/// One index, of a crank that enters at 1 rad/s; times of others are in inverse proportion.
struct Index {
    /// Where the wall ahead is let go, and where the wall behind catches the pin [rad].
    release: f64,
    catch: f64,
    /// Times of both, and of the end [s].
    times: [f64; 3],
    /// Rates of crank and wheel in between [rad/s].
    free: [f64; 2],
    /// Twice the energy over the crank's moment, before and after the catch [rad^2/s^2].
    energies: [f64; 2],
}

/// Longest piece of the quadrature [rad].
const PIECE: f64 = 0.02;
/// Halvings of an interval until nothing is left of it.
const HALVINGS: usize = 60;
/// Steps in which the catch is looked for.
const STEPS: u32 = 1000;

impl Geneva {
    /// Radius of the pin's path [m].
    pub(crate) fn radius(&self) -> f64 {
        self.distance * self.half_pitch().sin() - self.play
    }

    /// Half the angle between two slots [rad].
    pub(crate) fn half_pitch(&self) -> f64 {
        PI / f64::from(self.slots)
    }

    /// Half the angle through which the crank turns while it is in a slot [rad].
    pub(crate) fn half_index(&self) -> f64 {
        FRAC_PI_2 - self.half_pitch()
    }

    /// The state at a time [s], and how far the crank's angle may be off [rad], when the crank starts before the first
    /// slot at `start` [rad] with a rate [rad/s] and the wheel rests with that slot in place.
    pub(crate) fn at(&self, time: f64, start: f64, rate: f64) -> (Turned, f64) {
        let index = self.index();
        let (enter, end) = (-self.half_index(), index.times[2]);
        let loss = index.energies[1].sqrt();
        let (mut crank, mut rate, mut left) = (start, rate, time);
        for turn in 0.. {
            let wheel = f64::from(turn) * 2.0 * self.half_pitch() - self.half_pitch();
            let lap = TAU * f64::from(turn);
            let dwell = (lap + enter - crank) / rate;
            if left <= dwell {
                return (Turned { crank: crank + rate * left, wheel, rates: [rate, 0.0] }, 0.0);
            }
            left -= dwell;
            if left * rate < end {
                let (inside, doubt) = self.within(&index, left * rate);
                let turned = Turned {
                    crank: lap + inside.crank,
                    wheel: wheel + self.half_pitch() + inside.wheel,
                    rates: inside.rates.map(|unit| unit * rate),
                };
                return (turned, doubt);
            }
            left -= end / rate;
            rate *= loss;
            crank = lap - enter;
        }
        unreachable!("the crank never stops")
    }

    /// Angle of the slot [rad] while the pin touches a wall, and its derivative by the crank's.
    fn slot(&self, crank: f64, wall: Wall) -> (f64, f64) {
        let (x, y) = (self.distance - self.radius() * crank.cos(), self.radius() * crank.sin());
        let lean = (self.play / x.hypot(y)).asin();
        let angle = y.atan2(x) + if wall == Wall::Ahead { -lean } else { lean };
        (angle, self.radius() * (crank + angle).cos() / self.along(crank))
    }

    /// How far along the slot the pin is [m] while it touches a wall.
    fn along(&self, crank: f64) -> f64 {
        let (x, y) = (self.distance - self.radius() * crank.cos(), self.radius() * crank.sin());
        (x * x + y * y - self.play * self.play).sqrt()
    }

    /// Second derivative of the slot's angle by the crank's, while the pin touches a wall.
    fn bend(&self, crank: f64, wall: Wall) -> f64 {
        let (r, along) = (self.radius(), self.along(crank));
        let (angle, slope) = self.slot(crank, wall);
        let moves_along = self.distance * r * crank.sin() / along;
        -r * (crank + angle).sin() * (1.0 + slope) / along
            - r * (crank + angle).cos() * moves_along / (along * along)
    }

    /// Rate of the crank [rad/s] where the pin touches a wall.
    fn rate(&self, crank: f64, wall: Wall, energy: f64) -> f64 {
        let slope = self.slot(crank, wall).1;
        (energy / (1.0 + self.moments[1] / self.moments[0] * slope * slope)).sqrt()
    }

    fn index(&self) -> Index {
        let ratio = self.moments[1] / self.moments[0];
        let end = self.half_index();
        let release = root(-end, end, |crank| self.bend(crank, Wall::Ahead));
        let (angle, slope) = self.slot(release, Wall::Ahead);
        let crank_rate = self.rate(release, Wall::Ahead, 1.0);
        // Both turn evenly: the wheel by `slope` for each turn of the crank.
        let play = |crank: f64| self.slot(crank, Wall::Behind).0 - angle - slope * (crank - release);
        let step = (end - release) / f64::from(STEPS);
        let after = (1..=STEPS).map(|count| release + step * f64::from(count));
        let past = after.into_iter().find(|&crank| play(crank) < 0.0).unwrap_or(end);
        let catch = root(past - step, past, play);
        // What the impact leaves as it is: the momentum along the motion that the wall allows.
        let behind = self.slot(catch, Wall::Behind).1;
        let joined = 1.0 + ratio * behind * behind;
        let after = crank_rate * (1.0 + ratio * behind * slope) / joined;
        let energies = [1.0, after * after * joined];
        let mut index =
            Index { release, catch, times: [0.0; 3], free: [crank_rate, slope * crank_rate], energies };
        let released = self.motion(&index, Wall::Ahead, &|crank| self.rate(crank, Wall::Ahead, 1.0), release);
        let caught = released + (catch - release) / crank_rate;
        let last =
            self.motion(&index, Wall::Behind, &|crank| self.rate(crank, Wall::Behind, energies[1]), end);
        index.times = [released, caught, caught + last];
        index
    }

    /// Time [s] that the pin takes along a wall to a place.
    fn motion(&self, index: &Index, wall: Wall, rate: &dyn Fn(f64) -> f64, to: f64) -> f64 {
        let start = if wall == Wall::Ahead { -self.half_index() } else { index.catch };
        OneFreedom { rate, start, kinks: Vec::new(), piece: PIECE }.time_of(to)
    }

    /// The state at a time of an index, and how far the crank may be off.
    fn within(&self, index: &Index, time: f64) -> (Turned, f64) {
        let [released, caught, _] = index.times;
        if (released..caught).contains(&time) {
            let since = time - released;
            let angle = self.slot(index.release, Wall::Ahead).0;
            let [crank, wheel] = index.free;
            let turned = Turned {
                crank: index.release + crank * since,
                wheel: angle + wheel * since,
                rates: index.free,
            };
            return (turned, 0.0);
        }
        let (wall, start, since) = match time < released {
            true => (Wall::Ahead, -self.half_index(), time),
            false => (Wall::Behind, index.catch, time - caught),
        };
        let energy = index.energies[usize::from(wall == Wall::Behind)];
        let rate = |crank: f64| self.rate(crank, wall, energy);
        let (crank, doubt) = OneFreedom { rate: &rate, start, kinks: Vec::new(), piece: PIECE }.at(since);
        let (wheel, slope) = self.slot(crank, wall);
        (Turned { crank, wheel, rates: [rate(crank), slope * rate(crank)] }, doubt)
    }
}

/// The root of a function that changes sign between two places, by halving.
fn root(mut from: f64, mut to: f64, value: impl Fn(f64) -> f64) -> f64 {
    let sign = value(from).signum();
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        if value(middle).signum() == sign { from = middle } else { to = middle }
    }
    0.5 * (from + to)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRIVE: Geneva = Geneva { slots: 6, distance: 1.0, play: 0.002, moments: [2.0, 0.3] };

    #[test]
    fn without_play_the_slot_follows_the_closed_form() {
        let drive = Geneva { play: 0.0, ..DRIVE };
        for crank in [-1.0_f64, -0.3, 0.2, 0.9] {
            let known = (crank.sin() / (drive.distance / drive.radius() - crank.cos())).atan();
            for wall in [Wall::Ahead, Wall::Behind] {
                assert!((drive.slot(crank, wall).0 - known).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_derivatives_of_the_slot_fit() {
        let step = 1e-5;
        for wall in [Wall::Ahead, Wall::Behind] {
            for crank in [-0.9, -0.2, 0.1, 0.7] {
                let [before, after] = [crank - step, crank + step].map(|crank| DRIVE.slot(crank, wall));
                assert!(((after.0 - before.0) / (2.0 * step) - DRIVE.slot(crank, wall).1).abs() < 1e-9);
                assert!(((after.1 - before.1) / (2.0 * step) - DRIVE.bend(crank, wall)).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn the_wheel_starts_from_rest_and_is_left_at_rest_one_pitch_on() {
        let (enter, leave) = (-DRIVE.half_index(), DRIVE.half_index());
        let (first, slope) = DRIVE.slot(enter, Wall::Ahead);
        assert!((first + DRIVE.half_pitch()).abs() < 1e-15 && slope.abs() < 1e-15, "{first} {slope}");
        let (last, slope) = DRIVE.slot(leave, Wall::Behind);
        assert!((last - DRIVE.half_pitch()).abs() < 1e-15 && slope.abs() < 1e-15, "{last} {slope}");
    }

    #[test]
    fn walls_push_and_never_pull_and_the_pin_stays_between_them() {
        let index = DRIVE.index();
        for part in (1..100).map(|count| f64::from(count) / 100.0) {
            let ahead = -DRIVE.half_index() + part * (index.release + DRIVE.half_index());
            assert!(DRIVE.bend(ahead, Wall::Ahead) > 0.0, "pulls at {ahead}");
            let behind = index.catch + part * (DRIVE.half_index() - index.catch);
            assert!(DRIVE.bend(behind, Wall::Behind) < 0.0, "pulls at {behind}");
            let between = index.release + part * (index.catch - index.release);
            let turned = DRIVE.slot(index.release, Wall::Ahead).0
                + index.free[1] / index.free[0] * (between - index.release);
            assert!(
                turned > DRIVE.slot(between, Wall::Ahead).0 && turned < DRIVE.slot(between, Wall::Behind).0
            );
        }
    }

    #[test]
    fn an_index_takes_its_time_and_a_heavier_crank_loses_less() {
        let light = DRIVE.index();
        let heavy = Geneva { moments: [2e6, 0.3], ..DRIVE }.index();
        assert!(light.energies[1] < heavy.energies[1] && heavy.energies[1] < 1.0);
        // So heavy a crank turns evenly.
        assert!((heavy.times[2] - 2.0 * DRIVE.half_index()).abs() < 1e-6);
        let (before, _) = DRIVE.at(10.0, -2.0, 1.0);
        let turns = before.crank / TAU;
        assert!(turns > 1.0 && before.rates[0] < 1.0);
    }
}
