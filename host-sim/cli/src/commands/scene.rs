//! `touchdown scene`.

use serde::Serialize;

use super::args::SceneCommand;
use super::{choose, load};
use crate::gate::Gate;
use touchdown_base::failure::Failure;
use touchdown_lab::trade::parts::{self, Worth};
use touchdown_page::json::text;
use touchdown_run::explain::{Explanation, explain, explanation};
use touchdown_scene::{BUILT_IN, Scene};

/// A built-in scene.
#[derive(Serialize)]
struct BuiltIn {
    name: &'static str,
    heading: String,
}

/// An explanation, and what each part is worth where that was asked for.
#[derive(Serialize)]
struct Explained {
    #[serde(flatten)]
    explanation: Explanation,
    #[serde(skip_serializing_if = "Option::is_none")]
    parts: Option<Worth>,
}

/// Explains a scene, or lists those that are built in.
pub(super) fn look(what: &SceneCommand) -> Result<(), Failure> {
    match what {
        SceneCommand::Explain {
            scene: name,
            json,
            drops,
        } => {
            let mut out = Gate::new()
                .reads("SCENE", [name])
                .writes("--json", json)
                .open()?;
            let mut scene = load(name)?;
            let why = choose(&mut scene)?;
            let parts = (*drops > 0).then(|| parts::run(&scene, Some(*drops as usize)));
            let explanation = explanation(&scene);
            let explained = Explained { explanation, parts };
            out.json("--json", || text(&explained))?;
            out.finish(|paint| {
                let worth = explained.parts.as_ref();
                let worth = worth.map(|it| "\n".to_owned() + &parts::text(it, paint));
                why + &explain(&scene) + &worth.unwrap_or_default()
            })
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
            out.finish(|_| lines)
        }
    }
}
