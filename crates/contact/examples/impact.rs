//! A block lands flat: its two lower corners touch the floor at once. Its motion afterwards depends on the impact law.
//!
//! `cargo run -p halfgap-contact --example impact`

use halfgap_collision::BodyId;
use halfgap_contact::{CollisionRow, Impact, ImpactError, ImpactLaw, ImpactOrder, RowKind};

/// Mass of the block [kg].
const MASS: f64 = 2.0;
/// Width of the block [m].
const WIDTH: f64 = 1.0;
/// Height of the block [m].
const HEIGHT: f64 = 0.5;
/// Speed [m/s] at which the block comes down.
const SPEED: f64 = 3.0;

/// The row of a lower corner against the fixed floor; `side` is -1 for the left and +1 for the right corner.
fn corner(side: f64, elasticity: f64) -> CollisionRow {
    let moment = MASS * (WIDTH * WIDTH + HEIGHT * HEIGHT) / 12.0;
    // The gap grows with the block's y, and with its angle by the corner's arm: J = [n, R x n] with n = +y.
    let arm = 0.5 * WIDTH * side;
    CollisionRow {
        bodies: [BodyId(0), BodyId(1)],
        jacobian: [0.0, 1.0, arm, 0.0, -1.0, -arm],
        response: [0.0, 1.0 / MASS, arm / moment, 0.0, 0.0, 0.0],
        third: None,
        elasticity,
        velocity_tol: 1e-9,
        kind: RowKind::Unilateral,
        was_active: false,
        rate: -SPEED,
    }
}

fn main() -> Result<(), ImpactError> {
    println!("A block of {MASS} kg comes down flat at {SPEED} m/s.\n");
    println!("elasticity  law                 left      right     up        spin      energy left");
    for elasticity in [1.0, 0.5] {
        for law in [ImpactLaw::Simultaneous, ImpactLaw::SerialSeparate] {
            let mut impact = Impact::new();
            impact.set_rows([corner(-1.0, elasticity), corner(1.0, elasticity)]);
            law.resolve(&mut impact, ImpactOrder::Fastest, 0)?;
            let (mut up, mut spin) = (-SPEED, 0.0);
            for (row, impulse) in impact.rows().iter().zip(impact.impulses()) {
                up += row.response[1] * impulse;
                spin += row.response[2] * impulse;
            }
            let moment = MASS * (WIDTH * WIDTH + HEIGHT * HEIGHT) / 12.0;
            let energy = (MASS * up * up + moment * spin * spin) / (MASS * SPEED * SPEED);
            let [left, right] = [impact.impulses()[0], impact.impulses()[1]];
            println!(
                "{elasticity:<11} {:<16} {left:7.3} Ns {right:7.3} Ns {up:5.2} m/s {spin:5.2} rad/s  {:5.1} %",
                format!("{law:?}"),
                100.0 * energy
            );
        }
    }
    println!(
        "\nSolved together, both corners push alike and the block stays level. One after the other, each corner"
    );
    println!("throws the block onto the other one, until both rise.");
    Ok(())
}
