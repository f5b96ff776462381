//! The drop by Touchdown, on any rung, or its exact course by the independent reference. Impacts are those
//! of any ring; position and velocity are the axis' there.
//!
//! Arguments: variant, `[model]` of the scene as TOML, `steps` or `changes`, duration (s), file for
//! the samples (`-`: none), repeats; or variant, `exact`, duration.

use std::env;
use std::f64::consts::TAU;
use std::hint::black_box;

use serde_json::{Value, json};
use touchdown_peers::{Sample, answer, contact, median_time, write_samples};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Change, Kinematics, ModelEvent, Precision, Stepper};
use touchdown_run::model::{Subject, Use, with_model};
use touchdown_scene::Scene;

/// What a variant has besides rotor and ring.
fn parts(variant: &str) -> &'static str {
    match variant {
        "S" => {
            "two_plane = { transverse_inertia_kg_m2 = 0.03078 }
             support = { mass_kg = 0.5, stiffness_n_m = 2.6e6, damping_n_s_m = 320.0 }
             ring = [{ z_mm = 0.0 }]"
        }
        "T" => {
            "two_plane = { transverse_inertia_kg_m2 = 0.03078, tilt_mrad = [0.0, 0.6] }
             ring = [{ z_mm = -120.0 }, { z_mm = 120.0 }]"
        }
        _ => "",
    }
}

fn scene(variant: &str, model: &str, duration: f64) -> Scene {
    let ((friction, restitution), parts) = (contact(variant), parts(variant));
    let rpm = 3141.6 * 60.0 / TAU;
    let text = format!(
        "rotor = {{ mass_kg = 3.42, radius_mm = 24.0, speed_rpm = {rpm:?} }}\n\
         retainer = {{ clearance_mm = 0.3, friction = {friction:?}, restitution = {restitution:?} }}\n\
         run = {{ duration_s = {duration:?}, gravity_m_s2 = 9.81 }}\n{parts}\n\
         [model]\n{model}\n"
    );
    Scene::parse("peers", &text).expect("valid scene")
}

/// Time, position, velocity after and speed into the wall before an impact, SI.
type Impact = [f64; 6];

fn exact(variant: &str, duration: f64) -> Value {
    let scene = scene(variant, "", duration);
    let history = touchdown_truth::simulate(&scene);
    let impacts = history.impacts.iter().map(|impact| -> Impact {
        let ([x, y], [u, v]) = (impact.state.position, impact.state.velocity);
        [impact.state.time, x, y, u, v, impact.normal_speed]
    });
    let impacts: Vec<Impact> = impacts.collect();
    json!({ "impacts": impacts, "contact_starts": history.contact_starts })
}

struct Run<'a> {
    scene: &'a Scene,
    by_steps: bool,
    file: &'a str,
    repeats: usize,
}

impl Run<'_> {
    /// The whole drop. What is read on the way goes to `seen`.
    fn drop<R: Precision, M: Stepper<R>>(
        &self,
        Subject {
            model, start, spin, ..
        }: &Subject<R, M>,
        steps: u64,
        mut seen: impl FnMut(u64, &Kinematics<R>),
        mut on_event: impl FnMut(ModelEvent<R>),
    ) {
        let mut state = model
            .start(start, *spin, &mut on_event)
            .expect("valid start");
        if self.by_steps {
            for step in 1..=steps {
                model.step(&mut state, &mut on_event);
                seen(step, &model.kinematics(&state));
            }
        } else {
            model.run(&mut state, steps, R::ZERO, &mut on_event);
            seen(steps, &model.kinematics(&state));
        }
    }
}

impl Use for Run<'_> {
    type Output = Value;

    fn with<R: Precision, M: Stepper<R>>(
        self,
        subject: &Subject<R, M>,
    ) -> Result<Value, ConfigError> {
        let (step, scales) = (self.scene.model.step, subject.scales);
        let steps = (self.scene.run.duration / step).round() as u64;
        let in_si = |k: &Kinematics<R>| {
            let [x, y] = k.position.map(|x| x.to_f64() * scales.length);
            let [u, v] = k.velocity.map(|v| v.to_f64() * scales.speed);
            [x, y, u, v]
        };
        let (mut samples, mut impacts): (Vec<Sample>, Vec<Impact>) = Default::default();
        self.drop(
            subject,
            steps,
            |tick, k| {
                let [x, y, u, v] = in_si(k);
                samples.push([tick as f64 * step, x, y, u, v]);
            },
            |h| {
                let [x, y, u, v] = in_si(&h.after);
                match h.change {
                    Change::Impact { speed: normal, .. } => {
                        let at = (h.at.tick as f64 + h.at.fraction.to_f64()) * step;
                        impacts.push([at, x, y, u, v, normal.to_f64() * scales.speed]);
                    }
                    // An impact that takes time: its state just after is that at its end.
                    Change::Released(_) => {
                        if let Some(impact) = impacts.last_mut() {
                            impact[1..5].copy_from_slice(&[x, y, u, v]);
                        }
                    }
                    _ => {}
                }
            },
        );
        let mut kept = Vec::new();
        let time = median_time(self.repeats, || {
            kept.clear();
            self.drop(
                subject,
                steps,
                |_, k| {
                    black_box(k);
                },
                |h| kept.push(h),
            );
            black_box(&kept);
        });
        if self.file != "-" {
            write_samples(self.file, &samples).expect("a file");
        }
        let counted = self.by_steps.then_some(steps);
        Ok(json!({ "cpu_s": time, "steps": counted, "impacts": impacts }))
    }
}

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let number = |text: &str| -> f64 { text.parse().expect("a number") };
    answer(&match arguments.as_slice() {
        [variant, "exact", duration] => exact(variant, number(duration)),
        [variant, model, way, duration, file, repeats] => {
            let scene = scene(variant, model, number(duration));
            let run = Run {
                scene: &scene,
                by_steps: *way == "steps",
                file,
                repeats: repeats.parse().expect("a count"),
            };
            with_model(&scene, run).expect("a rung that is built")
        }
        _ => panic!("three or six arguments"),
    });
}
