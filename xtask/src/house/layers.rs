//! Which crates of the workspace there are, and which of one another they use.

use serde::Deserialize;

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

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    manifest_path: String,
    dependencies: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Dependency {
    kind: Option<String>,
    path: Option<String>,
}

/// All crates of the workspace, as cargo sees them.
pub fn members() -> anyhow::Result<Vec<Member>> {
    let mut cargo = default_cargo();
    cargo.args(["metadata", "--no-deps", "--format-version", "1", "--locked"]);
    let metadata: Metadata = serde_json::from_str(&output(cargo.current_dir(workspace()))?)?;
    let members = metadata.packages.iter().map(member);
    Ok(members.collect())
}

fn member(package: &Package) -> Member {
    let manifest = &package.manifest_path;
    let used = package.dependencies.iter().filter(|it| it.kind.is_none());
    let mut uses: Vec<_> = used
        .filter_map(|it| Some(folder(it.path.as_ref()?)))
        .collect();
    uses.sort();
    Member {
        name: package.name.clone(),
        folder: folder(manifest.trim_end_matches("/Cargo.toml")),
        uses,
    }
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
