//! The plan of a sweep: `PLAN.toml`.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json, json};
use toml::{Spanned, Table, Value};

use super::find::limit;
use super::parameter::{Distribution, ParameterTable, Values, as_number};
use touchdown_base::input_error::{InputError, LARGEST_TOML};
use touchdown_scene::Scene;
use touchdown_scene::file::tables;

/// Most drops of a sweep.
const MOST_DROPS: u64 = 1_000_000_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PlanFile {
    title: Option<String>,
    scene: Spanned<String>,
    drops: Option<Spanned<u64>>,
    #[serde(default)]
    until: Until,
    find: Option<Spanned<String>>,
    #[serde(default = "default_seed")]
    seed: u64,
    start: Option<Spanned<RandomStart>>,
    #[serde(default)]
    parameter: Vec<ParameterTable>,
}

/// How far each drop is followed.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Until {
    /// To the end of the run.
    #[default]
    End,
    /// To where its regime can no longer change.
    Verdict,
}

/// Drops a point of the grid.
const DROPS: u64 = 1_000;
/// Most drops of a value where one is looked for.
const DROPS_TO_FIND: u64 = 200_000;

fn default_seed() -> u64 {
    1
}

/// Key and values of an axis of the grid.
pub(super) type Listed = (String, Vec<Value>);

/// A valid plan.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Its file.
    pub name: String,
    /// The file of its scene; none of a built-in one.
    pub scene_file: Option<PathBuf>,
    /// One line.
    pub title: String,
    /// Drops a point of the grid.
    pub drops: u64,
    pub(super) until: Until,
    /// What is looked for along the one axis of the grid: where whirl is less probable than this.
    pub find: Option<f64>,
    pub(super) seed: u64,
    pub(super) start: Option<RandomStart>,
    pub(super) listed: Vec<Listed>,
    pub(super) drawn: Vec<(String, Distribution)>,
    /// The scene that the parameters change, and the text that it comes from.
    pub(super) base: Table,
    pub(super) scene_text: String,
    pub(super) text: String,
}

/// Starts anywhere in the middle of the gap.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(super) struct RandomStart {
    /// Radius of the disc, part of the clearance.
    pub within: f64,
    /// Greatest speed, in any direction.
    #[serde(default)]
    pub speed_mm_s: f64,
}

impl Plan {
    /// Reads the plan at `path`. Its scene is a file beside it, or a built-in one.
    pub fn load(path: &str) -> Result<Self, InputError> {
        let text = InputError::read(Path::new(path), LARGEST_TOML)?;
        let file: PlanFile = tables(path, &text)?;
        let scene = file.scene.get_ref();
        let beside = Path::new(path).with_file_name(scene);
        let name = if beside.exists() {
            beside.display().to_string()
        } else {
            scene.clone()
        };
        let scene_text = Scene::text(&name).map_err(|error| {
            let rule = format!("scene {scene:?}: {}", error.rule());
            InputError::at_span(path, &text, file.scene.span(), rule)
        })?;
        let mut plan = Self::of_texts(path, &text, &scene_text)?;
        plan.scene_file = Some(PathBuf::from(name)).filter(|it| it.is_file());
        Ok(plan)
    }

    /// The plan `text` over the scene `scene_text`; errors name it `name`.
    pub fn of_texts(name: &str, text: &str, scene_text: &str) -> Result<Self, InputError> {
        let file: PlanFile = tables(name, text)?;
        let fail = |span, rule: String| InputError::at_span(name, text, span, rule);
        let scene_name = file.scene.get_ref();
        let of_scene = |what: &str| fail(file.scene.span(), format!("scene {scene_name:?}{what}"));
        let scene = Scene::parse(scene_name, scene_text).map_err(InputError::of_named_file)?;
        if scene.auto.is_some() {
            return Err(of_scene(
                " leaves the model open (fidelity = \"auto\"): a sweep needs one rung, which \
                 `touchdown scene explain` chooses for one drop",
            ));
        }
        let base = toml::from_str(scene_text);
        let base = base.map_err(|error| of_scene(&format!(": {}", error.message())))?;
        let find = file.find.as_ref();
        let find = find.map(|rule| limit(rule.get_ref()).map_err(|it| fail(rule.span(), it)));
        let find = find.transpose()?;
        let default = if find.is_some() { DROPS_TO_FIND } else { DROPS };
        let drops = file.drops.unwrap_or(Spanned::new(0..0, default));
        let mut plan = Self {
            name: name.to_owned(),
            scene_file: None,
            title: (file.title).unwrap_or_else(|| scene.heading().to_owned()),
            drops: *drops.get_ref(),
            until: if find.is_some() {
                Until::Verdict
            } else {
                file.until
            },
            find,
            seed: file.seed,
            start: None,
            listed: Vec::new(),
            drawn: Vec::new(),
            base,
            scene_text: scene_text.to_owned(),
            text: text.to_owned(),
        };
        if let Some(start) = &file.start {
            let RandomStart { within, speed_mm_s } = *start.get_ref();
            if !(0.0..1.0).contains(&within) || !(0.0..=1e6).contains(&speed_mm_s) {
                let rule =
                    "start: within is a part of the clearance, 0 to below 1; speed_mm_s 0 or more";
                return Err(fail(start.span(), rule.to_owned()));
            }
            plan.start = Some(*start.get_ref());
        }
        for table in &file.parameter {
            let key = table.key.get_ref();
            plan.add(key, table)
                .map_err(|rule| fail(table.key.span(), format!("{key}: {rule}")))?;
        }
        if let Some(rule) = &file.find {
            plan.is_one_axis().map_err(|it| fail(rule.span(), it))?;
        }
        let all_alike = plan.start.is_none() && plan.drawn.is_empty();
        if plan.drops == 0 || (all_alike && plan.drops > 1) {
            let rule = "drops must be 1 or more; above 1 they need something random: a [start], or a \
                        parameter that is drawn";
            return Err(fail(drops.span(), rule.to_owned()));
        }
        if plan.total().is_none_or(|total| total > MOST_DROPS) {
            let rule = format!("more than {MOST_DROPS} drops in all");
            return Err(fail(drops.span(), rule));
        }
        Ok(plan)
    }

    fn add(&mut self, key: &str, table: &ParameterTable) -> Result<(), String> {
        if self.keys().any(|it| it == key) {
            return Err("is there twice".to_owned());
        }
        if key == "run.seed" || (self.start.is_some() && key.starts_with("start.")) {
            return Err("is drawn for each drop already".to_owned());
        }
        let values = table.values()?;
        let tried = match &values {
            Values::Listed(values) => values.clone(),
            Values::Drawn(drawn) => drawn.samples().into_iter().map(Value::Float).collect(),
        };
        for value in tried {
            let mut scene = self.base.clone();
            set(&mut scene, key, &value)?;
            Scene::parse("the scene", &scene.to_string())
                .map_err(|error| error.rule().to_owned())?;
        }
        match values {
            Values::Listed(values) => self.listed.push((key.to_owned(), values)),
            Values::Drawn(drawn) => self.drawn.push((key.to_owned(), drawn)),
        }
        Ok(())
    }

    /// Whether what is looked for can be bracketed: one axis, of numbers in their order.
    fn is_one_axis(&self) -> Result<(), String> {
        let rule = "find needs one [[parameter]] with two or more numbers in their order, and no other list";
        let [(_, values)] = self.listed.as_slice() else {
            return Err(rule.to_owned());
        };
        let numbers: Option<Vec<f64>> = values.iter().map(as_number).collect();
        let numbers = numbers.ok_or(rule)?;
        let is_rising = numbers.is_sorted_by(|a, b| a < b);
        if numbers.len() < 2 || !(is_rising || numbers.is_sorted_by(|a, b| a > b)) {
            return Err(rule.to_owned());
        }
        Ok(())
    }

    /// The same plan with these of its one axis' values alone.
    pub(super) fn of_values(&self, points: &[u64]) -> Self {
        let mut plan = self.clone();
        for (_, values) in &mut plan.listed {
            *values = (points.iter().map(|it| values[*it as usize].clone())).collect();
        }
        plan
    }

    /// The listed ones, then those that are drawn.
    pub(super) fn keys(&self) -> impl Iterator<Item = &str> {
        let listed = self.listed.iter().map(|(key, _)| key.as_str());
        listed.chain(self.drawn.iter().map(|(key, _)| key.as_str()))
    }

    /// Points of the grid.
    pub fn points(&self) -> u64 {
        self.counts().product()
    }

    fn counts(&self) -> impl Iterator<Item = u64> {
        self.listed.iter().map(|(_, values)| values.len() as u64)
    }

    /// Drops in all.
    fn total(&self) -> Option<u64> {
        let points = self.counts().try_fold(1, u64::checked_mul)?;
        points.checked_mul(self.drops)
    }

    /// Drops in all.
    pub fn size(&self) -> u64 {
        self.points() * self.drops
    }

    /// Keys and values of a point of the grid, for programs.
    pub(super) fn named_values(&self, point: u64) -> Map<String, Json> {
        let values = self.listed.iter().zip(self.values(point));
        // Numbers, texts and booleans are always JSON.
        (values.map(|((key, _), value)| (key.clone(), json!(value)))).collect()
    }

    /// The listed values of a point; the first parameter changes slowest.
    pub(super) fn values(&self, point: u64) -> Vec<&Value> {
        let mut left = point;
        let mut values: Vec<_> = (self.listed.iter().rev())
            .map(|(_, values)| {
                let count = values.len() as u64;
                let value = &values[(left % count) as usize];
                left /= count;
                value
            })
            .collect();
        values.reverse();
        values
    }
}

/// Gives `key`, as in `retainer.friction` or `ring.0.clearance_mm`, a value.
pub(super) fn set(scene: &mut Table, key: &str, value: &Value) -> Result<(), String> {
    let rule = || "is no key of a scene: table.key, or table.number.key".to_owned();
    let parts: Vec<_> = key.split('.').collect();
    let (last, tables) = parts.split_last().ok_or_else(rule)?;
    let (first, rest) = tables.split_first().ok_or_else(rule)?;
    let mut inner = scene
        .entry(*first)
        .or_insert_with(|| Value::Table(Table::new()));
    for part in rest {
        let number: usize = part.parse().map_err(|_| rule())?;
        inner = inner.get_mut(number).ok_or_else(rule)?;
    }
    let table = inner.as_table_mut().ok_or_else(rule)?;
    table.insert((*last).to_owned(), value.clone());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_scene::BUILT_IN;

    fn plan(text: &str) -> Result<Plan, InputError> {
        Plan::of_texts("plan.toml", text, BUILT_IN[0].text)
    }

    #[test]
    fn the_first_parameter_changes_slowest() {
        let plan = plan(
            "scene = \"rig\"\ndrops = 1\n[[parameter]]\nkey = \"retainer.friction\"\nvalues = [0.1, 0.2]\n\
             [[parameter]]\nkey = \"retainer.restitution\"\nvalues = [0.3, 0.5, 0.8]\n",
        )
        .expect("a valid plan");
        assert_eq!(plan.points(), 6);
        let of = |point| {
            plan.values(point)
                .iter()
                .map(|it| it.as_float().unwrap())
                .collect::<Vec<_>>()
        };
        assert_eq!(of(0), [0.1, 0.3]);
        assert_eq!(of(2), [0.1, 0.8]);
        assert_eq!(of(3), [0.2, 0.3]);
    }

    #[test]
    fn a_scene_that_leaves_the_model_open_is_refused() {
        let scene = format!("fidelity = \"auto\"\n{}", BUILT_IN[0].text);
        let text = "drops = 1\nscene = \"open\"\n";
        let error = Plan::of_texts("plan.toml", text, &scene).expect_err("auto");
        assert_eq!(error.line(), Some(2), "{error}");
        assert!(error.rule().contains("fidelity"), "{error}");
    }

    #[test]
    fn flaws_name_their_line() {
        for (text, line, part) in [
            ("scene = \"rig\"\ndrops = 5\n", 2, "random"),
            (
                "scene = \"rig\"\n\n[[parameter]]\nkey = \"retainer.friction\"\nvalues = [-1]\n",
                4,
                "friction",
            ),
            (
                "scene = \"rig\"\n\n[[parameter]]\nkey = \"retainer.fiction\"\nvalues = [1]\n",
                4,
                "unknown key",
            ),
            (
                "scene = \"rig\"\n[[parameter]]\nkey = \"friction\"\nvalues = [1]\n",
                3,
                "table.key",
            ),
            ("scene = \"rig\"\n[start]\nwithin = 1.5\n", 2, "within"),
            ("scene = \"rig\"\nspeed = 1\n", 2, "unknown key"),
            ("scene = \"rig\"\nfind = \"whirl < 2\"\n", 2, "0 to 1"),
            (
                "scene = \"rig\"\nfind = \"whirl < 0.1\"\n[start]\nwithin = 0.5\n",
                2,
                "one [[parameter]]",
            ),
            ("scene = \"rig\"\nuntil = \"noon\"\n", 2, "verdict"),
        ] {
            let error = plan(text).expect_err(text);
            assert_eq!(error.line(), Some(line), "{text}: {error}");
            assert!(error.rule().contains(part), "{text}: {error}");
        }
    }
}
