//! The scene of a drop: the plan's, with the drop's values and start.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use toml::{Table, Value};

use super::plan::{Plan, set};
use touchdown_base::evenly::{direction, in_disc};
use touchdown_base::failure::Failure;
use touchdown_base::input_error::InputError;
use touchdown_scene::{Scene, Start};

/// A drop before it begins.
pub(super) struct Drawn {
    /// Point of the grid.
    pub point: u64,
    /// Of the parameters that are drawn.
    pub values: Vec<f64>,
    /// In parts of the clearance, and m/s: where the start is drawn.
    pub start: Option<([f64; 2], [f64; 2])>,
}

impl Plan {
    /// What is random of drop `index`.
    pub(super) fn draw(&self, index: u64) -> Drawn {
        self.draw_at(index / self.drops, index)
    }

    /// The random numbers of drop `index` at a point of the grid.
    pub(super) fn draw_at(&self, point: u64, index: u64) -> Drawn {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(index);
        Drawn {
            point,
            values: (self.drawn.iter())
                .map(|(_, distribution)| distribution.draw(&mut random))
                .collect(),
            start: self.start.map(|start| {
                let place = in_disc(&mut random, start.within);
                let speed = start.speed_mm_s / 1e3 * random.random_range(0.0..=1.0);
                (place, direction(&mut random).map(|part| speed * part))
            }),
        }
    }

    /// The scene `table` with other values. Those that are valid each by itself need not be so together.
    fn with<'a>(
        &self,
        table: &Table,
        values: impl Iterator<Item = (&'a String, Value)>,
    ) -> Result<(Table, Scene), Failure> {
        let refused =
            |rule: &str| InputError::of_file(&self.name, format!("a drop of this plan: {rule}"));
        let mut table = table.clone();
        for (key, value) in values {
            set(&mut table, key, &value).map_err(|rule| refused(&rule))?;
        }
        let scene = Scene::parse("the scene", &table.to_string());
        let scene = scene.map_err(|error| refused(error.rule()))?;
        Ok((table, scene))
    }
}

/// Scenes of one drop after the other; what they share is read once.
pub(super) struct Scenes<'a> {
    pub(super) plan: &'a Plan,
    last: Option<(u64, Table, Scene)>,
}

impl<'a> Scenes<'a> {
    pub fn new(plan: &'a Plan) -> Self {
        Self { plan, last: None }
    }

    /// The scene of a drop.
    pub fn of(&mut self, drawn: &Drawn) -> Result<Scene, Failure> {
        let plan = self.plan;
        let last = match self.last.take() {
            Some(last) if last.0 == drawn.point => last,
            _ => {
                let listed = plan.listed.iter().zip(plan.values(drawn.point));
                let keys = listed.map(|((key, _), value)| (key, value.clone()));
                let (table, scene) = plan.with(&plan.base, keys)?;
                (drawn.point, table, scene)
            }
        };
        let (_, table, scene) = self.last.insert(last);
        let mut scene = if drawn.values.is_empty() {
            scene.clone()
        } else {
            let values = plan.drawn.iter().zip(&drawn.values);
            let keys = values.map(|((key, _), value)| (key, Value::Float(*value)));
            plan.with(table, keys)?.1
        };
        if let Some((place, velocity)) = drawn.start {
            scene.start = Start::Free {
                position: place.map(|part| part * scene.retainer.clearance),
                velocity,
            };
        }
        Ok(scene)
    }
}
