//! temporary
use halfgap::WorldBuilder;
use halfgap::scene::Scene;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let scene = Scene::read(&args[1]).expect("scene");
    let until: f64 = args[2].parse().unwrap();
    let (a, b): (&str, &str) = (&args[3], &args[4]);
    let touch: f64 = args[5].parse().unwrap();
    let mut world = WorldBuilder::from_scene(&scene).unwrap().build().unwrap();
    let id = |n: &str| world.bodies().find(|&x| world.name(x) == n).unwrap();
    let (a, b) = (id(a), id(b));
    let mut lines: std::collections::VecDeque<String> = Default::default();
    while world.time() < until {
        let mut first = String::new();
        let r = world.advance_for(until, 1, &mut |e| first = format!("{e:?}").chars().take(60).collect::<String>());
        let (p, q) = (world.state(a), world.state(b));
        let d = p.position - q.position;
        let block = std::env::var_os("BLOCK").is_some();
        let low = |t: f64| { let (c, s) = (p.angle.cos(), p.angle.sin()); let _ = t; [(-0.25, -0.1), (0.25, -0.1), (-0.25, 0.1), (0.25, 0.1)].iter().map(|(x, y)| p.position.y + s * x + c * y).fold(f64::INFINITY, f64::min) };
        let g = if block { low(0.0) } else { d.length() - touch };
        let n = d / d.length();
        lines.push_back(format!("{:.9} gap {g:e} rate {:e} steps {} {first} {:?}", world.time(), (p.velocity - q.velocity).dot(n), world.statistics().region_steps, (p.position, p.angle, p.velocity, p.angular_velocity)));
        if lines.len() > 40 { lines.pop_front(); }
        if g < -5e-7 || r.is_err() { break; }
    }
    for l in lines { println!("{l}"); }
}
