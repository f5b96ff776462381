//! Optical pulse sensors that look at the inner ring and the cage of a ball bearing.

use std::f64::consts::TAU;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, Uniform};
use touchdown_core::sample::{Edges, TACHOMETERS};
use touchdown_core::tachometer::TachometersConfig;

/// The stream of random numbers of these sensors; that of the position sensors is 0.
const STREAM: u64 = 1;

/// The sensors and the bearing they look at; SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tachometers {
    /// Edges in a turn of the inner ring and of the cage; `None` where that sensor is not fitted.
    pub marks: [Option<u16>; TACHOMETERS],
    /// Cage speed over inner ring speed.
    pub cage_ratio: f64,
    /// Radius at which the ring touches the rotor, m.
    pub bore_radius: f64,
    /// Most that an edge is off its place, evenly spread, rad.
    pub edge_error: f64,
    /// Time back that the monitor measures a speed over, s.
    pub window: f64,
}

impl Tachometers {
    /// What the monitor needs to know to read the pulses.
    pub fn config(&self) -> TachometersConfig {
        TachometersConfig {
            marks: self.marks,
            cage_ratio: self.cage_ratio as f32,
            bore_radius: self.bore_radius as f32,
            edge_error: self.edge_error as f32,
            window: self.window as f32,
        }
    }
}

/// What the sensors carry from sample to sample.
#[derive(Clone, Debug)]
pub(super) struct TachometersState {
    places: ChaCha8Rng,
    channels: [Pulses; TACHOMETERS],
}

impl TachometersState {
    pub(super) fn new(seed: u64) -> Self {
        let mut places = ChaCha8Rng::seed_from_u64(seed);
        places.set_stream(STREAM);
        Self {
            places,
            channels: Default::default(),
        }
    }

    /// What the timers show when inner ring and cage have turned by `angles` (rad, whole turns
    /// included).
    pub(super) fn read(
        &mut self,
        sensors: &Tachometers,
        angles: [f64; TACHOMETERS],
    ) -> [Option<Edges>; TACHOMETERS] {
        let mut edges = [None; TACHOMETERS];
        for (channel, pulses) in self.channels.iter_mut().enumerate() {
            edges[channel] = sensors.marks[channel].map(|marks| {
                let pitch = TAU / f64::from(marks);
                let error = sensors.edge_error / pitch;
                let place = Uniform::new_inclusive(-error, error).expect("a finite error");
                pulses.advance(angles[channel] / pitch, || place.sample(&mut self.places))
            });
        }
        edges
    }
}

/// One channel; ways in units of the distance between marks.
#[derive(Clone, Debug, Default)]
struct Pulses {
    seen: Option<f64>,
    /// Way so far, in whichever direction: a mark that passes twice is two edges.
    way: f64,
    /// Number of the next edge, and its place on the way.
    number: f64,
    next: f64,
    count: u16,
    /// Samples since the last edge.
    since: f64,
}

impl Pulses {
    fn advance(&mut self, angle: f64, mut error: impl FnMut() -> f64) -> Edges {
        let Some(seen) = self.seen.replace(angle) else {
            (self.number, self.since) = (1.0, f64::INFINITY);
            self.next = self.number + error();
            return self.edges();
        };
        let step = (angle - seen).abs();
        self.way += step;
        self.since += 1.0;
        while self.next <= self.way {
            self.count = self.count.wrapping_add(1);
            self.since = (self.way - self.next) / step;
            self.number += 1.0;
            self.next = self.number + error();
        }
        self.edges()
    }

    fn edges(&self) -> Edges {
        Edges {
            count: self.count,
            age: (256.0 * self.since).min(255.0) as u8,
        }
    }
}
