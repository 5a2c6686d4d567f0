//! Exact scenes: the error obtained is below the error asked for, and follows the tolerance.

use halfgap_tests::{check_at, reference_scene};

/// Errors below this [m] are rounding.
const ROUNDING: f64 = 3e-12;

fn error(name: &str, tolerance: f64) -> f64 {
    let report = check_at(&reference_scene(name), Some(tolerance));
    assert!(!report.why.iter().any(|why| why.contains("not reached")), "{name}: {:?}", report.why);
    report.position_error.expect("positions are compared")
}

/// Slope of the straight line through log error against log tolerance, from 1e-4 down to rounding.
fn slope(name: &str) -> f64 {
    let points: Vec<(f64, f64)> = (4..=12)
        .map(|power| 10f64.powi(-power))
        .map(|tolerance| (tolerance.log10(), error(name, tolerance)))
        .take_while(|&(_, error)| error > ROUNDING)
        .map(|(tolerance, error)| (tolerance, error.log10()))
        .collect();
    println!("{name}: {points:.2?}");
    assert!(points.len() >= 5, "{name}: errors fall to rounding at once: {points:?}");
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let over: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    over / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>()
}

macro_rules! exact_scene {
    ($test:ident, $name:expr, $finest:expr) => {
        mod $test {
            use super::{error, slope};

            #[test]
            fn is_right_to_1e_7_m_at_1e_9() {
                let error = error($name, 1e-9);
                assert!(error < 1e-7, "{error} m");
            }

            #[test]
            fn is_right_to_rounding_at_1e_12() {
                let error = error($name, 1e-12);
                println!("{}: {error:e} m at 1e-12", $name);
                assert!(error < $finest, "{error} m");
            }

            #[test]
            fn has_errors_in_proportion_to_the_tolerance() {
                let slope = slope($name);
                println!("{}: slope {slope:.3}", $name);
                assert!((0.8..=1.2).contains(&slope), "slope {slope}");
            }
        }
    };
}

exact_scene!(a_pendulum, "exact__pendulum", 1e-10);
exact_scene!(a_double_pendulum, "exact__double_pendulum", 1e-10);
exact_scene!(a_disc_in_a_bowl, "exact__disc_in_bowl", 1e-10);
// Six discs, each a target gap from the next: the gap is a hundredth of the tolerance, or the least that coordinates
// allow.
exact_scene!(newtons_cradle, "exact__newtons_cradle", 1e-11);
exact_scene!(a_ball_that_bounces, "exact__ball_bounce", 1e-10);
