//! Runs of hours: the clock stays exact, and a step costs no digits.

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Change, Instant, Precision as Number, Rigid, RigidConfig, Start};

use crate::limits::row::Row;
use touchdown_base::progress::Progress;
use touchdown_scene::Precision;

/// Steps of 10 us at a gap of 0.3 mm.
const STEP: f64 = 1e-5;
const CLEARANCE: f64 = 0.3e-3;
const GRAVITY: f64 = 9.81;
/// Steps taken one by one.
const STEPS: u64 = 10_000_000;
/// Ticks of the long run: 2.8 h.
const TICKS: u64 = 1_000_000_000;
/// Ticks at once in it: 1 s, 64 impacts.
const STRIDE: u64 = 100_000;
/// Steps of the progress display, both precisions.
pub const JOBS: u64 = 2 * TICKS / STRIDE;

/// Straight elastic bounces from the centre, the first after sqrt(2) T and then every 2 sqrt(2) T.
pub fn rows(progress: &mut Progress) -> Result<Vec<Row>, ConfigError> {
    let exact = model()?;
    let mut rows = measure::<f64>(&exact, Precision::F64, 1e-12, progress)?;
    rows.extend(measure::<f32>(
        &exact.rounded(),
        Precision::F32,
        1e-6,
        progress,
    )?);
    Ok(rows)
}

fn model() -> Result<Rigid<f64>, ConfigError> {
    Rigid::try_new(&RigidConfig {
        mass: 3.42,
        radius: 0.024,
        polar_inertia: 0.5 * 3.42 * 0.024 * 0.024,
        clearance: CLEARANCE,
        friction: 0.0,
        restitution: 1.0,
        gravity: GRAVITY,
        speed: 1.0,
        step: STEP,
    })
}

fn measure<R: Number>(
    model: &Rigid<R>,
    precision: Precision,
    limit: f64,
    progress: &mut Progress,
) -> Result<Vec<Row>, ConfigError> {
    let ticks = |at: Instant<R>| at.tick as f64 + at.fraction.to_f64();
    let centre = Start::Free {
        position: [R::ZERO; 2],
        velocity: [R::ZERO; 2],
    };
    let mut stepped = model.start(&centre, R::ZERO, |_| ())?;
    let mut impacts = Vec::new();
    for _ in 0..STEPS {
        model.step(&mut stepped, |h| impacts.push(h.at));
    }
    let mut state = model.start(&centre, R::ZERO, |_| ())?;
    let (mut count, mut last) = (0_u64, Instant::default());
    let mut apart = 0.0_f64;
    for tick in (STRIDE..=TICKS).step_by(STRIDE as usize) {
        model.run(&mut state, Instant::at_tick(tick), |h| {
            if let Some(&other) = impacts.get(count as usize) {
                apart = apart.max((ticks(h.at) - ticks(other)).abs());
            }
            if matches!(h.change, Change::Impact { .. }) {
                count += 1;
                last = h.at;
            }
        });
        progress.advance();
    }
    let period = (2.0 * CLEARANCE / GRAVITY).sqrt() / STEP;
    let truth = period * (2.0 * count as f64 - 1.0);
    let due = ((TICKS as f64 / period + 1.0) / 2.0).floor();
    let row = |extreme| Row::of(extreme, precision);
    Ok(vec![
        row("10^7 steps against strides of 1 s: moments of the impacts")
            .at_most(apart, 0.0, "steps"),
        row("10^9 ticks (2.8 h): moment of the last impact, closed form").at_most(
            (ticks(last) / truth - 1.0).abs(),
            limit,
            "relative",
        ),
        row("10^9 ticks (2.8 h): impacts too many or too few, closed form").at_most(
            (count as f64 - due).abs(),
            1.0,
            "impacts",
        ),
    ])
}
