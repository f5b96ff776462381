//! A rotor inside a retainer, by steps of a microsecond and the instants of its impacts: the truth of drops whose forces
//! and wall are not those that a monitor is told. SI; the rotor's mass is 1, so a force is an acceleration.

/// The rotor, what pulls at it, and what it meets.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Radial gap, m.
    pub gap: f64,
    pub restitution: f64,
    pub friction: f64,
    /// At the retainer, m.
    pub radius: f64,
    /// rad/s.
    pub spin: f64,
    /// Of weight, side pull and what the magnets still carry, m/s^2.
    pub pull: [f64; 2],
    /// What a place adds to it, 1/s^2; above 0 it pulls outward.
    pub negative: f64,
    /// A wall that gives way: undamped frequency (Hz) of the rotor on it, its damping ratio, and way to its stop, m.
    pub soft: Option<[f64; 3]>,
    /// Magnets that hold the rotor meanwhile.
    pub held: Option<Held>,
}

/// Magnets with a position controller.
#[derive(Clone, Debug)]
pub struct Held {
    /// Of the loop, Hz.
    pub frequency: f64,
    pub damping: f64,
    /// Most acceleration, m/s^2.
    pub most: f64,
    /// Radius of the unbalance's orbit as it floats, m, and the time from 0 to it, s.
    pub orbit: [f64; 2],
    /// Base shock: begin, duration (s), acceleration.
    pub shock: Option<(f64, f64, [f64; 2])>,
}

/// A touch of the wall that was left again.
#[derive(Clone, Copy, Debug)]
pub struct Impact {
    pub time: f64,
    /// s; 0 on a rigid wall.
    pub length: f64,
    /// Into the wall, m/s.
    pub speed: f64,
    /// m/s: impulse along the normal over the mass.
    pub jump: f64,
    /// From the centre to the wall.
    pub outward: [f64; 2],
}

impl Machine {
    /// Whether magnets hold the rotor against all that disturbs it.
    pub fn is_held(&self) -> bool {
        let Some(Held {
            most, orbit, shock, ..
        }) = &self.held
        else {
            return false;
        };
        let [x, y] = shock.map_or([0.0; 2], |(.., acceleration)| acceleration);
        let [u, v] = self.pull;
        (x + u).hypot(y + v) + orbit[0] * self.spin * self.spin < *most
    }
}

#[derive(Clone, Debug, Default)]
pub struct Truth {
    pub impacts: Vec<Impact>,
    /// Begin and end of each permanent contact; the end is infinite in the last.
    pub contacts: Vec<[f64; 2]>,
    /// Angle turned in each, rad.
    pub turned: Vec<f64>,
}

pub struct Rotor {
    pub m: Machine,
    pub t: f64,
    pub x: [f64; 2],
    pub v: [f64; 2],
    pub spin: f64,
    pub angle: f64,
    pub truth: Truth,
    lies: bool,
    /// Touch of a soft wall: begin, speed, impulse so far, whether the stop was met.
    touch: Option<Impact>,
    stop_hit: bool,
}

const STEP: f64 = 1e-6;
/// Speed below which a rotor that leaves the wall and is pressed back lies, m/s.
const LIES: f64 = 2e-4;
/// Touches of a soft wall that last longer are contact, in periods of the rotor on it.
const LONG: f64 = 1.5;

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Rotor {
    pub fn new(m: &Machine, x: [f64; 2], v: [f64; 2], angle: f64) -> Self {
        Self {
            m: m.clone(),
            t: 0.0,
            x,
            v,
            spin: m.spin,
            angle,
            truth: Truth::default(),
            lies: false,
            touch: None,
            stop_hit: false,
        }
    }

    fn force(&self, x: [f64; 2], v: [f64; 2], t: f64) -> [f64; 2] {
        let m = &self.m;
        let mut f = [m.pull[0] + m.negative * x[0], m.pull[1] + m.negative * x[1]];
        if let Some(h) = &m.held {
            let w = std::f64::consts::TAU * h.frequency;
            let mut c = [0, 1].map(|i| -w * w * x[i] - 2.0 * h.damping * w * v[i] - m.pull[i]);
            let size = c[0].hypot(c[1]);
            if size > h.most {
                c = c.map(|it| it * h.most / size);
            }
            // Unbalance that would give this orbit to a free rotor.
            let [orbit, rise] = h.orbit;
            let amount = orbit * self.spin * self.spin * (t / rise).clamp(0.0, 1.0);
            f[0] += c[0] + amount * self.angle.cos();
            f[1] += c[1] + amount * self.angle.sin();
            if let Some((at, long, a)) = h.shock {
                let u = (t - at) / long;
                if (0.0..1.0).contains(&u) {
                    let s = (std::f64::consts::PI * u).sin();
                    f[0] += s * a[0];
                    f[1] += s * a[1];
                }
            }
        }
        f
    }

    /// To the instant `end`.
    pub fn run(&mut self, end: f64) {
        while self.t < end - 1e-12 {
            let h = STEP.min(end - self.t);
            if self.lies {
                self.slide(h)
            } else if self.m.soft.is_some() {
                self.soft(h)
            } else {
                self.fly(h)
            }
            self.angle += self.spin * h;
        }
    }

    fn drift(&self, h: f64) -> ([f64; 2], [f64; 2]) {
        let mid = [0, 1].map(|i| self.x[i] + 0.5 * h * self.v[i]);
        let a = self.force(mid, self.v, self.t + 0.5 * h);
        let v = [0, 1].map(|i| self.v[i] + h * a[i]);
        ([0, 1].map(|i| mid[i] + 0.5 * h * v[i]), v)
    }

    fn fly(&mut self, h: f64) {
        let (x, v) = self.drift(h);
        let r = x[0].hypot(x[1]);
        let n = [x[0] / r, x[1] / r];
        if r < self.m.gap || dot(v, n) <= 0.0 {
            (self.x, self.v) = (x, v);
            self.t += h;
            return;
        }
        // Where the wall is crossed: by the last speed.
        let back = ((r - self.m.gap) / dot(v, n)).clamp(0.0, h);
        let (x, v) = self.drift(h - back);
        let r = x[0].hypot(x[1]);
        let n = [x[0] / r, x[1] / r];
        self.x = n.map(|it| it * self.m.gap);
        self.v = v;
        self.t += h - back;
        let speed = dot(v, n);
        if speed <= 0.0 {
            self.t += back;
            return;
        }
        self.strike(n, speed);
    }

    /// On the rigid wall.
    fn strike(&mut self, n: [f64; 2], speed: f64) {
        let jump = (1.0 + self.m.restitution) * speed;
        self.rub(n, jump);
        self.v = [0, 1].map(|i| self.v[i] - jump * n[i]);
        let leaves = self.m.restitution * speed;
        let along = self.v[1] * n[0] - self.v[0] * n[1];
        let press = along * along / self.m.gap + dot(self.force(self.x, self.v, self.t), n);
        if leaves < LIES && press > 0.0 {
            self.lies = true;
            self.v = [-n[1] * along, n[0] * along];
            self.truth.contacts.push([self.t, f64::INFINITY]);
            self.truth.turned.push(0.0);
            if speed < LIES {
                return;
            }
        }
        self.truth.impacts.push(Impact {
            time: self.t,
            length: 0.0,
            speed,
            jump,
            outward: n,
        });
    }

    /// Friction of a normal impulse.
    fn rub(&mut self, n: [f64; 2], normal: f64) {
        let along = self.v[1] * n[0] - self.v[0] * n[1];
        let slip = along + self.spin * self.m.radius;
        // A solid cylinder: stops where slip = 3 times the impulse.
        let p = (self.m.friction * normal).min(slip.abs() / 3.0) * -slip.signum();
        self.v[0] -= p * n[1];
        self.v[1] += p * n[0];
        self.spin += 2.0 * p / self.m.radius;
    }

    fn slide(&mut self, h: f64) {
        let n = self.x.map(|it| it / self.m.gap);
        let along = self.v[1] * n[0] - self.v[0] * n[1];
        let f = self.force(self.x, self.v, self.t);
        let press = along * along / self.m.gap + dot(f, n);
        self.t += h;
        if press <= 0.0 {
            self.lies = false;
            if let Some(it) = self.truth.contacts.last_mut() {
                it[1] = self.t
            }
            return;
        }
        self.rub(n, press * h);
        let side = f[1] * n[0] - f[0] * n[1];
        let along = self.v[1] * n[0] - self.v[0] * n[1] + h * side;
        let turn = h * along / self.m.gap;
        if let Some(it) = self.truth.turned.last_mut() {
            *it += turn
        }
        let (s, c) = turn.sin_cos();
        let n = [n[0] * c - n[1] * s, n[0] * s + n[1] * c];
        self.x = n.map(|it| it * self.m.gap);
        self.v = [-n[1] * along, n[0] * along];
    }

    /// A wall of spring and damper that follows at once, and a rigid stop behind it.
    fn soft(&mut self, h: f64) {
        let Some([frequency, damping, way]) = self.m.soft else {
            return;
        };
        let w = std::f64::consts::TAU * frequency;
        let mid = [0, 1].map(|i| self.x[i] + 0.5 * h * self.v[i]);
        let r = mid[0].hypot(mid[1]);
        let n = [mid[0] / r, mid[1] / r];
        let mut a = self.force(mid, self.v, self.t);
        let out = dot(self.v, n);
        let push = if r > self.m.gap {
            (w * w * (r - self.m.gap) + 2.0 * damping * w * out).max(0.0)
        } else {
            0.0
        };
        for i in 0..2 {
            a[i] -= push * n[i]
        }
        self.v = [0, 1].map(|i| self.v[i] + h * a[i]);
        if push > 0.0 {
            self.rub(n, push * h)
        }
        self.x = [0, 1].map(|i| mid[i] + 0.5 * h * self.v[i]);
        self.t += h;
        let r = self.x[0].hypot(self.x[1]);
        let n = [self.x[0] / r, self.x[1] / r];
        if r >= self.m.gap + way {
            let speed = dot(self.v, n);
            if speed > 0.0 {
                let jump = (1.0 + self.m.restitution) * speed;
                self.rub(n, jump);
                self.v = [0, 1].map(|i| self.v[i] - jump * n[i]);
                if let Some(it) = &mut self.touch {
                    it.jump += jump
                }
                if speed > 5e-3 {
                    self.truth.impacts.push(Impact {
                        time: self.t,
                        length: 0.0,
                        speed,
                        jump,
                        outward: n,
                    });
                }
            }
        }
        if push > 0.0 {
            let t = self.t;
            let touch = self.touch.get_or_insert(Impact {
                time: t,
                length: 0.0,
                speed: out,
                jump: 0.0,
                outward: n,
            });
            touch.jump += push * h;
            touch.length = t - touch.time;
            if touch.length > LONG / frequency && !self.stop_hit {
                // It begins as a touch does: as an impact, which nobody has to find.
                self.truth.impacts.push(Impact {
                    jump: 0.0,
                    ..*touch
                });
                self.truth.contacts.push([touch.time, f64::INFINITY]);
                self.truth.turned.push(0.0);
                self.stop_hit = true;
            }
            if self.stop_hit {
                let along = self.v[1] * n[0] - self.v[0] * n[1];
                if let Some(it) = self.truth.turned.last_mut() {
                    *it += h * along / r
                }
            }
        } else if let Some(touch) = self.touch.take() {
            if self.stop_hit
                && let Some(it) = self.truth.contacts.last_mut()
            {
                it[1] = self.t
            }
            self.stop_hit = false;
            self.truth.impacts.push(touch);
        }
    }
}

impl Rotor {
    /// Whether it is in a contact that has not ended.
    pub fn lies(&self) -> bool {
        self.truth
            .contacts
            .last()
            .is_some_and(|it| it[1].is_infinite())
    }

    /// Whether it goes round so fast that samples do not show it.
    pub fn lies_fast(&self) -> bool {
        self.v[0].hypot(self.v[1]) > 300.0 * std::f64::consts::TAU * self.m.gap
    }
}
