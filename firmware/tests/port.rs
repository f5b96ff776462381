//! What a port touches: a folder of its own, its image, and a few lines that name it.

use std::fs;
use std::path::{Path, PathBuf};

/// Files that know the second board, from the workspace on.
const PORT: [&str; 14] = [
    "firmware/Cargo.toml",
    "firmware/build.rs",
    "firmware/src/bin/g474.rs",
    "firmware/src/board/g474/clocks.rs",
    "firmware/src/board/g474/converter.rs",
    "firmware/src/board/g474/inputs.rs",
    "firmware/src/board/g474/line.rs",
    "firmware/src/board/g474/memory.x",
    "firmware/src/board/g474/mod.rs",
    "firmware/src/board/g474/outputs.rs",
    "firmware/src/board/g474/spi.rs",
    "firmware/src/board/mod.rs",
    "firmware/tests/port.rs",
    "xtask/src/firmware.rs",
];

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.extension().and_then(|it| it.to_str()) {
            _ if path.is_dir() => files(&path, found),
            Some("rs" | "toml" | "x") => found.push(path),
            _ => {}
        }
    }
}

#[test]
fn a_port_touches_its_folder_its_image_and_the_lists_of_both() {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut all = vec![];
    for folder in ["firmware", "shared", "xtask"] {
        files(&workspace.join(folder), &mut all);
    }
    let names = |path: &&PathBuf| {
        let text = fs::read_to_string(path).unwrap().to_lowercase();
        text.contains("g474") || path.to_string_lossy().contains("g474")
    };
    let mut touched: Vec<_> = all
        .iter()
        .filter(names)
        .map(|it| it.strip_prefix(workspace).unwrap().display().to_string())
        .collect();
    touched.sort();
    assert_eq!(touched, PORT);
}

/// No file but those of a board names its chip's crate, so that what they share knows no registers.
#[test]
fn only_boards_and_images_name_the_crates_of_chips() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = vec![];
    files(&source, &mut all);
    for path in all {
        let text = fs::read_to_string(&path).unwrap();
        let inside = path.strip_prefix(&source).unwrap();
        let is_board = ["board/f405", "board/g474", "board/qemu", "bin"]
            .iter()
            .any(|it| inside.starts_with(it));
        let is_named = text.contains("stm32f4::") || text.contains("stm32g4::");
        assert!(is_board || !is_named, "{}", inside.display());
    }
}
