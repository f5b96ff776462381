//! The drop of [`super::drop`] by every model but the rigid one.

use touchdown_models::{
    BallBearing, Ends, Euler, Hertz, HertzConfig, Materials, Moreau, MountConfig, Placement, Point,
    RaceConfig, RingConfig, Scheme, Sprung, Support, SupportConfig, TwoPlane, TwoPlaneConfig,
    UnbalanceConfig, Verlet,
};
use touchdown_rotor::Precision;

use super::drop::{Run, STEPS, config};
use touchdown_firmware::board::qemu::Counter;

use crate::table::{Name, Table};

/// Steps of rung `hertz`, which refuses longer ones, us.
const SHORT_STEPS: [u32; 2] = [10, 100];
/// Speed after a fall through the gap, m/s.
const FASTEST: f64 = 0.0767;

/// Counts their drops in one kind of number.
pub(super) fn count<R: Precision>(counter: &Counter, table: &mut Table, name: Name) {
    for step in STEPS {
        let run = Run {
            counter,
            name,
            step,
        };
        let moreau = Moreau::try_new(&config(step)).expect("a valid configuration");
        let scales = moreau.scales();
        run.of_model::<R, _>(&moreau.rounded(), scales)
            .write(table, "moreau", "midpoint", &run);
        run.of_model::<R, _>(&support(step).rounded(), scales)
            .write(table, "support", "midpoint", &run);
        run.of_model::<R, _>(&ends::<R>(step), scales)
            .write(table, "two-plane", "midpoint", &run);
    }
    for step in SHORT_STEPS {
        let run = Run {
            counter,
            name,
            step,
        };
        run.of_hertz::<R, Euler>(table, "euler");
        run.of_hertz::<R, Verlet>(table, "verlet");
    }
}

impl Run<'_> {
    /// Steel on steel.
    fn of_hertz<R: Precision, S: Scheme>(&self, table: &mut Table, scheme: &str) {
        let config = HertzConfig {
            rigid: config(self.step),
            materials: Materials::steel(),
            shape: Point,
            fastest: FASTEST,
        };
        let model = Hertz::<f64, Point, S>::try_new(&config).expect("a valid configuration");
        self.of_model::<R, _>(&model.rounded::<R, Point>(), model.scales())
            .write(table, "hertz", scheme, self);
    }
}

/// All parts of the rung: the scenes `soft-support` and `ball-bearing` in one.
fn support(step: u32) -> Support<f64, Sprung<f64>, BallBearing<f64>> {
    Support::try_new(&SupportConfig {
        rigid: config(step),
        mount: MountConfig {
            mass: 0.5,
            stiffness: 2.6e6,
            damping: 320.0,
            travel: Some(0.5e-3),
        },
        race: RaceConfig {
            inertia: 3e-5,
            dry_drag: 0.005,
            viscous_drag: 1e-5,
            cage_ratio: 0.44,
            heat_capacity: 50.0,
            heat_loss: 0.5,
        },
    })
    .expect("a valid configuration")
}

/// The scene `two-plane` without its third ring.
fn ends<R: Precision>(step: u32) -> Ends<R, 2> {
    let plane = config(step);
    let ring = |place| RingConfig {
        place,
        clearance: plane.clearance,
        radius: plane.radius,
        friction: plane.friction,
        restitution: plane.restitution,
    };
    let model = TwoPlane::try_new(&TwoPlaneConfig {
        mass: plane.mass,
        polar_inertia: plane.polar_inertia,
        transverse_inertia: 0.03078,
        rings: [ring(-0.12), ring(0.12)],
        gravity: [0.0, -plane.gravity],
        speed: plane.speed,
        unbalance: UnbalanceConfig {
            eccentricity: 1.1e-6 / plane.mass,
            ..UnbalanceConfig::default()
        },
        magnets: Default::default(),
        step: plane.step,
    })
    .expect("a valid configuration");
    let start = Placement {
        tilt: [0.0, 0.6e-3 / model.tilt_scale()],
        ..Placement::default()
    };
    Ends::new(model.rounded(), start.rounded())
}
