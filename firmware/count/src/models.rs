//! The drop of [`super::drop`] by every model but the rigid one.

use touchdown_models::{
    Contact, Coupled, CoupledConfig, Hertz, HertzConfig, Materials, Moreau, MountConfig, Placement,
    RaceConfig, Scheme, StopConfig, Whole,
};
use touchdown_rotor::Precision;

use super::drop::{BEGIN, POSITION, Run, STEPS, WHOLE, config};
use touchdown_counter::{Counter, Name, Table};

/// Steps of rung `hertz`, which refuses longer ones, us.
const SHORT_STEPS: [u32; 2] = [10, 100];
/// Speed after a fall through the gap, m/s.
const FASTEST: f64 = 0.0767;

/// Counts the drops of those in the plane in one kind of number.
pub(super) fn in_plane<R: Precision>(counter: &Counter, table: &mut Table, name: Name) {
    let with_step = |step| Run {
        counter,
        name,
        step,
        duration: WHOLE,
    };
    for step in STEPS {
        let run = with_step(step);
        let moreau = Moreau::<R>::try_new(&config(step)).expect("a valid configuration");
        run.of_model::<R, _>(&moreau)
            .write(table, "moreau", "midpoint", &run);
    }
    for step in SHORT_STEPS {
        let run = with_step(step);
        run.of_hertz::<R>(table, "euler", Scheme::Euler);
        run.of_hertz::<R>(table, "verlet", Scheme::Verlet);
    }
}

/// Counts the drops of those with rings of their own, in one kind of number.
pub(super) fn in_rings<R: Precision>(counter: &Counter, table: &mut Table, name: Name) {
    for step in STEPS {
        let run = Run {
            counter,
            name,
            step,
            duration: BEGIN,
        };
        run.of_model::<R, _>(&support::<R>(step))
            .write(table, "support", "midpoint", &run);
        run.of_model::<R, _>(&ends::<R>(step))
            .write(table, "two-plane", "midpoint", &run);
    }
}

impl Run<'_> {
    /// Steel on steel.
    fn of_hertz<R: Precision>(&self, table: &mut Table, name: &str, scheme: Scheme) {
        let config = HertzConfig {
            rigid: config(self.step),
            materials: Materials::steel(),
            contact: Contact::Point,
            fastest: FASTEST,
        };
        let model = Hertz::<R>::try_new(&config, scheme).expect("a valid configuration");
        self.of_model::<R, _>(&model)
            .write(table, "hertz", name, self);
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
    config: &CoupledConfig<N>,
    position: [f64; 2],
    slope: f64,
) -> Whole<R, N, Q> {
    let model = Coupled::<f64, N, Q>::try_new(config).expect("a valid configuration");
    let start = Placement {
        position: position.map(|x| x / model.scales().length),
        tilt: [0.0, slope / model.tilt_scale()],
        ..Placement::default()
    };
    Whole {
        model: Coupled::try_new(config).expect("a valid configuration"),
        start: start.rounded(),
    }
}
