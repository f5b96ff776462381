//! Planar motion of a rotor's centre on active magnetic bearings (AMB) inside a
//! round retainer: the truth that a safety monitor is tested against.
//!
//! Units are SI: metres, seconds, m/s, m/s^2, rad/s. `x` points right, `y` up, the origin
//! is the retainer's centre. The rotor's mass is 1, so every force is an acceleration.
//!
//! What is modelled
//! * AMB: proportional-derivative control towards a setpoint plus plain gravity
//!   feed-forward (no integral), the total limited to `force_limit`.
//! * Unbalance: a rotating acceleration `-spin^2 * orbit(t)`; the controller is blind to the
//!   orbit (it controls place minus orbit), so a floating rotor runs on
//!   `setpoint + orbit * (cos, sin)(spin * t)` exactly and the orbit costs no AMB force.
//! * Retainer: linear spring and damper without tension (restitution does not depend on
//!   speed), Coulomb friction against the rotor's surface. The spin is constant.
//! * Whirl: friction stops driving the centre round faster than `WHIRL_HZ`; it stands for
//!   the compliance of the retainer's mount. Without it the whirl grows without bound.

/// Gravity, m/s^2, along -y.
pub const GRAVITY: f64 = 9.81;
/// A radius above this fraction of the gap is `beyond`.
pub const LIMIT: f64 = 0.8;
/// Time that the rotor has to be near its setpoint before it is `afloat`, s.
pub const SETTLE: f64 = 0.020;
/// Highest whirl frequency that friction drives, Hz.
pub const WHIRL_HZ: f64 = 200.0;
/// Loss of tangential speed while touching the retainer (lets a lying rotor stop rocking), 1/s.
pub const ROCK_LOSS: f64 = 10.0;
/// Slip speed below which friction is proportional to the slip, m/s.
pub const SLIP: f64 = 1e-3;
/// Time over which a setpoint glides when a phase begins off its place, and over which
/// `Wander` and `SlowRoll` fade in, s.
pub const GLIDE: f64 = 0.1;

/// The rotor, its bearing and its retainer.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Radial clearance of the retainer, m (1e-4 to 5e-4).
    pub gap: f64,
    /// Speed after over speed before a central impact (0.2 to 0.95).
    pub restitution: f64,
    /// Coulomb friction coefficient at the retainer.
    pub friction: f64,
    /// Spin, counter-clockwise positive, rad/s.
    pub spin: f64,
    /// Radius of the rotor's surface at the retainer, m.
    pub rotor_radius: f64,
    /// Undamped natural frequency of the closed AMB loop, Hz.
    pub natural_hz: f64,
    /// Damping ratio of the closed AMB loop.
    pub damping: f64,
    /// Radius of the synchronous orbit while floating, m. No effect at spin 0.
    pub orbit: f64,
    /// Where the rotor floats, m from the retainer's centre.
    pub float_place: [f64; 2],
    /// Largest AMB acceleration, gravity support included, m/s^2.
    pub force_limit: f64,
    /// What becomes of the orbit while the AMB is off.
    pub after: Orbit,
    /// Along -y, m/s^2; 0 where the axis stands upright.
    pub gravity: f64,
}

/// What becomes of the orbit while the AMB is off. Unless it goes on, it fades in with the lift.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orbit {
    /// Its velocity is taken away at a drop: the rotor falls like its centre of mass.
    Ends,
    /// The rotor leaves it in its tangent.
    Throws,
    /// The unbalance goes on; `spin^2 * orbit` above 1 g makes a lying rotor jump.
    GoesOn,
}

impl Default for Machine {
    fn default() -> Self {
        Machine {
            gap: 2.5e-4,
            restitution: 0.5,
            friction: 0.15,
            spin: 0.0,
            rotor_radius: 0.024,
            natural_hz: 90.0,
            damping: 0.6,
            orbit: 0.0,
            float_place: [0.0, 0.0],
            force_limit: 3.0 * GRAVITY,
            after: Orbit::Ends,
            gravity: GRAVITY,
        }
    }
}

/// Something that happens in a phase. `at` is in s from the start of the phase; every
/// disturbance ends with its phase.
#[derive(Clone, Debug)]
pub enum Disturbance {
    /// Half-sine pulse of acceleration, peak `acceleration` m/s^2.
    Shock {
        /// From the start of the phase, s.
        at: f64,
        /// s.
        duration: f64,
        /// m/s^2.
        acceleration: [f64; 2],
    },
    /// Constant acceleration from `at` on, m/s^2. The rotor hangs off its setpoint by
    /// acceleration / (2 pi natural_hz)^2 meanwhile.
    Step {
        /// From the start of the phase, s.
        at: f64,
        /// m/s^2.
        acceleration: [f64; 2],
    },
    /// Sinusoidal acceleration from `at` on, peak m/s^2.
    Shake {
        /// From the start of the phase, s.
        at: f64,
        /// 1/s.
        hz: f64,
        /// m/s^2.
        acceleration: [f64; 2],
    },
    /// The setpoint moves smoothly by `by` m within `time` s, and stays there until a lift.
    Move {
        /// From the start of the phase, s.
        at: f64,
        /// s.
        time: f64,
        /// m.
        by: [f64; 2],
    },
    /// The setpoint swings along the line `amplitude` (m) through the whole phase.
    Wander {
        /// 1/s.
        hz: f64,
        /// m.
        amplitude: [f64; 2],
    },
    /// The setpoint runs on a circle of radius `amplitude` m; negative `hz` runs clockwise.
    SlowRoll {
        /// 1/s.
        hz: f64,
        /// m.
        amplitude: f64,
    },
}

/// A part of a run; `time` is its length in s. A run that begins with `Rest`, `Lift` or `Shaken`
/// begins at rest at the bottom; one that begins with `Float` or `Drop` begins at the float place.
#[derive(Clone, Debug)]
pub enum Phase {
    /// AMB off. Only at the start of a run is the rotor put at the bottom.
    Rest {
        /// Length, s.
        time: f64,
    },
    /// AMB on; the setpoint runs smoothly from where the rotor is to the float place.
    Lift {
        /// Length, s.
        time: f64,
    },
    /// AMB on. Directly after a phase with the AMB off, the setpoint glides within `GLIDE`.
    Float {
        /// Length, s.
        time: f64,
        /// What happens in it.
        disturbances: Vec<Disturbance>,
    },
    /// AMB off; same as `Rest` except at the start of a run.
    Drop {
        /// Length, s.
        time: f64,
    },
    /// AMB off with disturbances (only accelerations matter).
    Shaken {
        /// Length, s.
        time: f64,
        /// What happens in it.
        disturbances: Vec<Disturbance>,
    },
}

impl Phase {
    /// Length, s.
    pub fn time(&self) -> f64 {
        match self {
            Phase::Rest { time } | Phase::Lift { time } | Phase::Drop { time } => *time,
            Phase::Float { time, .. } | Phase::Shaken { time, .. } => *time,
        }
    }

    fn amb_on(&self) -> bool {
        matches!(self, Phase::Lift { .. } | Phase::Float { .. })
    }
    fn disturbances(&self) -> &[Disturbance] {
        match self {
            Phase::Float { disturbances, .. } | Phase::Shaken { disturbances, .. } => disturbances,
            _ => &[],
        }
    }
}

/// What is true at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// Since the start of the run, s.
    pub time: f64,
    /// The rotor's centre, m.
    pub place: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// Where the AMB wants the rotor, without the orbit, m; the place itself while the AMB is off.
    pub setpoint: [f64; 2],
    /// Any contact since the last sample.
    pub in_contact: bool,
    /// Whether the AMB is on.
    pub amb_on: bool,
    /// In a `Float` phase, and for the last `SETTLE` s (the lift before may count) the AMB was on,
    /// there was no contact and |place - setpoint| was below 10 % of the gap plus the orbit.
    pub afloat: bool,
    /// Index into the script.
    pub phase: usize,
    /// Separate contacts that began so far (a rotor that starts lying has begun none).
    pub contacts: u32,
    /// Times that the radius rose through `LIMIT` of the gap so far; looked at every step,
    /// no hysteresis.
    pub excursions: u32,
    /// The radius is above `LIMIT` of the gap now.
    pub beyond: bool,
}

/// A run of a machine through a script. Holds no randomness: same input, same output.
#[derive(Clone, Debug)]
pub struct Plant {
    /// Longest step, s (default 5e-6). Near the wall a step is split so that a contact lasts
    /// at least 50 steps (12 below 2 mm/s). Steps are also made to end exactly at the samples.
    pub step: f64,
    m: Machine,
    phases: Vec<Phase>,
    index: usize,
    begin: f64,
    end: f64,
    total: f64,
    t: f64,
    x: [f64; 2],
    v: [f64; 2],
    r: f64,
    wall_w: f64,
    wall_zeta: f64,
    wall_step: f64,
    on: bool,
    base: [f64; 2],
    set: [f64; 2],
    glide: f64,
    glide_from: [f64; 2],
    orbit_fade: bool,
    last_bad: f64,
    touched: bool,
    contacts: u32,
    excursions: u32,
}

/// Smooth 0 to 1 for u from 0 to 1, with zero speed and acceleration at both ends.
fn smooth(u: f64) -> f64 {
    let u = u.clamp(0.0, 1.0);
    u * u * u * (10.0 + u * (6.0 * u - 15.0))
}

/// Restitution, and contact time times the undamped frequency, of a linear spring and damper
/// without tension, at damping ratio `z` < 1 (the contact ends when the force is zero).
fn impact(z: f64) -> (f64, f64) {
    let w = (1.0 - z * z).sqrt();
    let time = (std::f64::consts::PI - (2.0 * z * w).atan2(w * w - z * z)) / w;
    ((-z * time).exp(), time)
}

/// Natural frequency of the rotor on the retainer's wall, rad/s. At 0.1 m/s an impact goes at most
/// 1.5 % of the gap deep; the lower bound keeps impacts short enough that gravity during a slow one
/// hardly changes the restitution.
pub fn wall_frequency(gap: f64) -> f64 {
    (0.1 / (0.015 * gap)).max(4e4)
}

/// Length of a vector (`hypot` is slow, and its range is not needed here).
fn length(a: [f64; 2]) -> f64 {
    (a[0] * a[0] + a[1] * a[1]).sqrt()
}

impl Plant {
    /// At the start of the script.
    pub fn new(machine: &Machine, phases: &[Phase]) -> Self {
        let m = machine.clone();
        let (mut low, mut high) = (0.0, 0.999);
        for _ in 0..60 {
            let z = 0.5 * (low + high);
            if impact(z).0 > m.restitution {
                low = z
            } else {
                high = z
            }
        }
        let wall_w = wall_frequency(m.gap);
        let floating = matches!(
            phases.first(),
            Some(Phase::Float { .. } | Phase::Drop { .. })
        );
        let on = phases.first().is_some_and(|p| p.amb_on());
        let x = if floating {
            m.float_place
        } else {
            [0.0, -m.gap - m.gravity / (wall_w * wall_w)]
        };
        let mut plant = Plant {
            step: 5e-6,
            index: 0,
            begin: 0.0,
            end: phases.first().map_or(0.0, |p| p.time()),
            total: phases.iter().map(|p| p.time()).sum(),
            t: 0.0,
            x,
            v: [0.0; 2],
            r: 0.0,
            wall_w,
            wall_zeta: low,
            wall_step: impact(low).1 / wall_w / 50.0,
            on: on && floating,
            base: m.float_place,
            set: x,
            glide: 0.0,
            glide_from: x,
            orbit_fade: false,
            last_bad: if on && floating { -1.0 } else { 0.0 },
            touched: false,
            contacts: 0,
            excursions: 0,
            phases: phases.to_vec(),
            m,
        };
        if floating {
            let (o, ov) = plant.orbit(0.0);
            plant.x = [x[0] + o[0], x[1] + o[1]];
            plant.v = ov;
        }
        plant.r = length(plant.x);
        if !phases.is_empty() {
            plant.enter(0);
        }
        plant
    }

    /// Advances to the next sample, 1/`rate` s on (the first is at 1/`rate`); None at the end.
    pub fn next_sample(&mut self, rate: f64) -> Option<Truth> {
        let target = self.t + 1.0 / rate;
        if target > self.total + 1e-9 {
            return None;
        }
        self.touched = false;
        let steps = ((target - self.t) / self.step - 1e-6).ceil().max(1.0);
        let h = (target - self.t) / steps;
        for _ in 0..steps as u64 {
            while self.t >= self.end - 1e-9 && self.index + 1 < self.phases.len() {
                self.enter(self.index + 1);
            }
            let speed = self.v[0].abs() + self.v[1].abs();
            if self.r + 2.0 * h * speed + 1e-9 > self.m.gap {
                // A rotor that lies almost still does not need the fine steps of an impact.
                let fine = if speed < 2e-3 {
                    4.0 * self.wall_step
                } else {
                    self.wall_step
                };
                let parts = (h / fine).ceil().max(1.0);
                (0..parts as u32).for_each(|_| self.advance(h / parts));
            } else {
                self.advance(h);
            }
        }
        self.t = target;
        let float = matches!(self.phases[self.index], Phase::Float { .. });
        Some(Truth {
            time: self.t,
            place: self.x,
            velocity: self.v,
            setpoint: if self.on { self.set } else { self.x },
            in_contact: self.touched,
            amb_on: self.on,
            afloat: float && self.t - self.last_bad >= SETTLE,
            phase: self.index,
            contacts: self.contacts,
            excursions: self.excursions,
            beyond: self.r > LIMIT * self.m.gap,
        })
    }

    /// Begins phase `index` now.
    fn enter(&mut self, index: usize) {
        if index > 0 {
            // What the moves of the phase before have done stays.
            let at = self.t - self.begin;
            for d in self.phases[self.index].disturbances() {
                if let Disturbance::Move { at: from, time, by } = d {
                    let s = smooth((at - from) / time.max(1e-9));
                    self.base = [self.base[0] + s * by[0], self.base[1] + s * by[1]];
                }
            }
            self.begin = self.end;
            self.end = self.begin + self.phases[index].time();
        }
        self.index = index;
        let (was_on, on) = (self.on, self.phases[index].amb_on());
        if was_on && !on && self.m.after == Orbit::Ends {
            let ov = self.orbit(self.t).1;
            self.v = [self.v[0] - ov[0], self.v[1] - ov[1]];
        }
        self.on = on;
        if !on {
            return;
        }
        if !was_on {
            self.set = self.x;
            self.base = self.m.float_place;
        }
        self.glide = GLIDE;
        if let Phase::Lift { time } = self.phases[index] {
            self.glide = time.max(1e-9);
            self.base = self.m.float_place;
        }
        self.glide_from = self.set;
        self.orbit_fade = !was_on;
    }

    /// Orbit and its velocity at time `t` (within the present phase).
    fn orbit(&self, t: f64) -> ([f64; 2], [f64; 2]) {
        let (m, w) = (&self.m, self.m.spin);
        let amp = match (m.after == Orbit::GoesOn, self.on) {
            (true, _) => m.orbit,
            (false, false) => 0.0,
            (false, true) if self.orbit_fade => m.orbit * smooth((t - self.begin) / self.glide),
            (false, true) => m.orbit,
        };
        if amp == 0.0 || w == 0.0 {
            return ([0.0; 2], [0.0; 2]);
        }
        let (s, c) = (w * t).sin_cos();
        ([amp * c, amp * s], [-amp * w * s, amp * w * c])
    }

    /// Setpoint and disturbing acceleration at `at` s after the phase's start.
    fn drive(&self, at: f64) -> ([f64; 2], [f64; 2]) {
        let (mut set, mut acc) = (self.base, [0.0; 2]);
        let add = |to: &mut [f64; 2], k: f64, by: &[f64; 2]| {
            to[0] += k * by[0];
            to[1] += k * by[1];
        };
        if at < self.glide {
            let back = 1.0 - smooth(at / self.glide);
            set[0] += back * (self.glide_from[0] - self.base[0]);
            set[1] += back * (self.glide_from[1] - self.base[1]);
        }
        let turn = std::f64::consts::TAU;
        for d in self.phases[self.index].disturbances() {
            match d {
                Disturbance::Shock {
                    at: from,
                    duration,
                    acceleration,
                } => {
                    let u = (at - from) / duration;
                    if (0.0..1.0).contains(&u) {
                        add(&mut acc, (0.5 * turn * u).sin(), acceleration);
                    }
                }
                Disturbance::Step {
                    at: from,
                    acceleration,
                } if at >= *from => add(&mut acc, 1.0, acceleration),
                Disturbance::Shake {
                    at: from,
                    hz,
                    acceleration,
                } if at >= *from => add(&mut acc, (turn * hz * (at - from)).sin(), acceleration),
                Disturbance::Move { at: from, time, by } => {
                    add(&mut set, smooth((at - from) / time.max(1e-9)), by)
                }
                Disturbance::Wander { hz, amplitude } => add(
                    &mut set,
                    smooth(at / GLIDE) * (turn * hz * at).sin(),
                    amplitude,
                ),
                Disturbance::SlowRoll { hz, amplitude } => {
                    let (s, c) = (turn * hz * at).sin_cos();
                    add(&mut set, smooth(at / GLIDE) * amplitude, &[c, s]);
                }
                _ => {}
            }
        }
        (set, acc)
    }

    /// One step: half a drift, the forces at the middle, half a drift.
    fn advance(&mut self, h: f64) {
        let mid = self.t + 0.5 * h;
        let (set, mut a) = self.drive(mid - self.begin);
        let (o, ov) = self.orbit(mid);
        let (m, v) = (&self.m, self.v);
        let x = [self.x[0] + 0.5 * h * v[0], self.x[1] + 0.5 * h * v[1]];
        a[0] -= m.spin * m.spin * o[0];
        a[1] -= m.spin * m.spin * o[1] + m.gravity;
        if self.on {
            let w = std::f64::consts::TAU * m.natural_hz;
            let pull = |i: usize| {
                let set_speed = (set[i] - self.set[i]) / h;
                w * w * (set[i] + o[i] - x[i]) + 2.0 * m.damping * w * (set_speed + ov[i] - v[i])
            };
            let f = [pull(0), pull(1) + m.gravity];
            let k = (m.force_limit / length(f).max(1e-12)).min(1.0);
            a[0] += k * f[0];
            a[1] += k * f[1];
            self.set = set;
        }
        let r = length(x);
        if r > m.gap {
            let n = [x[0] / r, x[1] / r];
            let (out, along) = (v[0] * n[0] + v[1] * n[1], v[1] * n[0] - v[0] * n[1]);
            // The damper sees the speed in the middle of the step (solved for).
            let damper = 2.0 * self.wall_zeta * self.wall_w;
            let push = self.wall_w * self.wall_w * (r - m.gap) + damper * out;
            let push = (push / (1.0 + 0.5 * h * damper)).max(0.0);
            let slip = along + m.spin * m.rotor_radius;
            // Never more than what stops the slip within the step.
            let mut rub = -(m.friction * push * slip / slip.abs().max(SLIP))
                .clamp(-slip.abs() / h, slip.abs() / h);
            if rub * along > 0.0 {
                let u = along / (std::f64::consts::TAU * WHIRL_HZ * m.gap);
                rub *= (1.0 - u * u).max(0.0);
            }
            rub -= ROCK_LOSS * along;
            a[0] -= push * n[0] + rub * n[1];
            a[1] -= push * n[1] - rub * n[0];
        }
        self.v = [v[0] + h * a[0], v[1] + h * a[1]];
        self.x = [x[0] + 0.5 * h * self.v[0], x[1] + 0.5 * h * self.v[1]];
        self.t += h;
        let before = self.r;
        self.r = length(self.x);
        let (gap, limit) = (self.m.gap, LIMIT * self.m.gap);
        self.contacts += (self.r > gap && before <= gap) as u32;
        self.excursions += (self.r > limit && before <= limit) as u32;
        let touch = self.r > gap || r > gap;
        self.touched |= touch;
        let off = length([self.x[0] - set[0], self.x[1] - set[1]]);
        if !self.on || touch || off > 0.1 * gap + self.m.orbit {
            self.last_bad = self.t;
        }
    }
}

/// Deterministic random numbers (splitmix64).
#[derive(Clone, Debug)]
pub struct Rng(pub u64);

impl Rng {
    /// The next 64 bits.
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    /// Uniform in [a, b).
    pub fn uniform(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * ((self.next_u64() >> 11) as f64 / (1u64 << 53) as f64)
    }
    /// One of these.
    pub fn any<T: Copy>(&mut self, of: &[T]) -> T {
        of[(self.next_u64() % of.len() as u64) as usize]
    }
    /// Normal, mean 0, sigma 1.
    pub fn normal(&mut self) -> f64 {
        let u = 1.0 - self.uniform(0.0, 1.0);
        (-2.0 * u.ln()).sqrt() * self.uniform(0.0, std::f64::consts::TAU).cos()
    }
}

/// A sensor chain that tells the place wrongly: two planes with an x and a y channel each.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Per plane: measured = (1 + gain_error) * true.
    pub gain_error: [f64; 2],
    /// Per plane: zero error in x and y, micrometres.
    pub zero: [[f64; 2]; 2],
    /// White noise of every channel, sigma, micrometres.
    pub noise: f64,
    /// Per plane: zero drift in x and y, micrometres a second.
    pub drift: [[f64; 2]; 2],
    /// Chance that a sample is disturbed during the burst: four random counts, or
    /// `burst_height`.
    pub burst: f64,
    /// Common to all channels of a disturbed sample, micrometres, up to this and of either sign;
    /// 0: random counts.
    pub burst_height: f64,
    /// Start and end of the burst, s.
    pub burst_time: [f64; 2],
    /// Samples per second. The n-th call (from 1) is taken to be at n / rate, as in `Plant`.
    pub rate: f64,
    rng: Rng,
    calls: u64,
}

impl Chain {
    /// A chain without any error; set the fields as needed.
    pub fn new(seed: u64, rate: f64) -> Self {
        Chain {
            gain_error: [0.0; 2],
            zero: [[0.0; 2]; 2],
            drift: [[0.0; 2]; 2],
            noise: 0.0,
            burst: 0.0,
            burst_height: 0.0,
            burst_time: [0.0; 2],
            rate,
            rng: Rng(seed),
            calls: 0,
        }
    }
    /// 12-bit counts over +-1000 micrometres for a place in m: plane a x, y, plane b x, y.
    pub fn counts(&mut self, place: [f64; 2]) -> [u16; 4] {
        self.counts_of([place; 2])
    }
    /// The same of planes that are apart.
    pub fn counts_of(&mut self, places: [[f64; 2]; 2]) -> [u16; 4] {
        self.calls += 1;
        let time = self.calls as f64 / self.rate;
        let is_burst = (self.burst_time[0]..self.burst_time[1]).contains(&time);
        let is_hit = is_burst && self.rng.uniform(0.0, 1.0) < self.burst;
        let mut height = 0.0;
        if is_hit && self.burst_height > 0.0 {
            height = self.rng.uniform(-self.burst_height, self.burst_height);
        }
        std::array::from_fn(|i| {
            let (plane, axis) = (i / 2, i % 2);
            let mut um = places[plane][axis] * 1e6 * (1.0 + self.gain_error[plane])
                + self.zero[plane][axis]
                + self.drift[plane][axis] * time;
            if self.noise > 0.0 {
                um += self.noise * self.rng.normal();
            }
            if is_hit && self.burst_height == 0.0 {
                return (self.rng.next_u64() % 4096) as u16;
            }
            um += height;
            (2048.0 + um / (2000.0 / 4096.0)).round().clamp(0.0, 4095.0) as u16
        })
    }
}
