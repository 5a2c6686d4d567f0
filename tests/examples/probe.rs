//! temporary
use halfgap::WorldBuilder;
use halfgap::scene::Scene;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let scene = Scene::read(&args[1]).expect("scene");
    let until: f64 = args[2].parse().unwrap();
    let jump: f64 = args[3].parse().unwrap();
    let mut world = WorldBuilder::from_scene(&scene).unwrap().build().unwrap();
    let mut last = 0.0f64;
    let mut lastl = world.ledger();
    let mut n = 0;
    while world.time() < until && n < 30 {
        let mut lines = vec![];
        if world.advance_for(until, 1, &mut |e| lines.push(format!("{e:?}").chars().take(100).collect::<String>())).is_err() { break; }
        let l = world.ledger();
        let e = l.integration_error();
        if (e - last).abs() > jump {
            n += 1;
            println!("{:.9} jump {:e} d_impacts {:e} d_steps {:e} d_capt {:e} d_proj {:e} dE {:e} steps {} {:?}", world.time(), e - last, l.impacts - lastl.impacts, l.steps - lastl.steps, l.captures - lastl.captures, l.projections - lastl.projections, l.now.total() - lastl.now.total(), world.statistics().region_steps, lines.first());
        }
        last = e;
        lastl = l;
    }
}
