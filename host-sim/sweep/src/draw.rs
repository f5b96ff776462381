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
                let speed = start.speed * random.random_range(0.0..=1.0);
                (place, direction(&mut random).map(|part| speed * part))
            }),
        }
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
        if self
            .last
            .as_ref()
            .is_none_or(|(point, ..)| *point != drawn.point)
        {
            let mut table = self.plan.base.clone();
            let values = self.plan.values(drawn.point);
            for ((key, _), value) in self.plan.listed.iter().zip(values) {
                set(&mut table, key, value).map_err(|rule| self.refused(&rule))?;
            }
            let scene = self.parse(&table)?;
            self.last = Some((drawn.point, table, scene));
        }
        let Some((_, table, scene)) = &self.last else {
            return Err(self.refused("no scene"));
        };
        let mut scene = if drawn.values.is_empty() {
            scene.clone()
        } else {
            let mut table = table.clone();
            for ((key, _), value) in self.plan.drawn.iter().zip(&drawn.values) {
                set(&mut table, key, &Value::Float(*value)).map_err(|rule| self.refused(&rule))?;
            }
            self.parse(&table)?
        };
        if let Some((place, velocity)) = drawn.start {
            scene.start = Start::Free {
                position: place.map(|part| part * scene.retainer.clearance),
                velocity,
            };
        }
        Ok(scene)
    }

    fn parse(&self, table: &Table) -> Result<Scene, Failure> {
        Scene::parse("the scene", &table.to_string()).map_err(|error| self.refused(error.rule()))
    }

    /// Values that are valid each by itself need not be so together.
    fn refused(&self, rule: &str) -> Failure {
        InputError::of_file(&self.plan.name, format!("a drop of this plan: {rule}")).into()
    }
}
