//! Which crates of the workspace there are, and which of one another they use.

use anyhow::Context;
use serde_json::Value;

use crate::toolchain::{default_cargo, output};
use crate::workspace;

/// A crate of the workspace.
#[derive(Debug)]
pub struct Member {
    /// Its package.
    pub name: String,
    /// From the workspace's root.
    pub folder: String,
    /// Folders of the crates that it uses, those of its tests left out.
    pub uses: Vec<String>,
}

/// All crates of the workspace, as cargo sees them.
pub fn members() -> anyhow::Result<Vec<Member>> {
    let mut cargo = default_cargo();
    cargo.args(["metadata", "--no-deps", "--format-version", "1", "--locked"]);
    let metadata: Value = serde_json::from_str(&output(cargo.current_dir(workspace()))?)?;
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let members = packages.map(|it| member(it).context("cargo metadata"));
    members.collect()
}

fn member(package: &Value) -> Option<Member> {
    let dependencies = package["dependencies"].as_array()?.iter();
    let used = dependencies.filter(|it| it["kind"].is_null());
    let mut uses: Vec<_> = used
        .filter_map(|it| Some(folder(it["path"].as_str()?)))
        .collect();
    uses.sort();
    Some(Member {
        name: package["name"].as_str()?.to_owned(),
        folder: folder(
            package["manifest_path"]
                .as_str()?
                .trim_end_matches("/Cargo.toml"),
        ),
        uses,
    })
}

fn folder(path: &str) -> String {
    let root = workspace().to_string_lossy();
    path.trim_start_matches(&*root)
        .trim_start_matches('/')
        .to_owned()
}

/// What `member` uses beyond what it may.
pub fn beyond<'a>(member: &'a Member, may: &[String]) -> Vec<&'a str> {
    let uses = member.uses.iter().map(String::as_str);
    uses.filter(|it| !may.iter().any(|allowed| allowed == it))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crate_that_is_used_is_seen_and_one_beyond_the_list_named() {
        let members = members().expect("metadata");
        let find = |folder: &str| members.iter().find(|it| it.folder == folder);
        let core = find("shared/core").expect("the core");
        assert_eq!(core.uses, ["shared/rotor"]);
        assert_eq!(beyond(core, &[]), ["shared/rotor"]);
        assert!(beyond(core, &["shared/rotor".to_owned()]).is_empty());
    }
}
