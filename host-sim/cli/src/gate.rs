//! What a command reads and what it writes, told before anything is computed, so that no output replaces an
//! input or another output.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use touchdown_base::failure::{Failure, STANDARD_OUTPUT, STDOUT};
use touchdown_base::interrupt::{self, Registered};
use touchdown_base::output::{self, Output};
use touchdown_base::paint::Paint;
use touchdown_base::plain::shown;
use touchdown_files::recording::is_pair;

/// The files of a command, by the options that name them.
#[derive(Debug, Default)]
pub struct Gate {
    inputs: Vec<Named>,
    outputs: Vec<Named>,
    /// Those of the outputs that are opened here.
    opened: Vec<(&'static str, String)>,
    folders: Vec<String>,
}

impl Gate {
    /// Without files.
    pub fn new() -> Self {
        Self::default()
    }

    /// Files that are read. The name of none, as of a built-in scene or a port, is of no matter.
    pub fn reads<F: AsRef<Path>>(
        mut self,
        option: &'static str,
        files: impl IntoIterator<Item = F>,
    ) -> Self {
        let there = files.into_iter().filter(|it| it.as_ref().exists());
        let named = there.filter_map(|it| Named::new(option, it.as_ref()));
        self.inputs.extend(named);
        self
    }

    /// A recording: with the other file of a COMTRADE pair.
    pub fn reads_recording(mut self, option: &'static str, file: &str) -> Self {
        let path = Path::new(file);
        if is_pair(path) {
            let endings = ["cfg", "CFG", "dat", "DAT"];
            self = self.reads(option, endings.map(|it| path.with_extension(it)));
        }
        self.reads(option, [path])
    }

    /// Files that are written with [`Outputs`]; `-` is standard output.
    pub fn writes<F: AsRef<str>>(
        mut self,
        option: &'static str,
        files: impl IntoIterator<Item = F>,
    ) -> Self {
        for file in files {
            let file = file.as_ref();
            self.opened.push((option, file.to_owned()));
            if file != STDOUT {
                self = self.claims(option, [file]);
            }
        }
        self
    }

    /// Files that are written by other means.
    pub fn claims<F: AsRef<Path>>(
        mut self,
        option: &'static str,
        files: impl IntoIterator<Item = F>,
    ) -> Self {
        let files = files.into_iter();
        self.outputs
            .extend(files.filter_map(|it| Named::new(option, it.as_ref())));
        self
    }

    /// A folder that is made where it is not there.
    pub fn makes_folder(mut self, folder: &str) -> Self {
        self.folders.push(folder.to_owned());
        self
    }

    /// Holds all files against each other, and opens the outputs.
    pub fn open(self) -> Result<Outputs, Failure> {
        self.check()?;
        let mut new = Vec::new();
        for folder in &self.folders {
            let is_new = !Path::new(folder).exists();
            let made = interrupt::make(|| {
                fs::create_dir_all(folder)?;
                let path = folder.clone();
                // Only if it is still empty.
                Ok(((), move || _ = fs::remove_dir(path)))
            });
            let ((), registered) = made.map_err(Failure::output(folder))?;
            new.extend(is_new.then_some(registered));
        }
        let open = |(option, file): &(_, String)| Ok((*option, Output::create(file)?));
        let files = self.opened.iter().map(open);
        Ok(Outputs {
            files: files.collect::<Result<_, Failure>>()?,
            _folders: new,
        })
    }

    fn check(&self) -> Result<(), Failure> {
        let mut standard = self.opened.iter().filter(|(_, file)| file == STDOUT);
        if let (Some((first, _)), Some((second, _))) = (standard.next(), standard.next()) {
            let rule = format!("two outputs go to {STANDARD_OUTPUT}: {first} and {second}");
            return Err(Failure::Usage(rule));
        }
        let redirected = Named::standard_output();
        let outputs: Vec<_> = self.outputs.iter().chain(&redirected).collect();
        for (index, output) in outputs.iter().enumerate() {
            let same = |other: &&Named| other.file == output.file;
            let clash = |[first, second]: [&Named; 2], rule: &str| {
                let (first, second) = (&first.shown, &second.shown);
                let rule = format!("{first} and {second} are the same file: {rule}");
                Err(Failure::Usage(rule))
            };
            if let Some(input) = self.inputs.iter().find(same) {
                return clash([output, input], "an output must not replace an input");
            }
            if let Some(other) = outputs[..index].iter().copied().find(same) {
                return clash([other, output], "each output needs a file of its own");
            }
        }
        Ok(())
    }
}

/// A file and who names it.
#[derive(Debug)]
struct Named {
    /// For an error: option and name.
    shown: String,
    file: Identity,
}

/// Which file it is, whatever it is called.
#[derive(Debug, PartialEq)]
enum Identity {
    /// By device and number.
    #[cfg(unix)]
    There(u64, u64),
    /// By its path without links: one that is not there.
    Path(PathBuf),
}

impl Named {
    /// Nothing for a device, which keeps nothing that could be replaced.
    fn new(option: &str, path: &Path) -> Option<Self> {
        let shown = format!("{option} {}", path.display());
        let file = match fs::metadata(path) {
            Ok(there) => Identity::of(path, &there)?,
            Err(_) => Identity::Path(output::target(path)),
        };
        Some(Self { shown, file })
    }

    /// Standard output where it goes to a file.
    #[cfg(unix)]
    fn standard_output() -> Option<Self> {
        use std::os::fd::AsFd;
        let file = fs::File::from(io::stdout().as_fd().try_clone_to_owned().ok()?);
        let there = file.metadata().ok().filter(fs::Metadata::is_file)?;
        Some(Self {
            shown: STANDARD_OUTPUT.to_owned(),
            file: Identity::of(Path::new(STDOUT), &there)?,
        })
    }

    #[cfg(not(unix))]
    fn standard_output() -> Option<Self> {
        None
    }
}

impl Identity {
    #[cfg(unix)]
    fn of(_: &Path, there: &fs::Metadata) -> Option<Self> {
        use std::os::unix::fs::{FileTypeExt, MetadataExt};
        let is_device = there.file_type().is_char_device();
        (!is_device).then(|| Self::There(there.dev(), there.ino()))
    }

    #[cfg(not(unix))]
    fn of(path: &Path, _: &fs::Metadata) -> Option<Self> {
        Some(Self::Path(output::target(path)))
    }
}

/// The outputs of a command, open. None has its name until [`Outputs::commit`].
pub struct Outputs {
    files: Vec<(&'static str, Output)>,
    _folders: Vec<Registered>,
}

impl Outputs {
    /// Writes a text, if the option is given.
    pub fn put(&mut self, option: &str, text: impl FnOnce() -> String) -> Result<(), Failure> {
        self.file(option).map_or(Ok(()), |out| out.put(&text()))
    }

    /// Writes JSON, if the option is given.
    pub fn json(
        &mut self,
        option: &str,
        text: impl FnOnce() -> serde_json::Result<String>,
    ) -> Result<(), Failure> {
        self.file(option).map_or(Ok(()), |out| {
            let text = text().map_err(io::Error::from);
            out.put(&text.map_err(Failure::output(out.name()))?)
        })
    }

    /// Further outputs, which take their names with the others.
    pub fn add(&mut self, option: &'static str, outputs: Vec<Output>) {
        let outputs = outputs.into_iter().map(|out| (option, out));
        self.files.extend(outputs);
    }

    /// Leaves the output of an option as it was.
    pub fn leave(&mut self, option: &str) {
        self.files.retain(|it| it.0 != option);
    }

    /// The output of an option, if that is given.
    pub fn file(&mut self, option: &str) -> Option<&mut Output> {
        let mut files = self.files.iter_mut();
        files.find(|it| it.0 == option).map(|(_, out)| out)
    }

    /// Gives the files their names, all or none; says `text`, and which.
    pub fn finish(self, text: impl FnOnce(Paint) -> String) -> Result<(), Failure> {
        let text = text(self.paint());
        self.finish_with(|files| text + files)
    }

    /// The same with a text of the lines that say which.
    pub fn finish_with(self, text: impl FnOnce(&str) -> String) -> Result<(), Failure> {
        let aside = self.is_taken();
        let files: Vec<_> = self.files.into_iter().map(|(_, out)| out).collect();
        let named = files.iter().map(Output::name).filter(|it| *it != STDOUT);
        let told: String = named.map(|it| format!("wrote {}\n", shown(it))).collect();
        output::commit(files)?;
        let text = text(&told);
        if aside {
            note(&text);
            return Ok(());
        }
        print(&text)
    }

    /// How text for people may be coloured.
    pub fn paint(&self) -> Paint {
        if self.is_taken() {
            Paint::on(&io::stderr())
        } else {
            Paint::on(&io::stdout())
        }
    }

    /// Whether a file has taken standard output.
    fn is_taken(&self) -> bool {
        self.files.iter().any(|(_, out)| out.name() == STDOUT)
    }
}

/// Text for people on standard output.
pub fn print(text: &str) -> Result<(), Failure> {
    Output::create(STDOUT)?.put(text)
}

/// What came of text on standard output. A reader that has gone away is no failure.
pub fn said(text: io::Result<()>) -> Result<(), Failure> {
    match text {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        text => text.map_err(Failure::output(STDOUT)),
    }
}

/// Text for people beside the result: on standard error, if somebody reads that.
pub fn note(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}
