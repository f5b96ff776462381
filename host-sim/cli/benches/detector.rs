//! Cost of the detector's tick: levitated, and the mean over the samples of the drop `rig`.

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use touchdown_core::monitor::{Monitor, MonitorState};
use touchdown_core::sample::Sample;
use touchdown_files::stream::{Account, Records, to_sample};
use touchdown_run::drop;
use touchdown_run::target::Target;
use touchdown_scene::Scene;

fn samples(scene: &Scene) -> Vec<Sample> {
    let (_, stream) =
        drop::by_reference(scene, &Target::Host, Some(Vec::new())).expect("valid scene");
    let bytes = stream.expect("memory").expect("a stream");
    Records::new(&bytes[..], &Account::of("drop"))
        .expect("own stream")
        .map(|row| {
            to_sample(
                &row.expect("own row").row,
                &scene.sensors,
                scene.run.sample_rate,
            )
        })
        .collect()
}

fn follow(monitor: &Monitor, state: &mut MonitorState, samples: &[Sample]) {
    for sample in samples {
        black_box(monitor.update(state, sample));
    }
}

fn ticks(criterion: &mut Criterion) {
    let scene = Scene::load("rig").expect("built-in scene");
    let monitor = Monitor::try_new(&scene.monitor_config()).expect("valid scene");
    let samples = samples(&scene);
    let (levitated, dropped) = samples.split_at(scene.levitated_samples() as usize);
    let mut armed = MonitorState::default();
    follow(&monitor, &mut armed, levitated);
    assert!(armed.detector.is_armed());
    let mut group = criterion.benchmark_group("tick");
    for (name, samples) in [("levitated", levitated), ("drop", dropped)] {
        group.throughput(criterion::Throughput::Elements(samples.len() as u64));
        group.bench_function(name, |bencher| {
            bencher.iter_batched_ref(
                || armed.clone(),
                |state| follow(&monitor, state, samples),
                BatchSize::SmallInput,
            );
        });
    }
    group.finish();
}

criterion_group!(detector, ticks);
criterion_main!(detector);
