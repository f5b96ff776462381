//! Text to settings that are valid, and back; what two of them differ in.

use serde::Serialize;
use toml::de::DeTable;
use touchdown_core::guard::GuardConfig;
use touchdown_protocol::config_block::{Key, Settings};
use touchdown_rotor::error::ConfigError;

use super::table::Tables;
use touchdown_base::input_error::InputError;
use touchdown_scene::diagnostic::Diagnostic;
use touchdown_scene::file::read;
use touchdown_scene::limits::of_machine;
use touchdown_scene::rule::translate;

/// The settings of the file `text`, as valid as the controller wants them; errors name it `name`.
pub fn parse(name: &str, text: &str) -> Result<Settings, InputError> {
    let tables: Tables = read(name, text, of_machine)?;
    if let Some(rule) = cut_short(text) {
        let line = text.lines().count().max(1) as u64;
        return Err(InputError::at_line(name, line, rule));
    }
    let valid = |it: Settings| it.validate().map(|()| it).map_err(|why| key_of(&why));
    tables.settings().and_then(valid).map_err(|flaw| {
        let error = InputError::at_span(name, text, flaw.span(text), flaw.rule);
        match flaw.table {
            // A secret.
            "link" => error.of_named_file(),
            _ => error,
        }
    })
}

/// The rule that a file breaks which was cut short: `[guard]` comes last, with all its keys, and the last line ends.
fn cut_short(text: &str) -> Option<String> {
    let root = DeTable::parse(text).ok()?;
    let tables = root.get_ref().iter();
    let (name, table) = tables.max_by_key(|(name, _)| name.span().start)?;
    let keys = table.get_ref().as_table();
    let keys = keys.filter(|_| name.get_ref() == "guard");
    let all = toml::Table::try_from(GuardConfig::default()).unwrap_or_default();
    let why = match keys.map(|keys| all.keys().find(|it| !keys.contains_key(it.as_str()))) {
        None => "the last table must be [guard]".to_owned(),
        Some(Some(key)) => format!("missing required key `{key}` of [guard]"),
        Some(None) if text.ends_with('\n') => return None,
        Some(None) => "the last line has no end".to_owned(),
    };
    Some(format!("{why}: the file may be cut short"))
}

/// The file of `settings`. It does not tell a key.
pub fn text(settings: &Settings) -> String {
    // Tables of numbers, names and lists of them: all of that TOML has.
    let text = toml::to_string(&Tables::from(settings)).unwrap_or_default();
    let key = match settings.key {
        None => return text,
        Some(Key::HELD) => "set",
        Some(_) => "another",
    };
    text.replacen("[guard]", &format!("[link]\n# key = {key}\n\n[guard]"), 1)
}

/// The same with the machine's name on the record of its commissioning check.
pub fn record_text(settings: &Settings, machine: &str) -> String {
    let mut tables = Tables::from(settings);
    if let Some(it) = &mut tables.calibration {
        it.machine = Some(machine.to_owned());
    }
    toml::to_string(&tables).unwrap_or_default()
}

/// A rule in the words of the controller, in those of the file.
fn key_of(error: &ConfigError) -> Diagnostic {
    let parameter = error.parameter();
    let (table, key) = match parameter {
        "resolution" => ("sensors", "resolution_um"),
        "ring_z" => ("sensors", "ring_z_mm"),
        "zero_count" | "full_scale" | "pulses_per_turn" => ("sensors", parameter),
        "marks" => ("ball_bearing", "inner_ring_marks"),
        "bore_radius" => ("ball_bearing", "bore_radius_mm"),
        "edge_error" => ("ball_bearing", "edge_error_mrad"),
        "window" => ("ball_bearing", "window_ms"),
        // As in a scene.
        _ => return translate(error),
    };
    Diagnostic::new(table, key, error.to_string().replacen(parameter, key, 1))
}

/// A key that has another value.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// With its table, as `retainer.clearance_mm`.
    pub key: String,
    /// As it was written, where it was.
    pub from: Option<String>,
    /// As it is written, where it is.
    pub to: Option<String>,
}

/// What changes from `old` to `new`, in the words of the file.
pub fn differences(old: &Settings, new: &Settings) -> Vec<Difference> {
    let [old, new] = [old, new].map(|it| lines(&text(it)));
    let value = |lines: &[(String, String)], key: &str| {
        let line = lines.iter().find(|(it, _)| it == key);
        line.map(|(_, value)| value.clone())
    };
    let gone = old.iter().filter(|(key, _)| value(&new, key).is_none());
    let all = new.iter().chain(gone).map(|(key, _)| Difference {
        from: value(&old, key),
        to: value(&new, key),
        key: key.clone(),
    });
    all.filter(|it| it.from != it.to).collect()
}

/// Key and value of each line: none of ours goes over two.
fn lines(text: &str) -> Vec<(String, String)> {
    let mut table = "";
    let mut lines = Vec::new();
    for line in text.lines() {
        if let Some((key, value)) = line.split_once(" = ") {
            let key = key.trim_start_matches("# ");
            lines.push((format!("{table}.{key}"), value.to_owned()));
        } else {
            table = line.trim_matches(['[', ']']);
        }
    }
    lines
}
