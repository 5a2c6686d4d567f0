//! Coefficients of the method of order 5 of Dormand and Prince, with a dense output of order 4.
//!
//! Source: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., Springer
//! 1993, II.5, table 5.2; II.6, (6.12) and the authors' program for L. F. Shampine's dense output.

use super::method::Method;
use super::tableau::{Stage, Tableau, Term};

pub(super) const DORMAND_PRINCE5: Tableau = Tableau {
    method: Method::DormandPrince5,
    stages: &STAGES,
    weights: &WEIGHTS,
    errors: &[&ERROR],
    needs_end_rates: true,
    dense_stages: &[],
    dense_rows: &[&DENSE_5],
    swing: None,
};

const STAGES: [Stage; 5] = [
    Stage { node: 0.2, terms: &[(0, 0.2)] },
    Stage { node: 0.3, terms: &[(0, 3.0 / 40.0), (1, 9.0 / 40.0)] },
    Stage { node: 0.8, terms: &[(0, 44.0 / 45.0), (1, -56.0 / 15.0), (2, 32.0 / 9.0)] },
    Stage {
        node: 8.0 / 9.0,
        terms: &[(0, 19372.0 / 6561.0), (1, -25360.0 / 2187.0), (2, 64448.0 / 6561.0), (3, -212.0 / 729.0)],
    },
    Stage {
        node: 1.0,
        terms: &[
            (0, 9017.0 / 3168.0),
            (1, -355.0 / 33.0),
            (2, 46732.0 / 5247.0),
            (3, 49.0 / 176.0),
            (4, -5103.0 / 18656.0),
        ],
    },
];

const WEIGHTS: [Term; 5] =
    [(0, 35.0 / 384.0), (2, 500.0 / 1113.0), (3, 125.0 / 192.0), (4, -2187.0 / 6784.0), (5, 11.0 / 84.0)];

/// The weights less those of a formula of order 4 that uses the rates at the end too.
const ERROR: [Term; 6] = [
    (0, 71.0 / 57600.0),
    (2, -71.0 / 16695.0),
    (3, 71.0 / 1920.0),
    (4, -17253.0 / 339200.0),
    (5, 22.0 / 525.0),
    (6, -1.0 / 40.0),
];

const DENSE_5: [Term; 6] = [
    (0, -12715105075.0 / 11282082432.0),
    (2, 87487479700.0 / 32700410799.0),
    (3, -10690763975.0 / 1880347072.0),
    (4, 701980252875.0 / 199316789632.0),
    (5, -1453857185.0 / 822651844.0),
    (6, 69997945.0 / 29380423.0),
];
