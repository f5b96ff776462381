//! The files of a COMTRADE recording: .cfg and .dat, or both in a .cff.

use std::io::{BufRead, Read};
use std::path::{Path, PathBuf};

use super::cfg::Cfg;
use super::dat::Dat;
use crate::recording::layout::text_of;
use crate::stream::{Account, LONGEST};
use touchdown_base::input_error::{InputError, reason};

/// Larger than any configuration, bytes.
const LARGEST_CFG: u64 = 16 << 20;

/// Whether the name of `path` is that of a file of a COMTRADE recording in two.
pub fn is_pair(path: &Path) -> bool {
    ends(path, "cfg") || ends(path, "dat")
}

/// Whether it is that of a COMTRADE recording in one file.
pub fn is_combined(path: &Path) -> bool {
    ends(path, "cff")
}

fn ends(path: &Path, ending: &str) -> bool {
    path.extension()
        .is_some_and(|it| it.eq_ignore_ascii_case(ending))
}

/// Opens the recording that `path` is one of two files of; also the bytes of its data.
pub fn open(path: &Path, account: &Account) -> Result<(Dat, u64), InputError> {
    let cfg_path = beside(path, "cfg")?;
    let text = text_of(&InputError::read_bytes(&cfg_path, LARGEST_CFG)?);
    let name = cfg_path.display().to_string();
    let cfg = Cfg::parse(&text).map_err(|(line, rule)| InputError::at_line(&name, line, rule))?;
    let dat_path = beside(path, "dat")?;
    let (file, size) = InputError::open(&dat_path)?;
    let mut account = account.clone();
    account.file = dat_path.display().to_string();
    Ok((Dat::new(cfg, Box::new(file), account), size))
}

/// The file of this ending beside `path`, in whichever case it is written.
fn beside(path: &Path, ending: &str) -> Result<PathBuf, InputError> {
    if ends(path, ending) {
        return Ok(path.to_owned());
    }
    let endings = [ending.to_owned(), ending.to_ascii_uppercase()];
    let mut paths = endings.iter().map(|it| path.with_extension(it));
    paths.find(|it| it.exists()).ok_or_else(|| {
        let rule = "a COMTRADE recording has .cfg and .dat, or is a .cff";
        let rule = format!("there is no .{ending} beside it: {rule}");
        InputError::of_file(&path.display().to_string(), rule)
    })
}

/// A recording in one file: sections begin with lines as `--- file type: CFG ---`.
pub fn combined(mut bytes: Box<dyn BufRead>, account: &Account) -> Result<Dat, InputError> {
    // The line before the configuration, and its text as far as it goes.
    let mut cfg: Option<(u64, String)> = None;
    let (mut in_cfg, mut number) = (false, 0);
    loop {
        // As much of it as is believed.
        let mut line = Vec::new();
        let read = (&mut bytes).take(LONGEST).read_until(b'\n', &mut line);
        if read.map_err(|error| account.of_file(reason(&error)))? == 0 {
            let rule = "has no section \"--- file type: DAT ... ---\" after one of CFG";
            return Err(account.of_file(rule));
        }
        number += u64::from(line.ends_with(b"\n"));
        let line = text_of(&line);
        let Some(kind) = section(&line) else {
            if let Some((_, text)) = cfg.as_mut().filter(|_| in_cfg) {
                *text += &line;
                if text.len() as u64 > LARGEST_CFG {
                    return Err(account.at_line(number, "the configuration is larger than any"));
                }
            }
            continue;
        };
        in_cfg = kind == "CFG";
        if in_cfg {
            cfg = Some((number, String::new()));
        } else if let (Some(data), Some((at, text))) = (kind.strip_prefix("DAT"), &cfg) {
            let cfg = Cfg::parse(text).map_err(|(line, rule)| account.at_line(at + line, rule))?;
            let told = data.split(':').next().unwrap_or("").trim();
            if told.parse() != Ok(cfg.data) {
                let rule = "those of the configuration are not";
                let rule = format!("the section's data are {told:?}, {rule}");
                return Err(account.at_line(number, rule));
            }
            return Ok(Dat::new(cfg, bytes, account.clone()));
        }
    }
}

/// The kind of the section that a line begins, in upper case: `CFG`, `DAT BINARY: 1234`.
fn section(line: &str) -> Option<String> {
    let inside = line.trim().strip_prefix("---")?.strip_suffix("---")?.trim();
    let (what, kind) = inside.split_once(':')?;
    let is = what.trim().eq_ignore_ascii_case("file type");
    is.then(|| kind.trim().to_ascii_uppercase())
}
