//! One contact with friction: the path of its impulse.
//!
//! While the normal impulse P grows from 0, the tangential one grows by k P. Along the first line the contact slides, k = -mu
//! sgn v_t; from where v_t = 0 on it sticks, k = -A_nt/A_tt, or slides the other way if that is beyond the cone, k = -mu sgn
//! A_nt. On each line the rates are linear in P. Compression ends where v_n = 0; where restitution ends depends on what
//! elasticity means. Sources: E. J. Routh, "Dynamics of a system of rigid bodies", 1905, part 1, §187-192; Y. Wang, M. T.
//! Mason, "Two-dimensional rigid-body collisions with friction", J. Appl. Mech. 59, 1992; W. J. Stronge, "Rigid body
//! collisions with friction", Proc. R. Soc. A 431, 1990.

use super::super::NOISE;

/// What elasticity means where there is friction. Without friction all three are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum Restitution {
    /// Its square is the share of the work of compression that restitution gives back (Stronge). Never gains energy.
    #[default]
    Energetic,
    /// The impulse of restitution in units of that of compression (Poisson). Never gains energy in single impacts.
    Poisson,
    /// The speed of separation in units of that of approach (Newton). May gain energy.
    Newton,
}

/// A contact that closes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    /// The entries `A_nn`, `A_nt` and `A_tt` of the Delassus matrix [1/kg].
    pub(super) coupling: [f64; 3],
    /// Normal rate, negative, and slip speed [m/s].
    pub(super) rates: [f64; 2],
    /// Coefficient of friction [-], elasticity, and the share of the slip speed that is given back.
    pub(super) friction: f64,
    pub(super) elasticity: f64,
    pub(super) tangential_elasticity: f64,
    pub(super) restitution: Restitution,
}

/// Its impulses [N s], and the work that friction takes [J].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Blow {
    pub(super) normal: f64,
    pub(super) tangential: f64,
    pub(super) friction_loss: f64,
}

impl Contact {
    /// The impulses.
    pub(super) fn resolve(&self) -> Blow {
        self.bounce_back().unwrap_or_else(|| self.slide())
    }

    /// The impulses that give both rates back, if the contact need not slide for that and gains no energy.
    ///
    /// Sources: O. R. Walton, "Numerical simulation of inelastic, frictional particle-particle interactions", 1993; R. L.
    /// Garwin, "Kinematics of an ultraelastic rough ball", Am. J. Phys. 37, 1969.
    fn bounce_back(&self) -> Option<Blow> {
        let ([nn, nt, tt], [v_n, v_t]) = (self.coupling, self.rates);
        let determinant = nn * tt - nt * nt;
        if self.tangential_elasticity == 0.0 || determinant <= 0.0 {
            return None;
        }
        let wanted = [-(1.0 + self.elasticity) * v_n, -(1.0 + self.tangential_elasticity) * v_t];
        let normal = (tt * wanted[0] - nt * wanted[1]) / determinant;
        let tangential = (nn * wanted[1] - nt * wanted[0]) / determinant;
        let change = normal * (v_n + 0.5 * wanted[0]) + tangential * (v_t + 0.5 * wanted[1]);
        let sticks = normal >= 0.0 && tangential.abs() <= self.friction * normal && change <= 0.0;
        sticks.then(|| Blow { normal, tangential, friction_loss: -tangential * (v_t + 0.5 * wanted[1]) })
    }

    fn slide(&self) -> Blow {
        let ([nn, nt, tt], [v_n, v_t]) = (self.coupling, self.rates);
        let (mu, e) = (self.friction, self.elasticity);
        let first = if v_t == 0.0 { 0.0 } else { -mu * v_t.signum() };
        let braking = nt + first * tt;
        // Where the sliding stops: never, if the slip speed does not fall.
        let stop = match v_t {
            0.0 => 0.0,
            _ if braking * v_t < 0.0 => -v_t / braking,
            _ => f64::INFINITY,
        };
        let sticking = if tt > 0.0 { -nt / tt } else { 0.0 };
        let second = if sticking.abs() <= mu { sticking } else { -mu * nt.signum() };
        let [p1, p2] = [first, second].map(|k| nn + k * nt);
        let slides_on = p1 > 0.0 && -v_n <= p1 * stop;
        // What connectors leave only one way to move comes to rest as its slip stops, and friction holds it there.
        let is_held = second == sticking && p2 <= NOISE * nn;
        let normal = if is_held {
            stop
        } else if slides_on {
            let compression = -v_n / p1;
            let end = (1.0 + e) * compression;
            if end <= stop {
                end
            } else {
                let (left, opening) = (stop - compression, p1 * (stop - compression));
                let further = match self.restitution {
                    Restitution::Poisson => end - stop,
                    Restitution::Newton => (-e * v_n - opening) / p2,
                    Restitution::Energetic => {
                        let work = 0.5 * (e * e * -v_n * compression - p1 * left * left);
                        2.0 * work / (opening + (opening * opening + 2.0 * p2 * work).sqrt())
                    }
                };
                stop + further
            }
        } else {
            let closing = v_n + p1 * stop;
            let compression = stop - closing / p2;
            let further = match self.restitution {
                Restitution::Poisson => e * compression,
                Restitution::Newton => -e * v_n / p2,
                Restitution::Energetic => {
                    let work = -(v_n + closing) * stop - closing * (compression - stop);
                    e * (work / p2).sqrt()
                }
            };
            compression + further
        };
        let (sliding, rest) = (normal.min(stop), (normal - stop).max(0.0));
        let slip = if normal < stop { v_t + braking * normal } else { 0.0 };
        let later = (nt + second * tt) * rest;
        let loss = -0.5 * (first * sliding * (v_t + slip) + second * rest * later);
        Blow { normal, tangential: first * sliding + second * rest, friction_loss: loss }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The needle that strikes with its tip of the plan's table, its tangent turned by +90 degrees from the normal.
    const NEEDLE: [f64; 3] = [1.875_779_745_179_29, 1.363_946_140_238_52, 3.124_220_254_820_71];

    fn strike(friction: f64, slip: f64, restitution: Restitution) -> Contact {
        Contact {
            coupling: NEEDLE,
            rates: [-1.0, -slip],
            friction,
            elasticity: 0.5,
            tangential_elasticity: 0.0,
            restitution,
        }
    }

    #[test]
    fn the_needle_slides_sticks_and_slides_back_as_computed_otherwise() {
        use Restitution::{Energetic, Newton, Poisson};
        // mu, slip speed, law, normal and tangential impulse, rates after, ratio of the energies.
        let table = [
            (0.3, 3.0, Energetic, 0.65646560337739, -0.19693968101322, 0.5, 1.4893333336746, 0.589814537111),
            (0.3, 3.0, Poisson, 0.65646560337739, -0.19693968101322, 0.5, 1.4893333336746, 0.589814537111),
            (0.3, 3.0, Newton, 0.65646560337739, -0.19693968101322, 0.5, 1.4893333336746, 0.589814537111),
            (0.6, 0.3, Energetic, 1.0216111919293, 0.34998257256967, 0.43896020226227, 0.0, 0.243261938141),
            (0.6, 0.3, Poisson, 1.0181386547809, 0.34846656113193, 0.43451424536407, 0.0, 0.238359192967),
            (0.6, 0.3, Newton, 1.0692866350399, 0.370796321701, 0.5, 0.0, 0.315619535721),
            (0.6, 1.5, Energetic, 0.57313290861062, -0.22990619190454, 0.38865076433263, 0.0, 0.145074745639),
            (0.6, 1.5, Poisson, 0.55676240419303, -0.23705309080825, 0.36769128890213, 0.0, 0.129849250579),
            (
                0.25,
                0.2,
                Energetic,
                0.91676344460139,
                0.18257084069714,
                0.4706295070151,
                -0.48002444333017,
                0.191412330047,
            ),
            (
                0.25,
                0.2,
                Poisson,
                0.91518466155972,
                0.18217614493673,
                0.46820640152251,
                -0.4791041847834,
                0.18974874269,
            ),
            (
                0.25,
                1.2,
                Energetic,
                0.68759705807667,
                -0.10782085820005,
                0.43684247776425,
                -0.074701462483784,
                0.202850237695,
            ),
            (
                0.25,
                1.2,
                Poisson,
                0.67666132120989,
                -0.11055479241674,
                0.42005838307346,
                -0.068327119048821,
                0.188774593829,
            ),
        ];
        let [nn, nt, tt] = NEEDLE;
        // The kinetic energy that an impact can change, by the inverse of the Delassus matrix.
        let energy = |v: [f64; 2]| {
            (tt * v[0] * v[0] - 2.0 * nt * v[0] * v[1] + nn * v[1] * v[1]) / (nn * tt - nt * nt)
        };
        for (mu, slip, law, normal, tangential, v_n, v_t, _) in table {
            let contact = strike(mu, slip, law);
            let blow = contact.resolve();
            let after = [
                -1.0 + nn * blow.normal + nt * blow.tangential,
                -slip + nt * blow.normal + tt * blow.tangential,
            ];
            // The table has its tangent turned the other way.
            let found = [blow.normal, -blow.tangential, after[0], -after[1]];
            for (found, known) in found.iter().zip([normal, tangential, v_n, v_t]) {
                assert!((found - known).abs() < 1e-12, "mu {mu}, {slip} m/s, {law:?}: {found} for {known}");
            }
            // What friction takes and what restitution does not give back is what the energy loses.
            let lost = 0.5 * (energy([-1.0, -slip]) - energy(after));
            let by_normal = -blow.normal * 0.5 * (after[0] - 1.0);
            assert!(blow.friction_loss > -1e-15 && lost > 0.0);
            if blow.normal * mu <= blow.tangential.abs() + 1e-12 {
                assert!((lost - by_normal - blow.friction_loss).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn what_one_pin_holds_is_held_by_friction_for_good() {
        // A body that turns about a pin: along its one way both rates go together, up to rounding.
        for (a, b) in [(0.3, 1.1), (-0.7, 0.9), (1e-3, 0.5)] {
            for rounding in [-1e-15, 0.0, 1e-15] {
                let turn = -1.0 / a;
                let contact = Contact {
                    coupling: [a * a * (1.0 + rounding), a * b, b * b],
                    rates: [a * turn, b * turn],
                    friction: 0.9,
                    elasticity: 0.5,
                    tangential_elasticity: 0.0,
                    restitution: Restitution::Energetic,
                };
                let blow = contact.resolve();
                let turned = a * blow.normal + b * blow.tangential;
                assert!((turned + turn).abs() < 1e-9 * turn.abs(), "{a}, {b}, {rounding}: {blow:?}");
            }
        }
    }

    #[test]
    fn a_rough_ball_gives_back_its_spin() {
        // Elastic in both ways, a disc on a plane: both rates are turned round.
        let contact = Contact {
            coupling: [1.0, 0.0, 3.0],
            rates: [-2.0, 0.5],
            friction: 10.0,
            elasticity: 1.0,
            tangential_elasticity: 1.0,
            restitution: Restitution::Energetic,
        };
        let blow = contact.resolve();
        assert_eq!((blow.normal, blow.tangential, blow.friction_loss), (4.0, -1.0 / 3.0, 0.0));
        // With little friction it slides.
        let smooth = Contact { friction: 0.01, ..contact }.resolve();
        assert_eq!((smooth.normal, smooth.tangential), (4.0, -0.04));
    }
}
