//! Text to settings that are valid, and back.

use touchdown_protocol::config_block::Settings;
use touchdown_rotor::error::ConfigError;

use super::table::Tables;
use touchdown_base::input_error::InputError;
use touchdown_scene::diagnostic::Diagnostic;
use touchdown_scene::file::read;
use touchdown_scene::rule::translate;

/// The settings of the file `text`, as valid as the controller wants them; errors name it `name`.
pub fn parse(name: &str, text: &str) -> Result<Settings, InputError> {
    let tables: Tables = read(name, text)?;
    let checked = tables.settings().and_then(|settings| {
        let valid = settings.validate();
        valid.map_err(|it| key_of(&it)).map(|()| settings)
    });
    checked.map_err(|flaw| InputError::at_span(name, text, flaw.span(text), flaw.rule))
}

/// The file of `settings`.
pub fn text(settings: &Settings) -> String {
    // Tables of numbers, names and lists of them: all of that TOML has.
    toml::to_string(&Tables::from(settings)).unwrap_or_default()
}

/// The same with the machine's name on the record of its commissioning check.
pub fn record_text(settings: &Settings, machine: String) -> String {
    let mut tables = Tables::from(settings);
    if let Some(it) = &mut tables.calibration {
        it.machine = Some(machine);
    }
    toml::to_string(&tables).unwrap_or_default()
}

/// A rule in the words of the controller, in those of the file.
fn key_of(error: &ConfigError) -> Diagnostic {
    let parameter = error.parameter();
    let (table, key) = match parameter {
        "resolution" => ("sensors", "resolution_um"),
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
