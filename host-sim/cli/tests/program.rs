//! The program starts. That this test is here makes `cargo test` build the program, for `tests/binary.rs`.

use std::process::Command;

#[test]
fn tells_its_version() {
    let output = Command::new(env!("CARGO_BIN_EXE_touchdown"))
        .arg("--version")
        .output()
        .expect("the program starts");
    let text = String::from_utf8(output.stdout).expect("text");
    assert_eq!(
        text.trim(),
        concat!("touchdown ", env!("CARGO_PKG_VERSION"))
    );
}
