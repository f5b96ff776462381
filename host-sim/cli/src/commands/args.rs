//! Options and arguments.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use serde::Serialize;
use touchdown_core::detect::Tuning;

use touchdown_base::failure::Failure;
use touchdown_files::recording::{Mapping, Reading};
use touchdown_files::stream::is_rate;
use touchdown_lab::paper::DROPS;
use touchdown_lab::score::{GROUPS, Plan};
use touchdown_run::emulator::Emulator;
use touchdown_run::target::Target;
use touchdown_scene::calibration::day;
use touchdown_scene::limits::CLEARANCE_MM;
use touchdown_sweep::Part;

/// What `--help` adds to a command: examples, and what its status means. A test runs them.
macro_rules! help {
    ($name:literal) => {
        include_str!(concat!("help/", $name, ".txt")).trim_ascii_end()
    };
}

/// Monitor for rotors on active magnetic bearings: simulates a drop onto the retainer bearing and
/// runs the detector over it.
///
/// Without a command: drops the rig of the source paper, writes touchdown-report.html to the
/// current folder and prints the timeline.
#[derive(Debug, Parser)]
#[command(name = "touchdown", version, after_help = help!("examples"))]
pub struct Cli {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Drop a rotor: simulate, sense, detect
    #[command(after_help = help!("drop"))]
    Drop(DropArgs),
    /// Run the detector over a recording: CSV of any style, or COMTRADE
    #[command(after_help = help!("replay"))]
    Replay(ReplayArgs),
    /// Compare two recordings: events, speeds, regime, waveforms
    #[command(after_help = help!("compare"))]
    Compare(CompareArgs),
    /// Measure accuracy against cost: every rung, scheme, precision, math and step
    #[command(after_help = help!("trade"))]
    Trade(TradeArgs),
    /// Check every number of the source paper: as printed, as right, as ours
    #[command(after_help = help!("paper"))]
    Paper(PaperArgs),
    /// Drop a rotor thousands of times over parameters: how probable whirl is, when, and how hard
    #[command(after_help = help!("sweep"))]
    Sweep(SweepArgs),
    /// Run the firmware's image over a machine that falls when told, with its link on a socket
    #[cfg(unix)]
    #[command(after_help = help!("rig"))]
    Rig(RigArgs),
    /// List, show, export or verify the drops that the firmware recorded; keep or erase them
    #[command(subcommand, after_help = help!("log"))]
    Log(LogCommand),
    /// Watch a controller over its serial link
    #[command(after_help = help!("live"))]
    Live(LiveArgs),
    /// Show a controller's configuration, or set another one over its serial link
    #[command(after_help = help!("config"))]
    Config(ConfigArgs),
    /// Clear what is latched in a controller, over its serial link
    #[command(after_help = help!("clear"))]
    Clear(OrderArgs),
    /// Find zero, gain and skew of the sensors from a rotor that was led round the retainer
    #[command(after_help = help!("calibrate"))]
    Calibrate(CalibrateArgs),
    /// Recover the contact force from accelerations, with a device calibrated by known hits
    #[command(after_help = help!("force"))]
    Force(ForceArgs),
    /// Run the model at its extremes: what was measured, the limit, and whether it holds
    #[command(long_about = help!("limits_long"), after_help = help!("limits"))]
    Limits(LimitsArgs),
    /// Measure the detector over seeded campaigns: latency against the bound, misses, false events
    #[command(long_about = help!("score_long"), after_help = help!("score"))]
    Score(ScoreArgs),
    /// Look at scenes
    #[command(subcommand, after_help = help!("scene"))]
    Scene(SceneCommand),
    /// Print a script that completes commands and options in a shell
    #[command(after_help = help!("completions"))]
    Completions {
        /// Which shell
        shell: Shell,
    },
}

#[derive(Args, Clone, Debug, Default)]
pub(super) struct DropArgs {
    /// Scene file, or name of a built-in scene (`touchdown scene list`)
    #[arg(default_value = "rig")]
    pub scene: String,
    /// Impacts, phases, regime and detected events as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
    /// Report as one HTML page
    #[arg(long, value_name = "FILE")]
    pub report: Option<String>,
    /// What the sensors read, as CSV that `replay` takes
    #[arg(long, value_name = "FILE")]
    pub stream: Option<String>,
    /// Move the rotor by the independent reference, and hold the model against it
    #[arg(long)]
    pub truth: bool,
    /// The default: the model moves the rotor
    #[arg(long, conflicts_with = "truth", hide = true)]
    pub no_truth: bool,
    #[command(flatten)]
    pub place: Place,
}

#[cfg(unix)]
#[derive(Args, Clone, Debug)]
pub(super) struct RigArgs {
    /// Scene file, or name of a built-in scene: the machine and its drop
    #[arg(default_value = "rig")]
    pub scene: String,
    /// Port of the link's socket; any that is free for 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub port: u16,
    /// Folder where the drop log's flash, `log`, and the stored configuration, `settings`, stay
    #[arg(long, value_name = "FOLDER")]
    pub keep: Option<String>,
    /// Part of the link's bytes that are flipped, lost or invented
    #[arg(long, value_name = "PART", default_value_t = 0.0,
          value_parser = |it: &str| number(it, |it| (0.0..=1.0).contains(&it), "a number from 0 to 1"))]
    pub noise: f64,
    /// As fast as the emulator can, not at the pace of the samples
    #[arg(long)]
    pub fast: bool,
    /// Firmware image, in place of the one that `cargo xtask firmware` builds
    #[arg(long, value_name = "FILE")]
    pub image: Option<PathBuf>,
}

#[derive(Args, Clone, Debug)]
pub(super) struct ReplayArgs {
    /// Recording: a stream, that is CSV with the header
    /// time_s,ax_um,ay_um[,bx_um,by_um][,speed_rpm][,levitated], one row a sample, constant rate; for a
    /// ball bearing also [,inner_ring_edges,inner_ring_edge_age_us][,cage_edges,cage_edge_age_us]. With
    /// --columns any other text. Or COMTRADE: .cfg with .dat, or .cff
    #[arg(value_name = "FILE")]
    pub stream: String,
    /// Scene with the rotor, retainer, gravity, sensors and detector
    #[arg(long)]
    pub scene: String,
    /// Detected events as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
    /// Report as one HTML page
    #[arg(long, value_name = "FILE")]
    pub report: Option<String>,
    /// Switch the controller on with the first sample: nothing is proven. Without it a lift was seen before
    #[arg(long)]
    pub power_on: bool,
    /// Order the controller to clear what is latched at this time of the recording, s; may be given again
    #[arg(long, value_name = "T", value_parser = |it: &str| number(it, f64::is_finite, "a time in s"), allow_negative_numbers = true)]
    pub clear_at: Vec<f64>,
    #[command(flatten)]
    pub reading: ReadingArgs,
    #[command(flatten)]
    pub place: Place,
}

/// How a recording is read.
#[derive(Args, Clone, Debug)]
pub(super) struct ReadingArgs {
    /// Which column is what, and in which unit: a TOML file
    #[arg(long, value_name = "FILE.toml")]
    pub columns: Option<PathBuf>,
    /// Make samples of another rate of it, Hz: linear between neighbours, none across gaps
    #[arg(long, value_name = "RATE", value_parser = |it: &str| number(it, is_rate, "100 to 200000 Hz"))]
    resample: Option<f64>,
}

impl ReadingArgs {
    /// With the mapping read.
    pub fn load(&self) -> Result<Reading, Failure> {
        let mapping = self.columns.as_deref().map(Mapping::load);
        Ok(Reading {
            mapping: mapping.transpose()?,
            resample: self.resample,
        })
    }
}

#[derive(Args, Clone, Debug)]
pub(super) struct CompareArgs {
    /// A recording, as for `replay`
    #[arg(value_name = "A")]
    pub first: String,
    /// The recording to hold against it
    #[arg(value_name = "B")]
    pub second: String,
    /// Scene with the rotor, retainer, gravity, sensors and detector
    #[arg(long)]
    pub scene: String,
    /// Most that an onset may differ, ms
    #[arg(long, value_name = "MS", default_value_t = 1.0, value_parser = tolerance)]
    pub within_ms: f64,
    /// Most that the speed of an impact may differ, % of the faster
    #[arg(long, value_name = "PERCENT", default_value_t = 10.0, value_parser = tolerance)]
    pub within_percent: f64,
    /// Events side by side as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
    /// Both as one HTML page
    #[arg(long, value_name = "FILE")]
    pub report: Option<String>,
    #[command(flatten)]
    pub reading: ReadingArgs,
    /// The same as --columns for B, where it is not written like A
    #[arg(long, value_name = "FILE.toml")]
    pub columns_b: Option<PathBuf>,
}

/// Reads a number that `is_right`; `rule` says what that is.
fn number(text: &str, is_right: impl Fn(f64) -> bool, rule: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|it| is_right(*it));
    number.ok_or_else(|| rule.to_owned())
}

fn tolerance(text: &str) -> Result<f64, String> {
    let is_right = |it: f64| it.is_finite() && it >= 0.0;
    number(text, is_right, "a number, 0 or more")
}

#[derive(Args, Clone, Debug)]
pub(super) struct TradeArgs {
    /// Scene file, or name of a built-in scene (`touchdown scene list`)
    #[arg(default_value = "rig")]
    pub scene: String,
    /// The whole table as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
    /// Table and drawing as one HTML page
    #[arg(long, value_name = "FILE", default_value = "touchdown-trade.html")]
    pub report: String,
    /// The drawing alone
    #[arg(long, value_name = "FILE", default_value = "touchdown-trade.svg")]
    pub svg: String,
    /// Drops of the machine, and of that without each of its parts; 0 for none [default: 16 to 200, by what a drop takes]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=100_000))]
    pub drops: Option<u32>,
}

#[derive(Args, Clone, Debug)]
pub(super) struct PaperArgs {
    /// All rows with their notes, and the counts of the random drops, as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
    /// Numbers and figures as one HTML page
    #[arg(long, value_name = "FILE", default_value = "touchdown-paper.html")]
    pub report: String,
    /// Random drops of each gap, friction and restitution
    #[arg(long, value_name = "N", default_value_t = DROPS,
          value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub drops: u32,
}

#[derive(Args, Clone, Debug)]
pub(super) struct LimitsArgs {
    /// Random machines of fidelity `coupled`, in equal numbers of each combination of parts
    #[arg(long, value_name = "N", default_value_t = 64,
          value_parser = clap::value_parser!(u64).range(..=10_000_000))]
    pub machines: u64,
    /// Print the scene file of one of them, and run nothing
    #[arg(long, value_name = "NUMBER", conflicts_with_all = ["machines", "json"])]
    pub machine: Option<u64>,
    /// Instead: drop that many of them for 1 s each, and tell the slowest by processor time
    #[arg(long, value_name = "N", conflicts_with_all = ["machines", "machine"],
          value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    pub drops: Option<u64>,
    /// Each row as JSON: extreme, precision, measured, limit, unit, holds; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
}

#[derive(Args, Clone, Debug)]
pub(super) struct ScoreArgs {
    /// Drops of each case
    #[arg(long, value_name = "N", default_value_t = 100,
          value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    seeds: u64,
    /// Seed of the first drop; the others count up
    #[arg(long, value_name = "S", default_value_t = 1)]
    first_seed: u64,
    /// Only these groups, by name, with commas between
    #[arg(long, value_name = "GROUP", value_delimiter = ',',
          value_parser = PossibleValuesParser::new(GROUPS.iter().map(|group| group.name)))]
    only: Vec<String>,
    /// Levitation of each case, s
    #[arg(long, default_value_t = 60.0, conflicts_with = "hours")]
    seconds: f64,
    /// The same in hours, for the long run
    #[arg(long)]
    hours: Option<f64>,
    /// A look in seconds: 2 drops and 2 s of each case
    #[arg(long, conflicts_with_all = ["seeds", "seconds", "hours"])]
    pub quick: bool,
    /// Each row with its case, values, target and verdict, by group, as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
    /// Rows and pictures as one HTML page
    #[arg(long, value_name = "FILE")]
    pub report: Option<String>,
    #[command(flatten)]
    pub place: Place,
}

impl ScoreArgs {
    /// What is asked for.
    pub fn plan(&self) -> Result<Plan, Failure> {
        let seconds = self.hours.map_or(self.seconds, |hours| 3600.0 * hours);
        if !(1.0..=1e7).contains(&seconds) {
            let rule = format!("levitation of 1 to 10 000 000 s a case, not {seconds}");
            return Err(Failure::Usage(rule));
        }
        let wanted = |name: &str| self.only.is_empty() || self.only.iter().any(|it| it == name);
        let names = GROUPS.iter().map(|group| group.name);
        let quick = self.quick.then_some((2, 2.0));
        let (seeds, seconds) = quick.unwrap_or((self.seeds, seconds));
        Ok(Plan {
            groups: names.filter(|name| wanted(name)).collect(),
            seeds,
            first_seed: self.first_seed,
            seconds,
            tuning: Tuning::default(),
        })
    }
}

#[derive(Args, Clone, Debug)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct SweepArgs {
    #[command(subcommand)]
    pub command: Option<SweepCommand>,
    /// The plan: a scene, and which of its keys take which values
    #[arg(value_name = "PLAN", required = true)]
    pub plan: Option<String>,
    /// Folder for parts and results; by default the plan's name with -sweep
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<String>,
    /// Run part K of N, as a job of an array; the parts may share a folder
    #[arg(long, value_name = "K/N", value_parser = part)]
    pub shard: Option<Part>,
    /// Points with probabilities and intervals as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
}

#[derive(Clone, Debug, Subcommand)]
pub(super) enum SweepCommand {
    /// Put the parts of a sweep together; the result is that of one run, to the byte
    #[command(after_help = help!("merge"))]
    Merge {
        /// Folders with parts; the first takes the results
        #[arg(value_name = "FOLDER", required = true)]
        folders: Vec<String>,
        /// Points with probabilities and intervals as JSON; `-` is standard output
        #[arg(long, value_name = "FILE")]
        json: Option<String>,
    },
}

#[derive(Args, Clone, Debug)]
pub(super) struct LiveArgs {
    /// Serial device, tcp:HOST:PORT or unix:PATH
    pub port: String,
    /// All that is heard as lines of JSON, added to the end of FILE; `-`, or no FILE, is standard
    /// output, in place of the view
    #[arg(long, visible_alias = "record", value_name = "FILE", num_args = 0..=1,
          default_missing_value = "-")]
    pub json: Option<String>,
    /// Stop after this time, s
    #[arg(long, value_name = "S")]
    pub seconds: Option<f64>,
}

#[derive(Args, Clone, Debug)]
pub(super) struct ConfigArgs {
    /// Serial device, tcp:HOST:PORT or unix:PATH
    pub port: String,
    /// Set this configuration: a file as this command prints it. The controller restarts with it
    #[arg(long, value_name = "FILE.toml")]
    pub set: Option<String>,
    /// File with the key that the controller has
    #[arg(long, value_name = "FILE", requires = "set")]
    pub key_file: Option<String>,
    /// The configuration in force, and what changed, as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
}

#[derive(Args, Clone, Debug)]
pub(super) struct OrderArgs {
    /// Serial device, tcp:HOST:PORT or unix:PATH
    pub port: String,
    /// File with the key that the controller has
    #[arg(long, value_name = "FILE")]
    pub key_file: Option<String>,
    /// What came of it as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
}

#[derive(Args, Clone, Debug)]
pub(super) struct EpisodeArgs {
    #[command(flatten)]
    pub order: OrderArgs,
    /// Its number
    pub episode: u32,
}

#[derive(Args, Clone, Debug)]
#[command(group = clap::ArgGroup::new("told").required(true).args(["scene", "config"]))]
pub(super) struct CalibrateArgs {
    /// A recording, as for `replay`, of a rotor that was led round the wall
    pub recording: String,
    /// Scene with the retainer and the sensors
    #[arg(long)]
    pub scene: Option<String>,
    /// Or the controller's configuration, as `config` prints it
    #[arg(long, value_name = "FILE.toml")]
    pub config: Option<String>,
    /// Radial clearance, mm, as it was measured, in place of the one told
    #[arg(long, value_name = "MM", value_parser = clearance)]
    pub clearance: Option<f64>,
    /// What is believed: the clearance, or the gain of each plane's first axis
    #[arg(long, value_enum, default_value_t)]
    pub scale: Scale,
    /// Day of the check; today (UTC) without
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = |it: &str| day(it).ok_or("a day as 2026-12-31"))]
    pub date: Option<u32>,
    /// What was found as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
    /// Readings, curves and residuals as one HTML page
    #[arg(long, value_name = "FILE")]
    pub report: Option<String>,
    /// The configuration with the record of this check, for `config --set`; not if it is refused
    #[arg(long, value_name = "FILE.toml")]
    pub write: Option<String>,
    #[command(flatten)]
    pub reading: ReadingArgs,
}

/// What an ellipse leaves open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(super) enum Scale {
    /// The clearance is right, all gains are measured
    #[default]
    Clearance,
    /// The first axis is right, the clearance is measured
    Sensor,
}

/// A clearance, mm.
fn clearance(text: &str) -> Result<f64, String> {
    let (least, most) = CLEARANCE_MM.into_inner();
    let rule = format!("{least} to {most} mm");
    number(text, |it| CLEARANCE_MM.contains(&it), &rule)
}

#[derive(Args, Clone, Debug)]
pub(super) struct DumpArgs {
    /// A dump of the log's flash, a file of one episode, or a controller's port
    pub file: String,
    /// The same as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
}

#[derive(Clone, Debug, Subcommand)]
pub(super) enum LogCommand {
    /// Each episode with its state, trigger and severity, and the lifetime counters
    #[command(after_help = help!("log_list"))]
    List(DumpArgs),
    /// One episode with its events
    #[command(after_help = help!("log_show"))]
    Show {
        #[command(flatten)]
        dump: DumpArgs,
        /// Its number; the newest without
        number: Option<u32>,
    },
    /// One episode as a stream that `replay` reads, as COMTRADE or as JSON
    #[command(after_help = help!("log_export"))]
    Export {
        /// A dump of the log's flash, a file of one episode, or a controller's port
        file: String,
        /// Its number; the newest without
        number: Option<u32>,
        /// What to write
        #[arg(long, value_enum, default_value_t)]
        format: ExportFormat,
        /// Where to; `-` is standard output. COMTRADE takes the name with .cfg and .dat
        #[arg(long, value_name = "FILE")]
        out: String,
    },
    /// List, and fail where an episode is damaged; one that was cut off is not
    #[command(after_help = help!("log_verify"))]
    Verify(DumpArgs),
    /// Keep an episode of a controller: it is neither overwritten nor erased
    #[command(after_help = help!("log_order"))]
    Lock(EpisodeArgs),
    /// Give an episode of a controller free to be overwritten
    #[command(after_help = help!("log_order"))]
    Unlock(EpisodeArgs),
    /// Erase an episode of a controller
    #[command(after_help = help!("log_order"))]
    Erase(EpisodeArgs),
}

/// What `log export` writes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum ExportFormat {
    /// A stream: time from the trigger, displacements
    #[default]
    Csv,
    /// IEEE C37.111-1999, ASCII data
    Comtrade,
    /// Header, events, severity, ending
    Json,
}

/// `K/N`.
fn part(text: &str) -> Result<Part, String> {
    let read = |(part, parts): (&str, &str)| Some((part.parse().ok()?, parts.parse().ok()?));
    match text.split_once('/').and_then(read) {
        Some((part @ 1.., parts @ ..=Part::MOST)) if part <= parts => Ok(Part { part, parts }),
        _ => Err(format!("K/N with 1 <= K <= N <= {}, as in 2/8", Part::MOST)),
    }
}

#[derive(Args, Clone, Debug)]
pub(super) struct ForceArgs {
    /// Recorded accelerations: CSV with the header time_s,ax_m_s2[,ay_m_s2]
    #[arg(required_unless_present = "example")]
    pub recording: Option<String>,
    /// Known hits: CSV with the header [hit,]time_s,force_n,ax_m_s2 (or ay_m_s2); once or twice
    #[arg(long, value_name = "FILE", required_unless_present = "example")]
    pub calibration: Vec<String>,
    /// Pulses, band and rate as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<String>,
    /// Force, contacts and device as one HTML page
    #[arg(long, value_name = "FILE")]
    pub report: Option<String>,
    /// Write calibration.csv, recording.csv and truth.json to a folder: simulated, to try this on
    #[arg(long, value_name = "FOLDER", exclusive = true)]
    pub example: Option<String>,
}

#[derive(Debug, Subcommand)]
pub(super) enum SceneCommand {
    /// Say what a scene models, what it leaves out, and the numbers that decide how it goes
    #[command(after_help = help!("explain"))]
    Explain {
        /// Scene file, or name of a built-in scene
        scene: String,
        /// The same as JSON, section by section; `-` is standard output
        #[arg(long, value_name = "FILE")]
        json: Option<String>,
        /// Say what each part is worth too, by so many drops with it and without it
        #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=100_000))]
        drops: u32,
    },
    /// List the built-in scenes
    #[command(after_help = help!("scenes"))]
    List {
        /// The same as JSON; `-` is standard output
        #[arg(long, value_name = "FILE")]
        json: Option<String>,
    },
}

#[derive(Args, Clone, Debug, Default)]
pub(super) struct Place {
    /// Where the detector runs
    #[arg(long, value_enum, default_value_t)]
    on: On,
    /// Firmware image for `--on qemu`, in place of the one that `cargo xtask firmware` builds
    #[arg(long, value_name = "FILE")]
    image: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum On {
    /// In this process
    #[default]
    Host,
    /// The firmware image, in the emulator
    Qemu,
}

impl Place {
    pub fn target(&self) -> Result<Target, Failure> {
        match (self.on, &self.image) {
            (On::Host, None) => Ok(Target::Host),
            (On::Host, Some(_)) => Err(Failure::Usage("--image needs --on qemu".to_owned())),
            (On::Qemu, image) => Ok(Target::Qemu(Emulator::find(image.as_deref())?)),
        }
    }
}
