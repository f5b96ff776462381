//! One plane of a floating rotor: where it floats, and which way round it orbits.
//!
//! Looked at once in a quarter of a turn: the cross product of two such places is the square of the orbit's
//! radius, positive where it goes counter-clockwise. Unbalance and runout go with the spin; an axis that is
//! reversed, or two that are swapped, show it the other way.

/// Looks in which the sense is decided.
const LOOKS: u16 = 256;
/// Seconds that the place is learnt over.
const PLACE_TIME: f32 = 0.5;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OrbitSense {
    threshold: f32,
    /// Square of the least radius that counts, m^2.
    least: f32,
    memory: u16,
}

/// What is known of a plane.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct OrbitSenseState {
    place: [f32; 2],
    home: Option<[f32; 2]>,
    seen: u16,
    last: [f32; 2],
    sum: f32,
    squares: f32,
    looks: u16,
    /// Which way it orbits: 1 counter-clockwise, -1 clockwise, 0 unknown.
    pub(crate) sense: i8,
}

impl OrbitSense {
    /// Looks `rate` times a second; orbits smaller than `least` (m) do not count.
    pub(crate) fn new(threshold: f32, least: f32, rate: f32) -> Self {
        Self {
            threshold,
            least: least * least,
            memory: (PLACE_TIME * rate).clamp(16.0, 60_000.0) as u16,
        }
    }

    /// Takes a position, m.
    pub(crate) fn take(&self, it: &mut OrbitSenseState, [x, y]: [f32; 2]) {
        it.seen = it.seen.saturating_add(1).min(self.memory);
        let gain = 1.0 / f32::from(it.seen);
        it.place[0] += gain * (x - it.place[0]);
        it.place[1] += gain * (y - it.place[1]);
        if it.seen == self.memory && it.home.is_none() {
            it.home = Some(it.place);
        }
        if u32::from(it.seen) * 8 < u32::from(self.memory) {
            return;
        }
        let now = [x - it.place[0], y - it.place[1]];
        let cross = it.last[0] * now[1] - it.last[1] * now[0];
        it.last = now;
        it.sum += cross;
        it.squares += cross * cross;
        it.looks += 1;
        if it.looks < LOOKS {
            return;
        }
        let certain = it.sum * it.sum > 2.0 * self.threshold * it.squares;
        let large = it.sum.abs() > self.least * f32::from(LOOKS);
        it.sense = match (certain && large, it.sum > 0.0) {
            (false, _) => 0,
            (true, true) => 1,
            (true, false) => -1,
        };
        it.sum = 0.0;
        it.squares = 0.0;
        it.looks = 0;
    }
}

impl OrbitSenseState {
    /// Way from where it floated first, m.
    pub(crate) fn drift(&self) -> [f32; 2] {
        self.home.map_or([0.0; 2], |home| {
            [self.place[0] - home[0], self.place[1] - home[1]]
        })
    }
}
