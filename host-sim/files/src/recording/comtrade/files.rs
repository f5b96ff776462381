//! The files of a COMTRADE recording: .cfg and .dat, or both in a .cff.

use std::io::{BufRead, Read};
use std::path::{Path, PathBuf};

use super::cfg::Cfg;
use super::dat::Dat;
use crate::recording::layout::text_of;
use crate::stream::Account;
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
pub fn open(path: &Path, account: &Account) -> Result<(Dat<Box<dyn Read>>, u64), InputError> {
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
pub fn combined(
    bytes: Box<dyn BufRead>,
    account: &Account,
) -> Result<Dat<Box<dyn Read>>, InputError> {
    let mut lines = Sections {
        account,
        bytes,
        line: 0,
    };
    let (mut cfg, mut at) = (None, 0);
    let mut section = lines.skip_to_section()?;
    loop {
        let Some(kind) = section else {
            let rule = "has no section \"--- file type: DAT ... ---\" after one of CFG";
            return Err(account.of_file(rule));
        };
        if kind == "CFG" {
            at = lines.line;
            let (text, next) = lines.text()?;
            cfg = Some(text);
            section = next;
        } else if let (true, Some(text)) = (kind.starts_with("DAT"), &cfg) {
            let cfg = Cfg::parse(text).map_err(|(line, rule)| account.at_line(at + line, rule))?;
            let told = kind["DAT".len()..].split(':').next().unwrap_or("").trim();
            if told.parse() != Ok(cfg.data) {
                let rule =
                    format!("the section's data are {told:?}, those of the configuration are not");
                return Err(account.at_line(lines.line, rule));
            }
            return Ok(Dat::new(cfg, lines.bytes, account.clone()));
        } else {
            section = lines.skip_to_section()?;
        }
    }
}

struct Sections<'a> {
    account: &'a Account,
    bytes: Box<dyn BufRead>,
    line: u64,
}

impl Sections<'_> {
    /// The next line, or as much of it as is believed; `None` at the end.
    fn next(&mut self) -> Result<Option<String>, InputError> {
        let mut line = Vec::new();
        let mut some = (&mut self.bytes).take(crate::stream::LONGEST);
        let read = some.read_until(b'\n', &mut line);
        let read = read.map_err(|error| self.account.of_file(reason(&error)))?;
        self.line += u64::from(line.ends_with(b"\n"));
        Ok((read > 0).then(|| text_of(&line)))
    }

    fn skip_to_section(&mut self) -> Result<Option<String>, InputError> {
        while let Some(line) = self.next()? {
            if let Some(kind) = section(&line) {
                return Ok(Some(kind));
            }
        }
        Ok(None)
    }

    /// The lines up to the next section, and its kind.
    fn text(&mut self) -> Result<(String, Option<String>), InputError> {
        let mut text = String::new();
        while let Some(line) = self.next()? {
            if let Some(kind) = section(&line) {
                return Ok((text, Some(kind)));
            }
            text += &line;
            if text.len() as u64 > LARGEST_CFG {
                let rule = "the configuration is larger than any";
                return Err(self.account.at_line(self.line, rule));
            }
        }
        Ok((text, None))
    }
}

/// The kind of the section that a line begins, in upper case: `CFG`, `DAT BINARY: 1234`.
fn section(line: &str) -> Option<String> {
    let inside = line.trim().strip_prefix("---")?.strip_suffix("---")?.trim();
    let (what, kind) = inside.split_once(':')?;
    let is = what.trim().eq_ignore_ascii_case("file type");
    is.then(|| kind.trim().to_ascii_uppercase())
}
