//! The reference cases of `data/cases`, 40-digit arithmetic, SI.

use serde::Deserialize;
use std::fs;
use std::path::Path;
use touchdown_base::history::Regime;
use touchdown_base::machine::{Machine, Start};
use touchdown_scene::Scene;

/// A case.
#[derive(Clone, Debug, Deserialize)]
pub struct Case {
    /// Starts with its number.
    pub name: String,
    /// The machine.
    pub parameters: Parameters,
    /// The start.
    pub initial: Initial,
    /// Without units.
    pub nondimensional: Nondimensional,
    /// What happens.
    pub result: Outcome,
    /// How start errors grow.
    pub conditioning: Conditioning,
}

/// Rotor and retainer.
#[derive(Clone, Copy, Debug, Deserialize)]
#[allow(non_snake_case, reason = "the files' names")]
pub struct Parameters {
    /// Clearance, m.
    pub rho0_m: f64,
    /// Gravity, m/s^2.
    pub g_m_s2: f64,
    /// Rotor radius, m.
    pub r_m: f64,
    /// Mass, kg.
    pub m_kg: f64,
    /// Polar moment of inertia, kg m^2.
    pub J_kg_m2: f64,
    /// Friction.
    pub mu: f64,
    /// Restitution.
    pub eps: f64,
}

/// Start of a case.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Initial {
    /// On the wall: angle from the bottom, rad.
    pub phi: Option<f64>,
    /// On the wall: tangential speed, m/s.
    pub vt: Option<f64>,
    /// m.
    pub x: f64,
    /// m.
    pub y: f64,
    /// m/s.
    pub vx: f64,
    /// m/s.
    pub vy: f64,
    /// Spin, rad/s.
    pub omega: f64,
}

/// Scaled parameters and their units.
#[derive(Clone, Copy, Debug, Deserialize)]
#[allow(non_snake_case, reason = "the files' names")]
pub struct Nondimensional {
    /// Polar inertia over m r^2.
    pub beta: f64,
    /// Surface speed over `V_m_s`.
    pub W0: f64,
    /// Unit of time, s.
    pub T_s: f64,
    /// Unit of speed, m/s.
    pub V_m_s: f64,
}

/// Result of a case.
#[derive(Clone, Debug, Deserialize)]
pub struct Outcome {
    /// Of the whole run.
    pub n_impacts_total: usize,
    /// The first 40.
    pub impacts: Vec<CaseImpact>,
    /// Name (`free_fall`, `bounce`, `slide`, `roll`, `lifted_flight`), start and end in s.
    pub phases: Vec<(String, f64, f64)>,
    /// s.
    pub t_permanent_contacts: Vec<f64>,
    /// s.
    pub t_lift_offs: Vec<f64>,
    /// s.
    pub t_rolling_starts: Vec<f64>,
    /// `pendulum`, `whirl`, `bouncing`.
    pub final_regime: String,
    /// Signed.
    pub turns_in_last_contact: f64,
    /// End of the run, s.
    pub t_end: f64,
    /// State at the end.
    pub final_state: FinalState,
    /// J.
    #[serde(rename = "E_final")]
    pub energy_final: f64,
}

/// An impact; the state is the one just after.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct CaseImpact {
    /// s.
    pub t: f64,
    /// m.
    pub x: f64,
    /// m.
    pub y: f64,
    /// m/s.
    pub vx: f64,
    /// m/s.
    pub vy: f64,
    /// rad/s.
    pub omega: f64,
    /// Speed into the wall just before, m/s.
    pub vn_minus: f64,
}

/// State at the end of a case.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct FinalState {
    /// m.
    pub x: f64,
    /// m.
    pub y: f64,
    /// m/s.
    pub vx: f64,
    /// m/s.
    pub vy: f64,
    /// rad/s.
    pub omega: f64,
}

/// Growth of a relative start error of one unit.
#[derive(Clone, Debug, Deserialize)]
pub struct Conditioning {
    /// Up to each impact; `None` where unknown.
    pub amplification_at_impact: Vec<Option<f64>>,
    /// Up to the last impact of the run.
    pub amplification_last: Option<f64>,
}

impl Case {
    /// Its machine.
    pub fn machine(&self) -> Machine {
        Machine {
            mass: self.parameters.m_kg,
            radius: self.parameters.r_m,
            polar_inertia: self.parameters.J_kg_m2,
            clearance: self.parameters.rho0_m,
            friction: self.parameters.mu,
            restitution: self.parameters.eps,
            gravity: self.parameters.g_m_s2,
        }
    }

    /// Its start.
    pub fn start(&self) -> Start {
        let initial = &self.initial;
        match (initial.phi, initial.vt) {
            (Some(angle), Some(tangential)) => Start::Wall { angle, tangential },
            _ => Start::Free {
                position: [initial.x, initial.y],
                velocity: [initial.vx, initial.vy],
            },
        }
    }

    /// The rig's scene with the case in it.
    ///
    /// # Panics
    /// If the built-in scene is broken.
    pub fn scene(&self) -> Scene {
        let mut scene = Scene::load("rig").expect("built-in scene");
        let machine = self.machine();
        scene.rotor.mass = machine.mass;
        scene.rotor.radius = machine.radius;
        scene.rotor.polar_inertia = machine.polar_inertia;
        scene.rotor.spin = self.initial.omega;
        scene.retainer.clearance = machine.clearance;
        scene.retainer.friction = machine.friction;
        scene.retainer.restitution = machine.restitution;
        scene.run.gravity = machine.gravity;
        scene.run.duration = self.result.t_end;
        scene.start = self.start();
        scene
    }

    /// The regime at the end.
    ///
    /// # Panics
    /// If the case's name for it is unknown.
    pub fn regime(&self) -> Regime {
        match self.result.final_regime.as_str() {
            "pendulum" => Regime::Pendulum,
            "bouncing" => Regime::Bouncing,
            "whirl" if self.result.turns_in_last_contact * self.initial.omega < 0.0 => {
                Regime::BackwardWhirl
            }
            "whirl" => Regime::ForwardWhirl,
            other => panic!("unknown regime {other}"),
        }
    }

    /// Growth up to an impact, at least 1.
    pub fn amplification(&self, impact: usize) -> f64 {
        let known = self.conditioning.amplification_at_impact.get(impact);
        known.copied().flatten().unwrap_or(1.0).max(1.0)
    }
}

/// All cases, in the order of their names.
///
/// # Panics
/// If a file can't be read: a broken checkout.
pub fn open_cases() -> Vec<Case> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/cases");
    let mut cases: Vec<Case> = fs::read_dir(&folder)
        .expect("data/cases exists")
        .map(|entry| entry.expect("readable entry").path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "json")
        })
        .map(|path| {
            let text = fs::read_to_string(&path).expect("readable case");
            serde_json::from_str(&text)
                .unwrap_or_else(|error| panic!("{}: {error}", path.display()))
        })
        .collect();
    assert!(!cases.is_empty(), "no cases in {}", folder.display());
    cases.sort_by(|a, b| a.name.cmp(&b.name));
    cases
}
