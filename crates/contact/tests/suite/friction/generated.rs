//! Generated problems with friction: walls of bricks and heaps of discs, at velocity level.

use halfgap_contact::{InverseInertia, Problem, ProblemBody, Row};

/// Random numbers that are the same everywhere (G. Marsaglia, "Xorshift RNGs", JSS 8, 2003).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        low + (high - low) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A body of a generated problem.
#[derive(Clone, Copy)]
struct Placed {
    body: ProblemBody,
    center: [f64; 2],
    /// Velocity without contacts [m/s, rad/s].
    velocity: [f64; 3],
}

/// A problem that grows contact by contact.
struct Growing {
    problem: Problem,
    bodies: Vec<Placed>,
}

impl Growing {
    fn new() -> Self {
        Self { problem: Problem::new(), bodies: Vec::new() }
    }

    fn add_body(&mut self, center: [f64; 2], [mass, moment]: [f64; 2], velocity: [f64; 3]) -> usize {
        let inertia = InverseInertia { inverse_mass: 1.0 / mass, inverse_moment: 1.0 / moment };
        let body = self.problem.add_body(inertia).expect("a fine inertia");
        self.bodies.push(Placed { body, center, velocity });
        self.bodies.len() - 1
    }

    /// Adds the two rows of a contact at `point` between body `a` and body `b` below it, or the floor.
    fn add_contact(&mut self, a: usize, b: Option<usize>, point: [f64; 2], normal: [f64; 2], mu: f64) {
        let rows = [normal, [-normal[1], normal[0]]].map(|n| {
            let coefficients = |placed: &Placed, sign: f64| {
                let arm = [point[0] - placed.center[0], point[1] - placed.center[1]];
                [sign * n[0], sign * n[1], sign * (arm[0] * n[1] - arm[1] * n[0])]
            };
            let rate = |c: [f64; 3], placed: &Placed| (0..3).map(|k| c[k] * placed.velocity[k]).sum::<f64>();
            let upper = self.bodies[a];
            let own = coefficients(&upper, 1.0);
            let row = Row::new(upper.body, own, rate(own, &upper));
            match b.map(|b| self.bodies[b]) {
                Some(lower) => {
                    let other = coefficients(&lower, -1.0);
                    Row { offset: row.offset + rate(other, &lower), ..row }.against(lower.body, other)
                }
                None => row,
            }
        });
        self.problem.add_contact(&rows[0], &rows[1], mu).expect("fine rows");
    }
}

/// A wall of bricks, `wide` in the lowest row and one fewer in every second: two contacts where one lies on another. All
/// of them fall a little, and move at random by `disorder` [m/s].
pub(crate) fn wall(wide: usize, high: usize, mu: f64, disorder: f64, seed: u64) -> Problem {
    let (width, height, mut random) = (1.0, 0.5, Random::new(seed));
    let mut wall = Growing::new();
    let mut below: Vec<usize> = Vec::new();
    for row in 0..high {
        let shift = if row % 2 == 0 { 0.0 } else { 0.5 * width };
        let bricks: Vec<usize> = (0..wide - row % 2)
            .map(|k| {
                let center = [k as f64 * width + shift, (row as f64 + 0.5) * height];
                let mass = random.between(0.5, 2.0);
                let moment = mass * (width * width + height * height) / 12.0;
                let mut own = || disorder * random.between(-1.0, 1.0);
                let velocity = [own(), own() - 0.04, own()];
                wall.add_body(center, [mass, moment], velocity)
            })
            .collect();
        for &brick in &bricks {
            let [x, y] = wall.bodies[brick].center;
            let ends = [x - 0.49 * width, x + 0.49 * width];
            if row == 0 {
                ends.into_iter().for_each(|x| wall.add_contact(brick, None, [x, 0.0], [0.0, 1.0], mu));
            }
            for &lower in &below {
                let from = ends[0].max(wall.bodies[lower].center[0] - 0.49 * width);
                let to = ends[1].min(wall.bodies[lower].center[0] + 0.49 * width);
                if from < to {
                    for x in [from, to] {
                        wall.add_contact(brick, Some(lower), [x, y - 0.5 * height], [0.0, 1.0], mu);
                    }
                }
            }
        }
        below = bricks;
    }
    wall.problem
}

/// A heap of discs that touch at random: each rests on up to three others, or on the floor.
pub(crate) fn heap(discs: usize, mu: f64, seed: u64) -> Problem {
    let mut random = Random::new(seed);
    let mut heap = Growing::new();
    let wide = (discs as f64).sqrt();
    for at in 0..discs {
        let center = [(at as f64 % wide) + random.between(-0.1, 0.1), 0.5 + 0.9 * (at as f64 / wide).floor()];
        let radius = random.between(0.35, 0.6);
        let mass = radius * radius;
        let mut own = || random.between(-1.0, 1.0);
        let velocity = [own(), own() - 1.0, own()];
        let disc = heap.add_body(center, [mass, 0.5 * mass * radius * radius], velocity);
        if center[1] < 0.7 {
            heap.add_contact(disc, None, [center[0], 0.0], [0.0, 1.0], mu);
        }
        for other in 0..disc {
            let [dx, dy] = [0, 1].map(|k| center[k] - heap.bodies[other].center[k]);
            let distance = dx.hypot(dy);
            if distance < 1.25 {
                let normal = [dx / distance, dy / distance];
                let point = [0, 1].map(|k| center[k] - radius * normal[k]);
                heap.add_contact(disc, Some(other), point, normal, mu);
            }
        }
    }
    heap.problem
}
