//! The complementarity problem of an event's candidates.

use crate::rigid::active_set::choosing::places_of;
use crate::rigid::active_set::pulls::list_pulls;
use crate::rigid::active_set::settling::Settling;
use crate::rigid::active_set::slips::list_slips;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::group::physics::physics;
use crate::rigid::group::segment::LONGEST_STEP;
use crate::rigid::group::stage::Stage;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::ROUNDED;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyAcceleration, BodyId, Collision};

/// Finds the accelerations of a region's bodies without the forces of rows.
pub(super) fn accelerate_region(
    assembly: &Assembly,
    connectors: &Connectors,
    region: &Region,
    settling: &mut Settling,
    stage: &mut Stage,
    time: Time,
) {
    for &body in region.bodies() {
        stage.place(body, assembly.trajectory(body).moving_at(time));
    }
    assembly.force_laws().list(region.bodies(), &mut settling.force_laws);
    let physics = physics(assembly, connectors);
    let of_region = (region.bodies(), settling.force_laws.as_slice(), &[][..]);
    stage.accelerate(&physics, of_region, time.seconds(), &[], &mut []);
}

/// Poses the problem of the candidates: their normal rows, behind them the slips of those that may stick, and then what pulls.
pub(super) fn pose_problem(
    assembly: &Assembly,
    connectors: &Connectors,
    region: &Region,
    settling: &mut Settling,
    stage: &Stage,
) {
    list_slips(assembly, connectors, region, settling);
    list_pulls(assembly, connectors, region, settling, assembly.now());
    let Settling { problem, candidates, slips, pulls, jumps, slack, .. } = settling;
    let least = f64::EPSILON * assembly.settings().tolerances.accuracy / (LONGEST_STEP * LONGEST_STEP);
    region.begin(problem, |body| assembly.inertia(body));
    // Accelerations that move nothing in the longest time are rounding, as are those that remain of
    // accelerations across the normal.
    let sound = |record: &Collision, offset: f64| {
        let least = least.max(ROUNDED * largest_acceleration(region, record, stage));
        if offset.abs() > least { offset } else { 0.0 }
    };
    let mut turns = slips.iter().filter_map(|slip| Some((slip.place, slip.turn()?))).peekable();
    for (place, &index) in candidates.iter().enumerate() {
        let record = &region.records()[index];
        let offset = sound(record, free_offset(assembly, region, record, stage));
        let mut turn = turns.next_if(|(turned, _)| *turned == place).map(|(_, turn)| turn);
        // It may slip along both axes.
        while let Some((_, more)) = turns.next_if(|(turned, _)| *turned == place) {
            turn = turn.map(|turn| std::array::from_fn(|k| turn[k] + more[k]));
        }
        let Some(row) = region.row_of(record, offset) else { continue };
        let row = match turn {
            Some(turn) => region.turned(row, record, &turn),
            None => row,
        };
        problem.add_row(&row).expect("a row of finite numbers on bodies of the problem");
    }
    for slip in slips.iter_mut().filter(|slip| slip.side.is_none()) {
        let record = &region.records()[candidates[slip.place]];
        let sides = (assembly, stage.accelerations());
        let [a, b] = accelerations_of_sides(region, record.bodies(), sides);
        let offset = sound(record, slip.row.acceleration(&a, &b));
        let Some(row) = region.row_along(record, &slip.row.jacobian, offset) else { continue };
        let row = row.friction(slip.place, slip.bound(*jumps, *slack));
        slip.number = Some(problem.add_row(&row).expect("a row of finite numbers beside that of its gap"));
    }
    for pull in pulls {
        let sides = (assembly, stage.accelerations());
        let [a, b] = accelerations_of_sides(region, pull.bodies, sides);
        let kinematics = &pull.row.kinematics;
        let offset = kinematics.acceleration(&a, &b);
        let row = region.row_between(pull.bodies, &kinematics.jacobian, offset);
        let [least, most] = pull.bounds(*slack);
        pull.number = row.and_then(|row| problem.add_row(&row.bounded(least, most)).ok());
    }
}

/// Acceleration [m/s^2] of a record's gap without the forces of rows.
fn free_offset(assembly: &Assembly, region: &Region, record: &Collision, stage: &Stage) -> f64 {
    offset_under(assembly, region, record, stage.accelerations())
}

/// Acceleration [m/s^2] of a record's gap under given accelerations of the region's bodies.
pub(super) fn offset_under(
    assembly: &Assembly,
    region: &Region,
    record: &Collision,
    accelerations: &[[f64; 3]],
) -> f64 {
    let [a, b] = accelerations_of_sides(region, record.bodies(), (assembly, accelerations));
    let of_two = record.motion.kinematics.acceleration(&a, &b);
    match record.parties.third {
        Some((body, j)) => match region.place(body) {
            Some(place) => of_two + j * accelerations[place][2],
            None => of_two + j * assembly.prescribed_acceleration(body).angular,
        },
        None => of_two,
    }
}

fn accelerations_of_sides(
    region: &Region,
    bodies: [BodyId; 2],
    (assembly, accelerations): (&Assembly, &[[f64; 3]]),
) -> [BodyAcceleration; 2] {
    bodies.map(|body| match region.place(body) {
        Some(place) => body_acceleration(accelerations[place]),
        None => assembly.prescribed_acceleration(body),
    })
}

/// Largest acceleration [m/s^2] of the centre of a record's bodies without the forces of rows.
fn largest_acceleration(region: &Region, record: &Collision, stage: &Stage) -> f64 {
    let linear = places_of(region, record)
        .map(|place| body_acceleration(stage.accelerations()[place]).linear.length());
    linear.fold(0.0, f64::max)
}

fn body_acceleration([x, y, angular]: [f64; 3]) -> BodyAcceleration {
    BodyAcceleration { linear: DVec2::new(x, y), angular }
}
