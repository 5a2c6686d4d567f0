//! Bimatrix games: costs to two players, and the strategies from which neither gains by turning alone.

use halfgap_contact::{Auto, Lemke, Problem, Solution, Solver};
use proptest::prelude::*;

use super::data::judge;

/// Costs to both players of a game, by the first one's strategies, then the second one's.
type Costs = Vec<Vec<[f64; 2]>>;

/// The problem of a game, w = -1 + [0 A; Bᵀ 0] z, with its rows sorted by keys, and b scaled by a unit.
fn game(costs: &Costs, keys: &[u32], unit: f64) -> Problem {
    let (m, n) = (costs.len(), costs[0].len());
    let mut order: Vec<usize> = (0..m + n).collect();
    order.sort_by_key(|&row| keys.get(row));
    let mut place = vec![0; m + n];
    order.iter().enumerate().for_each(|(at, &row)| place[row] = at);
    let mut triplets = Vec::new();
    for (i, costs) in costs.iter().enumerate() {
        for (j, &[first, second]) in costs.iter().enumerate() {
            triplets.push((place[i], place[m + j], first));
            triplets.push((place[m + j], place[i], second));
        }
    }
    Problem::from_general(&triplets, &vec![-unit; m + n]).unwrap()
}

fn any_costs() -> impl Strategy<Value = Costs> {
    // Costs that are small integers tie often.
    let cost = prop_oneof![(1..6_u32).prop_map(f64::from), 0.01..100.0_f64];
    let cost = prop::array::uniform2(cost);
    (1..9_usize, 1..9_usize)
        .prop_flat_map(move |(m, n)| prop::collection::vec(prop::collection::vec(cost.clone(), n), m))
}

proptest! {
    #[test]
    fn games_are_solved(costs in any_costs(), keys in prop::collection::vec(any::<u32>(), 16), unit in 1e-3..1e3_f64) {
        let problem = game(&costs, &keys, unit);
        let mut solution = Solution::new();
        Lemke::default().solve(&problem, &mut solution).unwrap();
        let judged = judge(&problem, &solution.force);
        prop_assert!(judged.good(), "{:?}", judged);
    }
}

#[test]
fn a_mixed_equilibrium_is_found() {
    // Each player pays 2 or 1, 1 or 3; only mixing makes the other's strategies cost the same.
    let problem = game(&vec![vec![[2.0, 1.0], [1.0, 3.0]], vec![[1.0, 3.0], [2.0, 1.0]]], &[], 1.0);
    let mut solution = Solution::new();
    Auto::default().solve(&problem, &mut solution).unwrap();
    let expected = [0.25, 0.25, 1.0 / 3.0, 1.0 / 3.0];
    let wrong = solution.force.iter().zip(expected).map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
    assert!(wrong < 1e-15, "{:?}", solution.force);
}

#[test]
fn games_of_many_strategies_are_solved() {
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        1.0 + (state >> 40) as f64 / (1_u64 << 24) as f64
    };
    for size in [20, 40, 80] {
        let costs: Costs = (0..size).map(|_| (0..size + 5).map(|_| [next(), next()]).collect()).collect();
        let mut solution = Solution::new();
        let problem = game(&costs, &[], 1.0);
        Lemke::default().solve(&problem, &mut solution).unwrap();
        assert!(judge(&problem, &solution.force).good(), "{size}");
    }
}
