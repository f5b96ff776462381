//! Cost of the model, on the drop of the built-in scene `rig`: a step in each motion, what a change
//! of motion costs, and the whole drop of 0.3 s.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Change, ModelEvent, Precision, Stepper};
use touchdown_run::model::{Subject, Use, with_model};
use touchdown_scene::Scene;

/// s.
const STEPS: [f64; 3] = [1e-5, 5e-5, 1e-3];
/// Step of all rows about single steps, s.
const FINE: f64 = 1e-5;
/// Within the first fall of 7.8 ms, s.
const IN_FLIGHT: f64 = 7e-3;
/// After the bounce series, which takes 69 ms, s.
const IN_CONTACT: f64 = 0.1;

fn rig(precision: touchdown_scene::Precision, step: f64) -> Scene {
    let mut scene = Scene::load("rig").expect("built-in scene");
    scene.model.precision = precision;
    scene.model.step = step;
    scene
}

fn whole_steps(time: f64, step: f64) -> u64 {
    (time / step).round() as u64
}

/// The model at `steps` of its run.
fn state_at<R: Precision, M: Stepper<R>>(subject: &Subject<R, M>, steps: u64) -> M::State {
    let Subject {
        model, start, spin, ..
    } = subject;
    let mut state = model.start(start, *spin, |_| {}).expect("valid start");
    model.run(&mut state, steps, R::ZERO, |_| {});
    state
}

/// Rows of single steps and changes.
struct Parts<'a> {
    criterion: &'a mut Criterion,
    precision: touchdown_scene::Precision,
}

impl Use for Parts<'_> {
    type Output = ();

    fn with<R: Precision, M: Stepper<R>>(self, subject: &Subject<R, M>) -> Result<(), ConfigError> {
        let model = &subject.model;
        let digits: &str = self.precision.into();
        let mut group = self.criterion.benchmark_group("rigid");

        let released = state_at(subject, 0);
        let steps = whole_steps(IN_FLIGHT, FINE);
        group.bench_function(format!("flight step/{digits}"), |bencher| {
            let (mut state, mut done) = (released.clone(), 0);
            bencher.iter(|| {
                if done == steps {
                    (state, done) = (released.clone(), 0);
                }
                done += 1;
                model.step(&mut state, |_| {});
                black_box(&model.kinematics(&state));
            });
        });

        // Goes on: what the rare new stretch of contact costs is in the mean.
        let mut state = state_at(subject, whole_steps(IN_CONTACT, FINE));
        group.bench_function(format!("contact step/{digits}"), |bencher| {
            bencher.iter(|| {
                model.step(&mut state, |_| {});
                black_box(&model.kinematics(&state));
            });
        });

        // 7.81 to 7.82 ms: the first impact, and its next landing solved for.
        let before = state_at(subject, 781);
        group.bench_function(format!("impact/{digits}"), |bencher| {
            bencher.iter(|| {
                let mut state = before.clone();
                let mut normal = R::ZERO;
                model.step(&mut state, |happening| {
                    if let Change::Impact { speed, .. } = happening.change {
                        normal = speed;
                    }
                });
                assert!(normal > R::ZERO);
                black_box(state)
            });
        });

        let mut state = state_at(subject, whole_steps(IN_CONTACT, FINE));
        group.bench_function(format!("10 ms of contact/{digits}"), |bencher| {
            bencher.iter(|| model.run(&mut state, whole_steps(1e-2, FINE), R::ZERO, |_| {}));
        });
        group.finish();
        Ok(())
    }
}

/// Rows of whole drops.
struct Drops<'a> {
    criterion: &'a mut Criterion,
    scene: &'a Scene,
}

impl Use for Drops<'_> {
    type Output = ();

    fn with<R: Precision, M: Stepper<R>>(
        self,
        Subject {
            model, start, spin, ..
        }: &Subject<R, M>,
    ) -> Result<(), ConfigError> {
        let step = self.scene.model.step;
        let digits: &str = self.scene.model.precision.into();
        let steps = whole_steps(self.scene.run.duration, step);
        let mut history: Vec<ModelEvent<R>> = Vec::new();
        let mut group = self.criterion.benchmark_group("drop of 0.3 s");
        group.sample_size(20);
        group.bench_function(
            format!("steps of {:.0} us/{digits}", step * 1e6),
            |bencher| {
                bencher.iter(|| {
                    history.clear();
                    let mut state = model
                        .start(start, *spin, |h| history.push(h))
                        .expect("valid");
                    for _ in 0..steps {
                        model.step(&mut state, |h| history.push(h));
                        black_box(model.kinematics(&state));
                    }
                    history.len()
                });
            },
        );
        group.bench_function(
            format!("changes alone, {:.0} us/{digits}", step * 1e6),
            |bencher| {
                bencher.iter(|| {
                    history.clear();
                    let mut state = model
                        .start(start, *spin, |h| history.push(h))
                        .expect("valid");
                    model.run(&mut state, steps, R::ZERO, |h| history.push(h));
                    black_box(model.kinematics(&state));
                    history.len()
                });
            },
        );
        group.finish();
        Ok(())
    }
}

fn parts(criterion: &mut Criterion) {
    for precision in touchdown_scene::Precision::ALL {
        let parts = Parts {
            criterion: &mut *criterion,
            precision,
        };
        with_model(&rig(precision, FINE), parts).expect("valid scene");
    }
}

fn drops(criterion: &mut Criterion) {
    for precision in touchdown_scene::Precision::ALL {
        for step in STEPS {
            let drops = Drops {
                criterion: &mut *criterion,
                scene: &rig(precision, step),
            };
            with_model(drops.scene, drops).expect("valid scene");
        }
    }
}

criterion_group!(model, parts, drops);
criterion_main!(model);
