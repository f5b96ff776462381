use touchdown_sim::model_run::two_plane::watch;
use touchdown_sim::scene::{Magnet, Scene};
#[test]
fn dbg() {
    for which in 0..2 {
    let mut s = Scene::load("two-plane").unwrap();
    s.run.duration = 0.03;
    s.model.step = 1e-6;
    let it = s.two_plane.as_mut().unwrap();
    if which == 0 {
        let k = 10.0 * 3.42 * 9.81 / 0.3e-3 * 0.5;
        let m = |place| Magnet { place, stiffness: k, force: [0.0; 2] };
        it.magnets = vec![m(-0.1), m(0.1)];
    } else { for r in &mut it.rings { r.retainer.friction = 2.0; } }
    let (mut heat, mut lost, mut n, mut shown) = (0.0, 0.0, 0u64, 0);
    let mut mot = 0.0;
    watch(&s, &mut |g| {
        n += 1;
        let e = g.energy;
        let (dh, dl) = (e.heat - heat, e.lost - lost);
        if (dh + dl < -1e-7 || dl < -1e-5 || dh < -1e-5) && shown < 12 {
            shown += 1;
            println!("{which} tick {n} dheat {dh:e} dlost {dl:e} motion {:e} -> {:e} beyond {:e} spin {:e}", mot, e.motion, g.beyond, e.spin);
        }
        heat = e.heat; lost = e.lost; mot = e.motion;
    }).unwrap();
    }
}
