//! The scenes that come with the program.

/// A built-in scene.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// What `drop` takes in place of a path.
    pub name: &'static str,
    /// The scene file.
    pub text: &'static str,
}

macro_rules! built_in {
    ($($name:literal),* $(,)?) => {
        &[$(BuiltIn {
            name: $name,
            text: include_str!(concat!("../../scenes/", $name, ".toml")),
        }),*]
    };
}

/// All of them; the first is the default.
pub const BUILT_IN: &[BuiltIn] = built_in![
    "rig",
    "rig-wide-gap",
    "backward-whirl",
    "rolling",
    "lift-off",
    "ball-bearing",
    "soft-support",
    "two-plane",
    "vertical",
    "eth-rig",
    "ufu-rig",
    "tum-mbtr",
    "mse-rig",
    "dtu",
    "york-ymc2",
    "expander",
    "vycon",
    "alps",
    "htr10-blower",
    "htr10gt-pcu",
    "tmp-mini",
];
