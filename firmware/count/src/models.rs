//! The drop of [`super::drop`] by every model but the rigid one.

use touchdown_models::{
    Coupled, CoupledConfig, Euler, Hertz, HertzConfig, Materials, Moreau, MountConfig, Placement,
    Point, RaceConfig, Scheme, StopConfig, Verlet, Whole,
};
use touchdown_rotor::Precision;

use super::CountingRun;
use super::drop::{BEGIN, POSITION, STEPS, WHOLE, config};

/// Steps of rung `hertz`, which refuses longer ones, us.
const SHORT_STEPS: [u32; 2] = [10, 100];
/// Speed after a fall through the gap, m/s.
const FASTEST: f64 = 0.0767;

impl CountingRun {
    /// Counts the drops of those in the plane.
    pub(super) fn in_plane<R: Precision>(&mut self) {
        for step in STEPS {
            let moreau = Moreau::try_new(&config(step)).expect("a valid configuration");
            let (model, scales) = (moreau.rounded(), moreau.scales());
            self.drop::<R, _>(&model, scales, "moreau,midpoint", step, WHOLE);
        }
        for step in SHORT_STEPS {
            self.hertz::<R, Euler>("hertz,euler", step);
            self.hertz::<R, Verlet>("hertz,verlet", step);
        }
    }

    /// Counts the drops of those with rings of their own, in one kind of number.
    pub(super) fn in_rings<R: Precision>(&mut self, number: &'static str) {
        self.number = number;
        for step in STEPS {
            // Their start is their own: of these scales only the spin's counts.
            let plane = Moreau::try_new(&config(step)).expect("a valid configuration");
            let (whole, ends) = (support::<R>(step), ends::<R>(step));
            self.drop::<R, _>(&whole, plane.scales(), "support,midpoint", step, BEGIN);
            self.drop::<R, _>(&ends, plane.scales(), "two-plane,midpoint", step, BEGIN);
        }
    }

    /// Steel on steel.
    fn hertz<R: Precision, S: Scheme>(&mut self, name: &str, step: u32) {
        let config = HertzConfig {
            rigid: config(step),
            materials: Materials::steel(),
            shape: Point,
            fastest: FASTEST,
        };
        let hertz = Hertz::<f64, Point, S>::try_new(&config).expect("a valid configuration");
        let model = hertz.rounded::<R, Point>();
        self.drop::<R, _>(&model, hertz.scales(), name, step, WHOLE);
    }
}

/// All parts of the rung: the scenes `soft-support` and `ball-bearing` in one.
fn support<R: Precision>(step: u32) -> Whole<R, 1, 1> {
    let mut config = CoupledConfig::of_plane(&config(step), [0.0]);
    let [seat] = &mut config.rings;
    seat.mount = Some(MountConfig {
        mass: 0.5,
        stiffness: 2.6e6,
        damping: 320.0,
        vertical: None,
        friction: 0.0,
        stop: Some(StopConfig::rigid(0.5e-3)),
    });
    seat.race = Some(RaceConfig {
        inertia: 3e-5,
        dry_drag: 0.005,
        viscous_drag: 1e-5,
        cage_ratio: 0.44,
        heat_capacity: 50.0,
        heat_loss: 0.5,
    });
    started(&config, POSITION, 0.0)
}

/// The scene `two-plane` without its third ring.
fn ends<R: Precision>(step: u32) -> Whole<R, 2, 2> {
    let mut config = CoupledConfig::of_plane(&config(step), [-0.12, 0.12]);
    config.transverse_inertia = 0.03078;
    config.unbalance.eccentricity = 1.1e-6 / config.mass;
    started(&config, [0.0; 2], 0.6e-3)
}

/// From this place of the centre (m) and this slope (rad).
fn started<R: Precision, const N: usize, const Q: usize>(
    config: &CoupledConfig<f64, N>,
    position: [f64; 2],
    slope: f64,
) -> Whole<R, N, Q> {
    let model = Coupled::try_new(config).expect("a valid configuration");
    let start = Placement {
        position: position.map(|x| x / model.scales().length),
        tilt: [0.0, slope / model.tilt_scale()],
        ..Placement::default()
    };
    Whole {
        model: model.rounded(),
        start: start.rounded(),
    }
}
