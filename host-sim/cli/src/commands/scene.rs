//! `touchdown scene`.

use serde::Serialize;

use super::args::SceneCommand;
use super::{choose, load};
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_page::json::text;
use touchdown_run::explain::{explain, explanation};
use touchdown_scene::{BUILT_IN, Scene};

/// A built-in scene.
#[derive(Serialize)]
struct BuiltIn {
    name: &'static str,
    heading: String,
}

/// Explains a scene, or lists those that are built in.
pub(super) fn look(what: &SceneCommand) -> Result<(), Failure> {
    match what {
        SceneCommand::Explain { scene: name, json } => {
            let mut out = Gate::new()
                .reads("SCENE", [name])
                .writes("--json", json)
                .open()?;
            let mut scene = load(name)?;
            let why = choose(&mut scene)?;
            out.json("--json", || text(&explanation(&scene)))?;
            out.finish(&(why + &explain(&scene)))
        }
        SceneCommand::List { json } => {
            let mut out = Gate::new().writes("--json", json).open()?;
            let mut scenes = Vec::new();
            let mut lines = String::new();
            for built_in in BUILT_IN {
                let scene = Scene::parse(built_in.name, built_in.text)?;
                let heading = scene.heading().to_owned();
                lines += &format!("{:<16} {heading}\n", built_in.name);
                scenes.push(BuiltIn {
                    name: built_in.name,
                    heading,
                });
            }
            out.json("--json", || text(&scenes))?;
            out.finish(&lines)
        }
    }
}
