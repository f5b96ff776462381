//! `touchdown scene`.

use std::io;

use serde::Serialize;

use super::args::SceneCommand;
use super::{choose, commit, load, open, say};
use crate::failure::Failure;
use crate::scene::{BUILT_IN, Scene, explain, explanation};

/// A built-in scene.
#[derive(Serialize)]
struct BuiltIn {
    name: &'static str,
    heading: String,
}

/// Explains a scene, or lists those that are built in.
pub(super) fn look(what: &SceneCommand) -> Result<(), Failure> {
    match what {
        SceneCommand::Explain { scene, json } => {
            let mut scene = load(scene)?;
            let why = choose(&mut scene)?;
            tell(json, &explanation(&scene), &(why + &explain(&scene)))
        }
        SceneCommand::List { json } => {
            let mut scenes = Vec::new();
            let mut text = String::new();
            for built_in in BUILT_IN {
                let scene = Scene::parse(built_in.name, built_in.text)?;
                let heading = scene.heading().to_owned();
                text += &format!("{:<16} {heading}\n", built_in.name);
                scenes.push(BuiltIn {
                    name: built_in.name,
                    heading,
                });
            }
            tell(json, &scenes, &text)
        }
    }
}

fn tell(json: &Option<String>, what: &impl Serialize, text: &str) -> Result<(), Failure> {
    let mut out = open(json)?;
    if let Some(out) = &mut out {
        let json = serde_json::to_string_pretty(what).map_err(io::Error::from);
        out.put(&(json.map_err(Failure::output(out.name()))? + "\n"))?;
    }
    let files = commit([out, None, None])?;
    say(&[json], &(text.to_owned() + &files));
    Ok(())
}
