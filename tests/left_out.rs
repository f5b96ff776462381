//! What a rigid planar scene does not need costs it nothing: the image that drops a rotor by the rigid rung alone takes
//! the same instructions and the same bytes whether the library holds the other rungs or not, and no image holds
//! code of a rung that it does not use.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};
use touchdown_sim::emulator::built;
use touchdown_tests::counting::count_by;

const RIGID: &str = "touchdown-count-rigid";
const EVERY: &str = "touchdown-count";
/// For silicon and for the emulator: a detector, no model of the drop.
const PRODUCTS: [&str; 2] = ["touchdown-firmware", "touchdown-qemu"];
/// Modules of the rungs beyond the rigid one.
const RUNGS: [&str; 4] = ["hertz", "moreau", "support", "two_plane"];

/// Bytes of each function of that name: one name may have several.
type Functions = BTreeMap<String, Vec<u64>>;

/// The same image from a library without [`RUNGS`]: `cargo xtask firmware` puts it there.
fn without_rungs(name: &str) -> PathBuf {
    let image = built(name);
    image.with_file_name("without-rungs").join(name)
}

fn functions(image: &Path) -> Functions {
    let bytes = fs::read(image).unwrap_or_else(|error| {
        panic!(
            "{}: {error}; `cargo xtask firmware` builds it",
            image.display()
        )
    });
    let file = object::File::parse(&*bytes).expect("an image");
    let mut functions = Functions::new();
    for symbol in file.symbols() {
        if symbol.kind() == SymbolKind::Text && symbol.size() > 0 {
            let name = name(symbol.name().expect("UTF-8"));
            functions.entry(name).or_default().push(symbol.size());
        }
    }
    functions.values_mut().for_each(|sizes| sizes.sort());
    functions
}

/// Without what differs from build to build: the crates' hashes, and the number of a part of the program.
fn name(symbol: &str) -> String {
    let name = format!("{:#}", rustc_demangle::demangle(symbol));
    let end = name.find(".llvm.").unwrap_or(name.len());
    name[..end].to_owned()
}

/// What the image takes, by section, bytes.
fn sections(image: &Path) -> BTreeMap<String, u64> {
    let bytes = fs::read(image).expect("an image");
    let file = object::File::parse(&*bytes).expect("an image");
    [".text", ".rodata", ".data", ".bss"]
        .map(|name| (name.to_owned(), file.section_by_name(name)))
        .into_iter()
        .map(|(name, section)| (name, section.expect("in every image").size()))
        .collect()
}

/// Names of functions that are not in both, or not of the same sizes.
fn differences<'a>(one: &'a Functions, other: &'a Functions) -> Vec<&'a str> {
    let missing = other.keys().filter(|name| !one.contains_key(*name));
    one.iter()
        .filter(|(name, sizes)| other.get(*name) != Some(sizes))
        .map(|(name, _)| name)
        .chain(missing)
        .map(String::as_str)
        .collect()
}

/// Functions of the model's module of that name, or made for its types.
fn of_rung<'a>(functions: &'a Functions, rung: &str) -> Vec<&'a str> {
    let path = format!("touchdown_core::model::{rung}::");
    let names = functions.keys().map(String::as_str);
    names.filter(|name| name.contains(&path)).collect()
}

#[test]
fn other_rungs_in_the_library_cost_the_rigid_one_nothing() {
    let (with, without) = (built(RIGID), without_rungs(RIGID));
    let (code, lean) = (functions(&with), functions(&without));
    assert_eq!(differences(&code, &lean), [""; 0]);
    let (full, mut bare) = (sections(&with), sections(&without));
    // The same strings are merged in another order, which moves what lies between them to its alignment.
    let constants = |it: &BTreeMap<String, u64>| it[".rodata"];
    assert!(
        constants(&full).abs_diff(constants(&bare)) < 8,
        "{full:?} {bare:?}"
    );
    bare.insert(".rodata".to_owned(), constants(&full));
    assert_eq!(full, bare);
    assert_eq!(
        count_by(&with),
        count_by(&without),
        "instructions of the drop"
    );

    let rigid = of_rung(&code, "rigid");
    assert!(!rigid.is_empty());
    let bytes: u64 = rigid.iter().flat_map(|name| &code[*name]).sum();
    println!(
        "{} functions of the rigid rung, {bytes} bytes in five kinds of number; the image: {:?}",
        rigid.len(),
        sections(&with)
    );
}

#[test]
fn images_hold_only_the_rungs_that_they_use() {
    let every = functions(&built(EVERY));
    for rung in RUNGS {
        assert!(
            !of_rung(&every, rung).is_empty(),
            "{rung} is not in {EVERY}"
        );
        for image in [RIGID, PRODUCTS[0], PRODUCTS[1]] {
            let code = functions(&built(image));
            assert!(
                code.keys().any(|name| name.contains("touchdown_")),
                "{image}"
            );
            assert_eq!(of_rung(&code, rung), [""; 0], "{rung} in {image}");
        }
    }
}

#[test]
fn planted_difference_is_found() {
    let lean = functions(&without_rungs(RIGID));
    let first = lean.keys().next().expect("a function").clone();

    let mut longer = lean.clone();
    longer.get_mut(&first).expect("a function")[0] += 2;
    assert_eq!(differences(&longer, &lean), [&first]);

    let mut fewer = lean.clone();
    fewer.remove(&first);
    assert_eq!(differences(&fewer, &lean), [&first]);
    assert_eq!(differences(&lean, &fewer), [&first]);

    let mut twice = lean.clone();
    twice.get_mut(&first).expect("a function").push(2);
    assert_eq!(differences(&twice, &lean), [&first]);
}
