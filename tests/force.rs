//! Force measurement: the simulated device, and the force recovered from it against the reference's.

use touchdown_sim::force::instrument::{Instrument, InstrumentConfig};
use touchdown_sim::force::measure;
use touchdown_sim::force::recording::Axis;
use touchdown_sim::force::rehearsal::{Blow, hits, recording};
use touchdown_sim::reference::pulse::Meeting;

/// Half the rig's rotor in its ring, steel on steel.
fn meeting(mass: f64, speed: f64, restitution: f64) -> Meeting {
    let (radius, clearance) = (0.024_f64, 0.3e-3);
    let curvature = radius * (radius + clearance) / clearance;
    Meeting {
        mass,
        speed,
        restitution,
        stiffness: 4.0 / (3.0 * std::f64::consts::PI) * 3.625e11 * curvature.sqrt(),
        exponent: 1.5,
        gravity: 0.0,
    }
}

#[test]
fn experiment() {
    for noise in [0.0, 0.5, 2.0, 5.0] {
        let config = InstrumentConfig {
            noise,
            ..InstrumentConfig::default()
        };
        let instrument = Instrument::try_new(&config).unwrap();
        let hits = [hits(&instrument, Axis::X, 7)];
        for mass in [1.71, 3.42] {
            for speed in [0.02, 0.0767, 0.2, 0.5] {
                for restitution in [1.0, 0.8, 0.5, 0.3] {
                    let meeting = meeting(mass, speed, restitution);
                    let truth = meeting.pulse();
                    let force = meeting.history();
                    let blow = Blow {
                        time: 20.003e-3,
                        direction: [0.6, -0.8],
                        force,
                    };
                    let recording = recording(&instrument, &[blow], 0.1, 3);
                    let found = measure(&recording, &hits).unwrap();
                    let impulse = (1.0 + restitution) * mass * speed;
                    print!(
                        "noise {noise} m {mass} v {speed} e {restitution} band {:.0?} n {}: ",
                        found.band,
                        found.pulses().count()
                    );
                    for p in found.pulses() {
                        print!(
                            " t0 {:+.1} us J {:+.2} % F {:+.2} % T {:+.2} % ({:.0} us) dir {:.2};",
                            1e6 * (p.time_s - 20.003e-3),
                            100.0 * (p.impulse_n_s / impulse - 1.0),
                            100.0 * (p.peak_force_n / truth.peak_force - 1.0),
                            100.0 * (p.contact_time_s.unwrap_or(f64::NAN) / truth.duration - 1.0),
                            1e6 * truth.duration,
                            p.direction_deg
                        );
                    }
                    println!();
                }
            }
        }
    }
}
