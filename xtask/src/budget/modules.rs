//! Where an image's code comes from: bytes by module, from its line table, which knows what was inlined.

use std::collections::BTreeMap;
use std::path::Path;

use addr2line::Context;
use addr2line::gimli::{self, Dwarf, EndianSlice, LittleEndian, SectionId};
use object::{Object, ObjectSection};

use super::Module;
use crate::files;
use crate::firmware::FLASH;

/// Bytes of code by module, the largest first.
pub fn modules(image: &Path) -> anyhow::Result<Vec<Module>> {
    let bytes = files::bytes(image)?;
    let file = object::File::parse(&*bytes)?;
    let section = |id: SectionId| {
        let section = file.section_by_name(id.name());
        let data = section.and_then(|it| it.data().ok()).unwrap_or_default();
        Ok::<_, gimli::Error>(EndianSlice::new(data, LittleEndian))
    };
    let context = Context::from_dwarf(Dwarf::load(section)?)?;
    let mut sums = BTreeMap::new();
    for (_, bytes, place) in context.find_location_range(FLASH.start, FLASH.end)? {
        *sums
            .entry(module(place.file.unwrap_or_default()))
            .or_insert(0) += bytes;
    }
    let named = sums
        .into_iter()
        .map(|(module, bytes)| Module { module, bytes });
    let mut modules: Vec<_> = named.collect();
    modules.sort_by_key(|it| std::cmp::Reverse(it.bytes));
    Ok(modules)
}

/// Module of ours, or package, that a source file belongs to.
fn module(path: &str) -> String {
    let first = |rest: &str| {
        let name = rest.split('/').next().unwrap_or(rest);
        name.trim_end_matches(".rs").to_owned()
    };
    if let Some((_, rest)) = path.split_once("shared/") {
        let (package, rest) = rest.split_once("/src/").unwrap_or((rest, rest));
        return format!("{package}: {}", first(rest));
    }
    if let Some((_, rest)) = path.split_once("firmware/src/") {
        return format!("firmware: {}", first(rest));
    }
    // ~/.cargo/registry/src/INDEX/NAME-VERSION/src/...
    if let Some((_, rest)) = path.split_once("/registry/src/") {
        let package = rest.split('/').nth(1).unwrap_or(rest);
        let end = package.find(|it: char| it.is_ascii_digit());
        return package[..end.unwrap_or(package.len())]
            .trim_end_matches('-')
            .to_owned();
    }
    match path.split_once("/library/") {
        Some((_, rest)) => format!("rust: {}", first(rest)),
        None => "other".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_belong_to_modules_and_packages() {
        for (path, name) in [
            ("/work/shared/core/src/detect/flight.rs", "core: detect"),
            ("/work/shared/core/src/monitor.rs", "core: monitor"),
            ("/firmware/src/board/f405/mod.rs", "firmware: board"),
            (
                "/home/.cargo/registry/src/index.crates.io-1949/postcard-1.1.3/src/de/mod.rs",
                "postcard",
            ),
            (
                "/usr/lib/rustlib/src/rust/library/core/src/slice/mod.rs",
                "rust: core",
            ),
            ("/rustc/abc/src/x.rs", "other"),
        ] {
            assert_eq!(module(path), name);
        }
    }

    #[test]
    fn most_of_the_built_image_has_a_module() {
        let image = crate::firmware::images().join("touchdown-firmware");
        let modules = modules(&image).expect("`cargo xtask firmware` builds it");
        let (flash, _) = crate::firmware::size(&image).expect("an image");
        let known: u64 = modules.iter().map(|it| it.bytes).sum();
        assert!(known <= flash, "{known} of {flash}");
        assert!(known > flash * 9 / 10, "{known} of {flash}");
        assert!(modules.iter().any(|it| it.module == "core: detect"));
    }
}
