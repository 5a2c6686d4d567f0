//! Drops onto the seams of tiles that lie side by side: their numbers are decimals rounded to 64 or to 32 bits, so that
//! tiles that are meant to be level, or to form one ramp, are so up to rounding only.

use crate::random::Random;
use serde_json::{Value, json};

/// A body that is dropped onto a seam, and what must become of it.
#[derive(Clone, Debug)]
pub struct Drop {
    /// The scene, without its tolerance.
    pub scene: Value,
    /// Elasticity of the body; that of the tiles is 1.
    pub elasticity: f64,
    /// True for a ball on level tiles, which rebounds straight.
    pub is_level_ball: bool,
}

/// Rounds to a number of decimals, then to 32 bits if asked for.
fn decimal(value: f64, digits: i32, single: bool) -> f64 {
    let unit = 10f64.powi(digits);
    let rounded = (value * unit).round() / unit;
    if single { f64::from(rounded as f32) } else { rounded }
}

/// The drop of a seed.
#[must_use]
pub fn drop_of_seed(seed: u64) -> Drop {
    let mut random = Random::new(seed ^ 0x5ea_4000);
    let single = random.chance(0.5);
    let digits = 1 + random.below(5) as i32;
    let round = |value: f64| decimal(value, digits, single);
    let width = decimal(random.between(0.04, 1.5), digits.max(2), single).max(0.03);
    let thick = round(random.between(0.2, 1.0)).max(0.1);
    let most = if random.chance(0.3) { 12 } else { 4 };
    let count = 2 + random.below(most);
    let far = if random.chance(0.2) { decimal(random.power_of_ten(0.0, 2.0), 1, single) } else { 0.0 };
    let is_level = random.chance(0.4);
    let slope = if is_level { 0.0 } else { round(random.between(-0.6, 0.6)) };
    // The slopes of some tiles differ a little from each other.
    let bend = if is_level || random.chance(0.5) { 0.0 } else { random.power_of_ten(-9.0, -2.0) };
    let mut tiles = Vec::new();
    let mut corner = [far - 0.5 * width * count as f64, round(random.between(-1.0, 1.0))];
    let mut corners = vec![corner];
    for index in 0..count {
        let angle = slope + bend * random.between(-1.0, 1.0);
        let (sin, cos) = angle.sin_cos();
        let next = [corner[0] + width * cos, corner[1] + width * sin];
        let center = [
            0.5 * (corner[0] + next[0]) + 0.5 * thick * sin,
            0.5 * (corner[1] + next[1]) - 0.5 * thick * cos,
        ];
        let center = center.map(|x| if single { f64::from(x as f32) } else { x });
        let angle = if single { f64::from(angle as f32) } else { angle };
        tiles.push(json!({
            "name": format!("tile {index}"), "fixed": true, "position": center, "angle": angle,
            "shape": { "block": { "width": width, "height": thick } },
        }));
        corner = next;
        corners.push(corner);
    }
    let seam = corners[1 + random.below(count - 1)];
    let size = decimal(random.between(0.05, 0.4), digits.max(2), single).max(0.05);
    let off = match random.below(4) {
        0 => 0.0,
        1 => random.between(-0.5, 0.5) * size.min(width),
        _ => size * random.power_of_ten(-9.0, -1.0) * if random.chance(0.5) { 1.0 } else { -1.0 },
    };
    let is_ball = random.chance(0.5);
    let elasticity = random.one_of(&[1.0, 0.5, 0.0]);
    let height = random.between(0.1, 1.0);
    let aslant = if random.chance(0.5) { 0.0 } else { random.between(-1.0, 1.0) };
    let (sin, cos) = slope.sin_cos();
    // Above the seam by a height along the normal of the ramp, or straight above it.
    let reach = if is_ball { size } else { 1.5 * size };
    let up = if random.chance(0.5) { [-sin, cos] } else { [0.0, 1.0] };
    let position =
        [seam[0] + off * cos + (reach + height) * up[0], seam[1] + off * sin + (reach + height) * up[1]];
    let speed = decimal(random.between(0.5, 6.0), 2, false);
    let velocity = [-speed * up[0] + aslant * cos, -speed * up[1] + aslant * sin];
    let mut body = json!({
        "name": "body", "mass": random.one_of(&[1.0, 0.3, 7.0]), "elasticity": elasticity,
        "position": position, "velocity": velocity,
    });
    if is_ball {
        body["shape"] = json!({ "disc": { "radius": size } });
    } else {
        let tall = if random.chance(0.5) { size } else { random.between(0.5, 2.0) * size };
        body["shape"] = json!({ "block": { "width": 2.0 * size, "height": 2.0 * tall.min(size) } });
        body["angle"] = match random.below(3) {
            0 => json!(0.0),
            1 => json!(slope),
            _ => json!(random.between(-3.0, 3.0)),
        };
    }
    let falls = random.chance(0.5);
    let mut run = json!({ "duration": 1.6 * height / speed });
    if random.chance(0.5) {
        run["impact_law"] = json!("simultaneous");
    }
    let mut scene = json!({
        "format": "halfgap-scene-1", "title": format!("drop {seed}"), "run": run,
    });
    if falls {
        scene["force"] = json!([{ "gravity": { "acceleration": [0.0, -9.81] } }]);
    }
    tiles.push(body);
    scene["body"] = json!(tiles);
    Drop { scene, elasticity, is_level_ball: is_ball && is_level }
}
