//! Impacts that laws once answered wrongly.

use halfgap_collision::BodyId;
use halfgap_contact::{CollisionRow, Impact, ImpactLaw, ImpactOrder, InverseInertia, RowKind};

/// Bodies, normal, moments about both, rate [m/s], `velocity_tol` [m/s], and whether the row is bilateral.
type Data = ([u32; 2], [f64; 2], [f64; 2], f64, f64, bool);

/// 1/kg and 1/(kg m^2) of four bodies.
const INERTIAS: [(f64, f64); 4] = [
    (0.001171199501359331, 0.0020335688983657138),
    (0.08548803352005865, 0.0034473132037494384),
    (2.720217716159686, 520.566567645847),
    (95.4500254620305, 28.595119678542567),
];

/// Ten pins and four contacts, all elastic, of which a good many depend on others.
const ROWS: [Data; 14] = [
    (
        [0, 2],
        [-0.5738876350892621, 0.8189340524679958],
        [0.7530346224977227, -0.36705376601751194],
        -1.4984185301606332,
        0.5,
        false,
    ),
    (
        [3, 2],
        [0.23358968098409733, -0.9723352615933187],
        [0.7692068751397254, -0.6566494611925509],
        -2.3173383153360065,
        0.5,
        true,
    ),
    (
        [2, 0],
        [0.7696682923297076, -0.6384439832767412],
        [-0.40577717380550404, 0.013823956531664239],
        -1.1985371637464697,
        0.001,
        true,
    ),
    (
        [2, 3],
        [0.18611070041535652, 0.9825287818638726],
        [-0.5094290169749105, 0.31439773870116916],
        -2.4963509726608377,
        0.001,
        true,
    ),
    (
        [1, 2],
        [-0.8434276802708597, 0.537242727408121],
        [0.668113751965753, 0.861304843111252],
        -0.43788900074114423,
        0.001,
        false,
    ),
    (
        [1, 0],
        [-0.5332674235602953, -0.84594672111745],
        [-0.4297496617787584, 0.5142964743762171],
        -1.856739553721173,
        0.5,
        true,
    ),
    (
        [0, 3],
        [0.9448102320118057, -0.3276181092152843],
        [0.16224336751697432, 0.9949007372262748],
        -2.671019624565758,
        0.001,
        true,
    ),
    (
        [2, 1],
        [-0.033609940752925796, 0.9994350263436762],
        [-0.7183723141181935, 0.5090652632207688],
        -2.993575933942968,
        0.5,
        true,
    ),
    (
        [2, 1],
        [0.9961931555322638, 0.08717337248650377],
        [-0.6162298552505963, 0.9060245777698148],
        -2.9041004610051653,
        0.001,
        true,
    ),
    (
        [3, 2],
        [-0.999271302935149, 0.03816887646092953],
        [-0.9160408557854902, 0.3876276979708351],
        -0.6359437056056627,
        0.001,
        false,
    ),
    (
        [1, 0],
        [-0.47514641458830925, -0.8799067477317551],
        [0.0802542450781143, 0.508973098306041],
        -2.4887315448632785,
        0.5,
        false,
    ),
    (
        [1, 3],
        [0.06382387090842322, -0.9979611783542809],
        [0.0004731113078912941, -0.16284946782572196],
        -0.6801614449585823,
        0.001,
        true,
    ),
    (
        [2, 3],
        [0.36372735976575954, 0.9315054523500277],
        [-0.02855281773057916, 0.22778724107733983],
        -2.518740008454798,
        0.5,
        true,
    ),
    (
        [0, 2],
        [-0.8639533553079374, 0.5035718417983247],
        [-0.8245648986652476, 0.28534959725039566],
        -0.38506458507644437,
        0.5,
        false,
    ),
];

#[test]
fn rows_that_no_impulses_hold_are_not_driven() {
    let inertia = |body: u32| {
        let (inverse_mass, inverse_moment) = INERTIAS[body as usize];
        InverseInertia { inverse_mass, inverse_moment }
    };
    for law in [ImpactLaw::Simultaneous, ImpactLaw::Hybrid, ImpactLaw::SerialGrouped] {
        let mut impact = Impact::new();
        impact.set_rows(ROWS.map(|(bodies, [x, y], turns, rate, slow, bilateral)| {
            let jacobian = [x, y, turns[0], -x, -y, turns[1]];
            CollisionRow {
                elasticity: 1.0,
                velocity_tol: slow,
                kind: RowKind::plain(bilateral),
                ..CollisionRow::new(bodies.map(BodyId), jacobian, bodies.map(inertia), rate)
            }
        }));
        law.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("they can be stopped");
        let rows = impact.rows().iter().zip(impact.impulses()).zip(impact.rates());
        let work: f64 = rows.map(|((row, impulse), rate)| 0.5 * impulse * (row.rate + rate)).sum();
        assert!((-400.0..0.0).contains(&work), "{law:?}: {work} J");
        assert!(impact.bound() < 1e-3, "{law:?}: {} m/s", impact.bound());
    }
}
