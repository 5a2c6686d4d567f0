//! Generated mechanisms: linkages with loops, trains of gears, sliders, pulleys and carts, with motors, drives, limits, springs and dry
//! friction in their joints, among loose discs that strike them.

use crate::random::Random;
use serde_json::{Value, json};

/// Probability that a joint has each of the things that may act on its coordinate.
const ON_JOINT: f64 = 0.25;
/// Number of loose discs at most.
const LOOSE: usize = 3;

/// A mechanism that is being made.
struct Making<'a> {
    random: &'a mut Random,
    bodies: Vec<Value>,
    connectors: Vec<Value>,
    /// A coordinate may be driven, and none is bounded: a drive that runs into a limit cannot go on.
    may_drive: bool,
    /// Longest duration [s].
    longest: f64,
    /// A coordinate is driven, or none may be any more: another drive might contradict it.
    is_driven: bool,
}

/// The mechanism of a seed.
#[must_use]
pub fn mechanism_of_seed(seed: u64) -> Value {
    let mut random = Random::new(seed ^ 0x6d65_6368_616e);
    let (gravity, friction) = (random.chance(0.7), random.chance(0.6));
    let tolerance = random.one_of(&[1e-6, 1e-8, 1e-8, 1e-10]);
    let may_drive = random.chance(0.4);
    let mut making = Making {
        random: &mut random,
        bodies: Vec::new(),
        connectors: Vec::new(),
        may_drive,
        longest: 4.0,
        is_driven: false,
    };
    match making.random.below(8) {
        0 | 1 => making.four_bar(),
        2 => making.slider_crank(),
        3 => making.gears(),
        4 => making.planetary(),
        5 => making.chain(),
        6 => making.atwood(),
        _ => making.cart(),
    }
    making.let_links_pass();
    making.scatter();
    let Making { random, mut bodies, connectors, longest, .. } = making;
    for body in bodies.iter_mut().filter(|_| friction) {
        body["friction"] = json!(random.between(0.0, 1.0));
    }
    let mut forces = Vec::new();
    if gravity {
        forces.push(json!({ "gravity": { "acceleration": [0.0, -9.81] } }));
    }
    if random.chance(0.2) {
        forces.push(json!({ "damping": { "linear": random.unit(), "angular": random.unit() } }));
    }
    json!({
        "format": "halfgap-scene-1", "title": format!("mechanism {seed}"),
        "run": { "duration": random.between(0.25, 1.0) * longest, "tolerance": tolerance, "output_step": 0.1 },
        "body": bodies, "connector": connectors, "force": forces,
    })
}

fn point(body: &str, at: [f64; 2]) -> Value {
    json!({ "body": body, "point": at })
}

impl Making<'_> {
    /// Adds a bar between two points, whose ends lie on its own x axis; returns its length.
    fn bar(&mut self, name: &str, from: [f64; 2], to: [f64; 2]) -> f64 {
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        let length = x.hypot(y);
        let width = 0.04 * self.random.between(0.5, 2.0);
        self.bodies.push(json!({
            "name": name, "shape": { "block": { "width": length, "height": width } },
            "mass": self.random.power_of_ten(-0.7, 0.7), "position": [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])],
            "angle": y.atan2(x), "elasticity": self.random.unit(),
        }));
        length
    }

    fn wheel(&mut self, name: &str, at: [f64; 2], radius: f64) {
        let spin = self.random.between(-3.0, 3.0);
        self.bodies.push(json!({
            "name": name, "shape": { "disc": { "radius": radius } }, "mass": self.random.power_of_ten(-0.7, 0.7),
            "position": at, "angular_velocity": spin, "elasticity": self.random.unit(),
        }));
    }

    /// Adds a joint, of a kind with a free coordinate that is an angle or a length, with things that act on it.
    fn joint(&mut self, kind: &str, mut fields: Value, is_angle: bool) {
        let random = &mut *self.random;
        let friction = if is_angle { "friction_torque" } else { "friction_force" };
        if self.may_drive && !self.is_driven && random.chance(2.0 * ON_JOINT) {
            self.is_driven = true;
            fields["drive"] = match random.below(3) {
                0 => json!({ "speed": random.between(-6.0, 6.0) }),
                1 => json!({ "oscillate": {
                    "amplitude": 0.3 * random.unit(), "frequency": 2.0 * random.unit(), "phase": random.between(0.0, 6.0),
                } }),
                _ => {
                    let end = random.between(-0.4, 0.4);
                    json!({ "table": {
                        "times": [0.0, 1.0, 2.0, 3.5], "values": [end, random.between(-0.4, 0.4), 0.1, end],
                        "periodic": true,
                    } })
                }
            };
        } else {
            if random.chance(ON_JOINT) {
                fields["motor"] =
                    json!({ "speed": random.between(-8.0, 8.0), "max": random.power_of_ten(-1.5, 1.5) });
            }
            if random.chance(ON_JOINT) {
                fields[friction] = json!(random.power_of_ten(-2.0, 1.0));
            }
        }
        if random.chance(ON_JOINT) {
            fields["spring"] = json!({
                "rest": random.between(-0.5, 0.5), "stiffness": random.power_of_ten(-1.0, 2.0),
                "damping": if random.chance(0.5) { random.unit() } else { 0.0 },
            });
        }
        self.connectors.push(json!({ kind: fields }));
    }

    /// Bounds the coordinate of the last joint, which begins at a value, from both sides or one.
    fn limit(&mut self, kind: &str, begins: f64) {
        let random = &mut *self.random;
        let Some(last) = self.connectors.last_mut() else { return };
        if self.may_drive || !random.chance(ON_JOINT) {
            return;
        }
        let mut limits = json!({ "elasticity": if random.chance(0.5) { random.unit() } else { 0.0 } });
        let sides = random.below(3);
        if sides != 0 {
            limits["lower"] = json!(begins - 1.5 * random.unit());
        }
        if sides != 1 {
            limits["upper"] = json!(begins + 1.5 * random.unit());
        }
        last[kind]["limits"] = limits;
    }

    fn pin(&mut self, a: (&str, [f64; 2]), b: (&str, [f64; 2]), begins: f64) {
        self.joint("pin", json!({ "a": point(a.0, a.1), "b": point(b.0, b.1) }), true);
        self.limit("pin", begins);
    }

    fn four_bar(&mut self) {
        let crank = self.random.between(0.3, 1.0);
        let angle = self.random.between(0.3, 2.6);
        let base = self.random.between(1.0, 3.0);
        let a = [crank * angle.cos(), crank * angle.sin()];
        let b = [a[0] + self.random.between(0.8, 2.5), a[1] + self.random.between(-0.4, 1.2)];
        let first = self.bar("crank", [0.0, 0.0], a);
        let second = self.bar("coupler", a, b);
        let third = self.bar("rocker", [base, 0.0], b);
        let tilt = (b[1] - a[1]).atan2(b[0] - a[0]);
        let rocker = b[1].atan2(b[0] - base);
        // Driven by anything but a crank that can turn all round (Grashof), a linkage would come to its dead point.
        let lengths = [first, second, third, base];
        let (least, most) =
            lengths.iter().fold((f64::MAX, 0.0f64), |(least, most), l| (l.min(least), l.max(most)));
        self.is_driven = first > least || 1.01 * 2.0 * (least + most) > lengths.iter().sum();
        self.pin(("world", [0.0, 0.0]), ("crank", [-0.5 * first, 0.0]), angle);
        self.is_driven = true;
        self.pin(("crank", [0.5 * first, 0.0]), ("coupler", [-0.5 * second, 0.0]), tilt - angle);
        self.pin(("rocker", [0.5 * third, 0.0]), ("coupler", [0.5 * second, 0.0]), tilt - rocker);
        self.pin(("world", [base, 0.0]), ("rocker", [-0.5 * third, 0.0]), rocker);
        if self.random.chance(0.2) {
            self.bar("extra", b, [b[0] + 0.5, b[1]]);
            self.connectors.push(json!({ "weld": { "a": point("coupler", [0.5 * second, 0.0]), "b": point("extra", [-0.25, 0.0]) } }));
        }
    }

    fn slider_crank(&mut self) {
        let crank = self.random.between(0.2, 0.6);
        let rod = crank * self.random.between(1.5, 4.0);
        let angle = self.random.between(0.3, 2.8);
        let a = [crank * angle.cos(), crank * angle.sin()];
        let x = a[0] + (rod * rod - a[1] * a[1]).sqrt();
        let first = self.bar("crank", [0.0, 0.0], a);
        let second = self.bar("rod", a, [x, 0.0]);
        self.bodies.push(json!({
            "name": "piston", "shape": { "block": { "width": 0.3, "height": 0.3 } }, "mass": self.random.power_of_ten(-0.5, 1.0),
            "position": [x, 0.0], "elasticity": self.random.unit(),
        }));
        self.pin(("world", [0.0, 0.0]), ("crank", [-0.5 * first, 0.0]), angle);
        // Driven by anything else it would come to its dead point.
        self.is_driven = true;
        self.pin(
            ("crank", [0.5 * first, 0.0]),
            ("rod", [-0.5 * second, 0.0]),
            (-a[1]).atan2(x - a[0]) - angle,
        );
        self.pin(("rod", [0.5 * second, 0.0]), ("piston", [0.0, 0.0]), -(-a[1]).atan2(x - a[0]));
        let fields =
            json!({ "a": point("world", [0.0, 0.0]), "b": point("piston", [0.0, 0.0]), "axis": [1.0, 0.0] });
        self.joint("slider", fields, false);
        self.limit("slider", x);
    }

    fn gears(&mut self) {
        let count = 2 + self.random.below(3);
        let (mut x, mut last) = (0.0, 0.0);
        for index in 0..count {
            let radius = self.random.between(0.2, 0.8);
            x += if index == 0 { 0.0 } else { last + radius };
            let name = format!("wheel {index}");
            self.wheel(&name, [x, 0.0], radius);
            self.pin(("world", [x, 0.0]), (&name, [0.0, 0.0]), 0.0);
            if index > 0 {
                let before = format!("wheel {}", index - 1);
                self.connectors.push(json!({ "gear": { "a": before, "b": name, "ratio": -radius / last } }));
            }
            last = radius;
        }
        if self.random.chance(0.5) {
            self.bodies.push(json!({
                "name": "bar", "shape": { "block": { "width": 1.0, "height": 0.1 } }, "mass": self.random.power_of_ten(-0.5, 0.5),
                "position": [0.0, -2.0],
            }));
            let fields = json!({ "a": point("world", [0.0, -2.0]), "b": point("bar", [0.0, 0.0]), "axis": [1.0, 0.0] });
            self.joint("slider", fields, false);
            self.limit("slider", 0.0);
            self.connectors.push(json!({ "rack": {
                "wheel": "wheel 0", "bar": "bar", "radius": self.random.between(0.2, 0.8), "axis": [1.0, 0.0],
            } }));
        }
    }

    fn planetary(&mut self) {
        let (sun, planet) = (self.random.between(0.2, 0.6), self.random.between(0.1, 0.4));
        self.wheel("sun", [0.0, 0.0], sun);
        let center = [sun + planet, 0.0];
        let length = self.bar("carrier", [0.0, 0.0], center);
        self.wheel("planet", center, planet);
        self.pin(("world", [0.0, 0.0]), ("sun", [0.0, 0.0]), 0.0);
        self.pin(("world", [0.0, 0.0]), ("carrier", [-0.5 * length, 0.0]), 0.0);
        self.pin(("carrier", [0.5 * length, 0.0]), ("planet", [0.0, 0.0]), 0.0);
        self.connectors.push(
            json!({ "gear": { "a": "sun", "b": "planet", "ratio": -planet / sun, "carrier": "carrier" } }),
        );
        if self.random.chance(0.6) && !self.is_driven {
            let ring = sun + 2.0 * planet;
            self.connectors.push(json!({ "gear": { "a": "world", "b": "planet", "ratio": planet / ring, "carrier": "carrier" } }));
        }
    }

    fn chain(&mut self) {
        let count = 1 + self.random.below(4);
        let (mut from, mut before) = ([0.0, 0.0], None::<(String, f64, f64)>);
        for index in 0..count {
            let (length, angle) = (self.random.between(0.3, 1.2), self.random.between(-3.1, 3.1));
            let to = [from[0] + length * angle.cos(), from[1] + length * angle.sin()];
            let name = format!("link {index}");
            self.bar(&name, from, to);
            let own = [-0.5 * length, 0.0];
            match before.take() {
                None => self.pin(("world", from), (&name, own), angle),
                Some((other, half, turned)) => self.pin((&other, [half, 0.0]), (&name, own), angle - turned),
            }
            (from, before) = (to, Some((name, 0.5 * length, angle)));
        }
    }

    fn atwood(&mut self) {
        // So deep that neither comes up to its wheel.
        let (left, right) = (self.random.between(4.0, 6.0), self.random.between(4.0, 6.0));
        self.longest = 0.8;
        let ratio = if self.random.chance(0.5) { 1.0 } else { self.random.between(0.3, 3.0) };
        for (name, x, drop) in [("left", -0.5, left), ("right", 0.5, right)] {
            let size = self.random.between(0.1, 0.4);
            self.bodies.push(json!({
                "name": name, "shape": { "block": { "width": size, "height": size } }, "mass": self.random.power_of_ten(-0.5, 0.5),
                "position": [x, -drop], "velocity": [0.0, self.random.between(-1.0, 1.0)], "elasticity": self.random.unit(),
            }));
        }
        let slack = if self.random.chance(0.5) { 0.0 } else { 0.3 * self.random.unit() };
        let mut pulley = json!({
            "a": point("left", [0.0, 0.0]), "b": point("right", [0.0, 0.0]), "wheel_a": [-0.5, 0.0], "wheel_b": [0.5, 0.0],
            "ratio": ratio, "length": left + ratio * right + slack,
        });
        if self.random.chance(0.7) {
            pulley["elasticity"] = json!(self.random.unit());
        }
        self.connectors.push(json!({ "pulley": pulley }));
        self.floor(-8.0);
    }

    fn cart(&mut self) {
        let (radius, wide) = (self.random.between(0.15, 0.3), self.random.between(0.6, 1.5));
        let high = radius + 0.3;
        self.bodies.push(json!({
            "name": "chassis", "shape": { "block": { "width": 1.2 * wide, "height": 0.15 } }, "mass": self.random.power_of_ten(-0.3, 0.7),
            "position": [0.0, high], "velocity": [self.random.between(-2.0, 2.0), 0.0],
        }));
        for (name, x) in [("front", 0.5 * wide), ("back", -0.5 * wide)] {
            self.wheel(name, [x, radius], radius);
            self.pin(("chassis", [x, radius - high]), (name, [0.0, 0.0]), 0.0);
        }
        self.floor(0.0);
    }

    fn floor(&mut self, level: f64) {
        self.bodies.push(json!({
            "name": "floor", "fixed": true, "shape": { "block": { "width": 200.0, "height": 1.0 } },
            "position": [0.0, level - 0.5 - 1e-6], "elasticity": self.random.unit(),
        }));
    }

    /// Links lie in planes of their own: they pass each other, but not what is loose, nor the floor.
    fn let_links_pass(&mut self) {
        let names: Vec<String> = self
            .bodies
            .iter()
            .filter(|body| body["fixed"] != json!(true))
            .filter_map(|body| Some(body["name"].as_str()?.to_owned()))
            .collect();
        for body in &mut self.bodies {
            if body["fixed"] != json!(true) {
                let others: Vec<_> = names.iter().filter(|other| body["name"] != json!(other)).collect();
                body["passes_through"] = json!(others);
            }
        }
    }

    /// Throws discs at the mechanism from afar.
    fn scatter(&mut self) {
        for index in 0..self.random.below(LOOSE + 1) {
            let radius = self.random.between(0.05, 0.2);
            let (x, y) = (8.0 + 2.0 * index as f64, self.random.between(0.5, 2.0));
            self.bodies.push(json!({
                "name": format!("disc {index}"), "shape": { "disc": { "radius": radius } },
                "mass": self.random.power_of_ten(-1.0, 0.5), "position": [x, y],
                "velocity": [-self.random.between(3.0, 10.0), self.random.between(0.0, 4.0)], "elasticity": self.random.unit(),
            }));
        }
    }
}
