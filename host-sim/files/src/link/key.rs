//! The key of the right to order, as it is written: 32 hexadecimal digits.

use std::fs;
use std::path::Path;

use touchdown_base::input_error::InputError;
use touchdown_protocol::config_block::{KEY_BYTES, Key};

/// The key of `text`, or the rule that it breaks.
pub fn parse(text: &str) -> Result<Key, &'static str> {
    let mut bytes = [0; KEY_BYTES];
    match hex::decode_to_slice(text, &mut bytes) {
        Ok(()) if bytes != [0; KEY_BYTES] => Ok(Key(bytes)),
        _ => Err("the key must be 32 hexadecimal digits, not all of them 0"),
    }
}

/// The key in the file `name`, and a warning where others may read it.
pub fn load(name: &str) -> Result<(Key, Option<String>), InputError> {
    let path = Path::new(name);
    let text = InputError::read(path, 1_000)?;
    let key = parse(text.trim()).map_err(|rule| InputError::at_line(name, 1, rule))?;
    let warning = others_read(path).then(|| format!("{name}: others can read this key"));
    Ok((key, warning))
}

#[cfg(unix)]
fn others_read(path: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    fs::metadata(path).is_ok_and(|it| it.permissions().mode() & 0o077 != 0)
}

#[cfg(not(unix))]
fn others_read(_: &Path) -> bool {
    false
}
