//! Each fault of docs/build/firmware.md brings the outputs to safety within the ticks stated there.

mod common;

use common::chip::{Chip, NoDelay, flash};
use common::desk::Desk;
use touchdown_core::config::Tuning;
use touchdown_core::event::{EventKind, Notice, Notices};
use touchdown_core::fault::{Condition, FaultKind};
use touchdown_core::monitor::{Monitor, MonitorConfig};
use touchdown_core::oversampling::ConverterConfig;
use touchdown_core::sample::{CHANNELS, Sample, TACHOMETERS};
use touchdown_firmware::app::App;
use touchdown_firmware::board::{
    Abilities, Board, CONVERSION_RATE_HZ, SAMPLE_RATE_HZ, default_config, default_settings,
};
use touchdown_firmware::cost;
use touchdown_firmware::drop_log::DropLog;
use touchdown_firmware::memory;
use touchdown_firmware::memory_scrub::MemoryScrub;
use touchdown_firmware::recorder::Counted;
use touchdown_firmware::w25q::W25q;
use touchdown_protocol::config_block;
use touchdown_protocol::config_block::{Block, ConfigScrub};
use touchdown_protocol::controller::{Busy, Cause, Fault, Faults, Mode, Shown};

/// Ticks from power-on until watching: self-test and `arming_time`, and what rounding adds.
const ARMED: u32 = 3_000;
/// 1 ms.
const BLIND: u32 = SAMPLE_RATE_HZ / 1_000;
const WATCHING: u8 = 0b1011;
const GRAVITY: f64 = 9.81;
const CLEARANCE: f64 = 0.3e-3;

/// A board that remembers, and a rotor on it.
struct Bench {
    app: App,
    board: Memory,
    noise: u32,
    tick: u32,
}

struct Memory {
    block: Block,
    notices: Vec<Notice>,
    /// What was called in the present tick.
    driven: Vec<Shown>,
    fed: u32,
}

impl Board for Memory {
    fn report(&mut self, notice: &Notice) {
        self.notices.push(*notice);
    }

    fn drive(&mut self, shown: Shown) {
        assert_eq!(self.fed, 0, "fed before the end of the tick");
        self.driven.push(shown);
    }

    fn config(&self) -> &[u8] {
        &self.block
    }

    fn feed(&mut self) {
        self.fed += 1;
    }
}

impl Bench {
    fn new(found: Faults) -> Self {
        Self::configured(&default_config(), found)
    }

    fn configured(config: &MonitorConfig, found: Faults) -> Self {
        Self {
            app: App::try_new(config, found).expect("a valid configuration"),
            board: Memory {
                block: config_block::encode(&default_settings()),
                notices: vec![],
                driven: vec![],
                fed: 0,
            },
            noise: 1,
            tick: 0,
        }
    }

    /// Watching, the rotor at the centre.
    fn watching() -> Self {
        Self::new(Faults::NONE).watches()
    }

    fn watches(self) -> Self {
        let mut bench = self;
        bench.app.assume_lift();
        for _ in 0..ARMED {
            bench.float();
        }
        assert_eq!(bench.outputs(), WATCHING);
        bench
    }

    /// Lies for a second, is cleared and lifted in 0.1 s; then watching within half a second.
    fn lie_clear_and_lift(&mut self) {
        for _ in 0..SAMPLE_RATE_HZ {
            assert_eq!(self.place([0.0, -CLEARANCE]) & 0b0001, 0);
        }
        assert_eq!(self.app.clear(), Ok(()));
        let lift = SAMPLE_RATE_HZ / 10;
        for tick in 0..lift {
            let part = f64::from(tick) / f64::from(lift);
            let smooth = part * part * (3.0 - 2.0 * part);
            let outputs = self.place([0.0, CLEARANCE * (smooth - 1.0)]);
            assert_eq!(outputs & 0b0001, 0, "runs while it is lifted");
        }
        ticks_until(SAMPLE_RATE_HZ / 2, || self.float() == WATCHING);
    }

    fn cause(&self) -> Option<Cause> {
        self.app.shown().cause
    }

    fn take(&mut self, sample: &Sample, lost: u32) -> u8 {
        self.board.driven.clear();
        self.board.fed = 0;
        self.app
            .take(&mut self.board, sample, false, lost, &mut Notices::new());
        self.tick += 1;
        assert_eq!(self.board.driven, [self.app.shown()], "driven once a tick");
        assert_eq!(self.board.fed, 1, "fed once a tick");
        self.outputs()
    }

    /// A sample of a rotor at `position` (m), with noise of 1 um.
    fn at(&mut self, position: [f64; 2]) -> Sample {
        let counts = [0, 1, 0, 1].map(|axis| {
            let noise: f64 = (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0;
            let place = position[axis] + 1e-6 * noise;
            (4_096.0 + place * 8_192.0 / 2_000e-6).round() as u16
        });
        Sample {
            counts,
            ..sighted([0; CHANNELS])
        }
    }

    fn uniform(&mut self) -> f64 {
        self.noise = self
            .noise
            .wrapping_mul(1_664_525)
            .wrapping_add(1_013_904_223);
        f64::from(self.noise) / 4_294_967_296.0
    }

    fn float(&mut self) -> u8 {
        let sample = self.at([0.0; 2]);
        self.take(&sample, 0)
    }

    fn place(&mut self, position: [f64; 2]) -> u8 {
        let sample = self.at(position);
        self.take(&sample, 0)
    }

    fn blind(&mut self) -> u8 {
        let sample = Sample {
            valid: 0,
            ..sighted([0; CHANNELS])
        };
        self.take(&sample, 0)
    }

    fn outputs(&self) -> u8 {
        self.app.shown().outputs.bits()
    }

    fn mode(&self) -> Mode {
        self.app.shown().mode
    }

    fn has(&self, fault: Fault) -> bool {
        self.app.faults().contains(fault)
    }

    fn told(&self, kind: EventKind) -> bool {
        let is_it = |it: &Notice| matches!(it, Notice::Declared(event) if event.kind == kind);
        self.board.notices.iter().any(is_it)
    }
}

fn sighted(counts: [u16; CHANNELS]) -> Sample {
    Sample {
        counts,
        valid: 0b1111,
        spin: None,
        levitated: None,
        edges: [None; TACHOMETERS],
    }
}

fn seconds(ticks: u32) -> f64 {
    f64::from(ticks) / f64::from(SAMPLE_RATE_HZ)
}

/// Ticks until `act` leaves the outputs as they should be; none beyond `limit`.
fn ticks_until(limit: u32, mut act: impl FnMut() -> bool) -> u32 {
    (1..=limit)
        .find(|_| act())
        .unwrap_or_else(|| panic!("not within {limit} ticks"))
}

#[test]
fn nothing_has_current_before_the_self_test_is_over() {
    let mut bench = Bench::new(Faults::NONE);
    assert_eq!(bench.outputs(), 0);
    let tested = ticks_until(ARMED, || bench.float() != 0);
    // One whole pass over the configuration; the sensors take 20 ticks.
    let pass = config_block::encode(&default_settings()).len() - 4;
    assert_eq!(tested as usize, pass.div_ceil(config_block::SLICE_BYTES));
    assert_eq!((bench.mode(), bench.outputs()), (Mode::Arming, 0b0010));
    bench.app.assume_lift();
    let armed = ticks_until(ARMED, || bench.float() == WATCHING);
    println!("self-test {tested} ticks, then arming {armed} ticks");
}

#[test]
fn confirmed_fall_trips_within_its_tick_and_for_good() {
    let mut bench = Bench::watching();
    let mut fallen = 0;
    let ticks = ticks_until(156, || {
        fallen += 1;
        let time = seconds(fallen);
        bench.place([0.0, -0.5 * GRAVITY * time * time]);
        let confirmed = bench
            .board
            .notices
            .iter()
            .any(|it| matches!(it, Notice::Confirmed { .. }));
        let safe = bench.outputs() == 0;
        assert_eq!(confirmed, safe, "tick {fallen}");
        safe
    });
    println!("a fall trips {ticks} ticks after it began, in the tick that confirms it");
    assert_eq!(bench.mode(), Mode::Dropped);
    // Floating again by itself does not clear it.
    for _ in 0..2 * ARMED {
        bench.float();
        assert_eq!(bench.outputs() & 0b0011, 0);
    }
    assert_eq!(bench.cause(), Some(Cause::Fall));
    assert_eq!(bench.app.clear(), Ok(()));
    assert_eq!(
        (bench.mode(), bench.cause()),
        (Mode::SelfTest, Some(Cause::Order))
    );
    // It has not been seen where it is lifted from.
    for _ in 0..2 * ARMED {
        assert_eq!(bench.float() & 0b0001, 0);
    }
    assert_eq!(
        (bench.mode(), bench.cause()),
        (Mode::Arming, Some(Cause::NoProof))
    );
    bench.lie_clear_and_lift();
}

/// Put down so slowly that nothing falls.
#[test]
fn what_is_put_down_while_watching_trips_within_a_millisecond_of_the_danger_limit() {
    let mut bench = Bench::watching();
    let distance = |ticks: u32| (3e-3 * seconds(ticks)).min(CLEARANCE);
    let ticks = ticks_until(20_000, || {
        let way = distance(bench.tick - ARMED);
        bench.place([0.0, -way]);
        bench.outputs() & 0b0011 != 0b0011
    });
    let late = seconds(ticks) - 0.67 * CLEARANCE / 3e-3;
    // Noise of 1 um is as long as 0.3 ms of this way.
    assert!((-0.5e-3..1.5e-3).contains(&late), "{late}");
    assert_eq!(bench.cause(), Some(Cause::Danger));
    let is_confirmed = |it: &Notice| matches!(it, Notice::Confirmed { .. });
    assert!(!bench.board.notices.iter().any(is_confirmed));
    assert_eq!((bench.mode(), bench.outputs()), (Mode::Dropped, 0));
}

/// The same, where the danger limit is so wide that the wall reads within it.
#[test]
fn contact_of_what_floated_trips_in_the_tick_that_tells_it() {
    let mut config = default_config();
    config.guard.danger = 0.95;
    let mut bench = Bench::configured(&config, Faults::NONE).watches();
    let tells = [EventKind::Impact, EventKind::Sliding, EventKind::Rolling];
    ticks_until(20_000, || {
        let way = 3e-3 * seconds(bench.tick - ARMED);
        bench.place([0.0, -way.min(0.94 * CLEARANCE)]);
        let told = tells.iter().any(|it| bench.told(*it));
        assert_eq!(told, bench.outputs() == 0);
        told
    });
    assert_eq!(bench.cause(), Some(Cause::Contact));
}

/// The same with a signal that tells that levitation goes off.
#[test]
fn levitation_off_trips_after_three_samples() {
    let mut bench = Bench::watching();
    let ticks = ticks_until(BLIND, || {
        let sample = Sample {
            levitated: Some(false),
            ..bench.at([0.0; 2])
        };
        bench.take(&sample, 0) == 0
    });
    assert_eq!((ticks, bench.cause()), (3, Some(Cause::LevitationOff)));
}

#[test]
fn rotor_that_lies_still_may_be_lifted_and_one_that_swings_wide_may_not() {
    let mut bench = Bench::watching();
    for tick in 1..=156 {
        let time = seconds(tick);
        bench.place([0.0, -(0.5 * GRAVITY * time * time).min(CLEARANCE)]);
    }
    assert_eq!(bench.mode(), Mode::Dropped);
    // A pendulum of 60 degrees with the period of a rolling solid cylinder, 43 ms.
    let swing = |bench: &mut Bench, ticks: u32, amplitude: f64| {
        (0..ticks).any(|_| {
            let turn = core::f64::consts::TAU * seconds(bench.tick) / 0.0426;
            let angle = amplitude * turn.cos();
            bench.place([CLEARANCE * angle.sin(), -CLEARANCE * angle.cos()]) & 0b0100 != 0
        })
    };
    assert!(!swing(&mut bench, 20_000, 60_f64.to_radians()));
    assert!(bench.told(EventKind::Pendulum));
    assert_eq!(bench.app.clear(), Err(Busy::DropRuns));
    assert!(swing(&mut bench, 20_000, 15_f64.to_radians()));
    assert_eq!(bench.outputs(), 0b0100);
    assert_eq!(bench.app.clear(), Ok(()));
}

#[test]
fn rotor_at_rest_from_the_start_may_be_lifted() {
    let mut bench = Bench::new(Faults::NONE);
    let ticks = ticks_until(20_000, || bench.place([0.0, -CLEARANCE]) & 0b0100 != 0);
    println!("permit after {ticks} ticks");
    assert!(bench.told(EventKind::Rest));
    assert_eq!((bench.mode(), bench.outputs()), (Mode::Arming, 0b0110));
}

#[test]
fn whirl_from_a_cold_start_takes_the_brake_until_it_lies_still() {
    let mut bench = Bench::new(Faults::NONE);
    let mut ticks = 0;
    while !(bench.told(EventKind::ForwardWhirl) || bench.told(EventKind::BackwardWhirl)) {
        assert!(ticks < 20_000, "no whirl was told");
        assert_eq!(bench.outputs() & 0b1101, 0);
        let turn = core::f64::consts::TAU * 50.0 * seconds(ticks);
        bench.place([CLEARANCE * turn.cos(), CLEARANCE * turn.sin()]);
        ticks += 1;
    }
    assert_eq!((bench.mode(), bench.outputs()), (Mode::Arming, 0));
    assert_eq!(bench.cause(), Some(Cause::Whirl));
    assert_eq!(bench.app.clear(), Err(Busy::DropRuns));
    ticks_until(40_000, || bench.place([0.0, -CLEARANCE]) == 0b0110);
    assert_eq!(
        (bench.mode(), bench.cause()),
        (Mode::Arming, Some(Cause::NoProof))
    );
    bench.lie_clear_and_lift();
}

#[test]
fn sensors_lost_trip_after_1_ms() {
    let mut bench = Bench::watching();
    assert_eq!(ticks_until(BLIND, || bench.blind() == 0), BLIND);
    assert!(bench.has(Fault::SensorsLost));
    assert_eq!(bench.app.clear(), Err(Busy::Blind));
    assert_eq!(bench.cause(), Some(Cause::PositionsLost));
    for _ in 0..ARMED {
        assert_eq!(bench.float(), 0, "latched");
    }
    bench.lie_clear_and_lift();
}

#[test]
fn one_channel_lost_is_its_plane_lost_which_trips_after_1_ms() {
    for valid in [0b0111, 0b1110, 0b0101, 0b0011, 0b1100] {
        let mut bench = Bench::watching();
        let ticks = ticks_until(BLIND, || {
            let sample = Sample {
                valid,
                ..bench.at([0.0; 2])
            };
            bench.take(&sample, 0) == 0
        });
        assert_eq!(ticks, BLIND, "{valid:04b}");
        assert_eq!(bench.cause(), Some(Cause::PositionsLost));
        assert!(bench.has(Fault::SensorsLost));
    }
}

/// Its plane reads as the stillest of rotors, wherever its end is.
#[test]
fn one_channel_that_freezes_trips_after_two_looks_of_10_ms() {
    for channel in 0..4 {
        let mut bench = Bench::watching();
        let frozen = bench.at([0.0; 2]).counts[channel];
        let looks = SAMPLE_RATE_HZ / 50;
        let ticks = ticks_until(looks, || {
            let mut sample = bench.at([0.0; 2]);
            sample.counts[channel] = frozen;
            bench.take(&sample, 0) & 1 == 0
        });
        assert!(ticks >= looks / 2, "{ticks}");
        assert_eq!(
            (bench.mode(), bench.cause()),
            (Mode::Faulted, Some(Cause::PositionsLost))
        );
    }
}

#[test]
fn lost_sample_puts_out_the_lamp_at_once_and_stays_latched() {
    let mut bench = Bench::watching();
    let sample = bench.at([0.0; 2]);
    assert_eq!(bench.take(&sample, 1), WATCHING & !0b1000);
    assert!(bench.has(Fault::Overrun));
    for _ in 0..ARMED {
        assert_eq!(bench.float(), WATCHING & !0b1000);
    }
    assert_eq!(bench.app.report(0, 0).counters.lost_samples, 1);
    // Clearing a warning does not stop the machine.
    assert_eq!(bench.app.clear(), Ok(()));
    assert_eq!(bench.float(), WATCHING);
}

#[test]
fn overload_trips_after_1_ms_of_lost_samples() {
    let mut bench = Bench::watching();
    let sample = bench.at([0.0; 2]);
    let ticks = ticks_until(BLIND, || bench.take(&sample, 1) == 0);
    assert_eq!(ticks, BLIND);
    assert!(bench.has(Fault::Overload));

    let mut bench = Bench::watching();
    assert_eq!(bench.take(&sample, BLIND), 0, "one gap of 1 ms");
}

#[test]
fn samples_lost_before_clear_do_not_count_after_it() {
    let mut bench = Bench::watching();
    let sample = bench.at([0.0; 2]);
    assert_eq!(bench.take(&sample, BLIND), 0);
    assert_eq!(bench.app.clear(), Ok(()));
    bench.take(&sample, BLIND - 1);
    assert!(!bench.has(Fault::Overload));
    bench.take(&sample, 1);
    assert!(bench.has(Fault::Overload));
}

#[test]
fn any_bit_of_the_configuration_that_flips_trips_within_two_passes() {
    let block = config_block::encode(&default_settings());
    let limit = ConfigScrub::steps(block.len()) as u32;
    let mut longest = 0;
    let bench = Bench::watching();
    let watching = |ahead: u32| {
        let mut bench = Bench {
            app: bench.app.clone(),
            board: Memory {
                block: block.clone(),
                notices: vec![],
                driven: vec![],
                fed: 0,
            },
            ..bench
        };
        for _ in 0..ahead {
            bench.float();
        }
        bench
    };
    for bit in 0..8 * block.len() {
        let mut bench = watching(bit as u32 % (limit / 2));
        bench.board.block[bit / 8] ^= 1 << (bit % 8);
        longest = longest.max(ticks_until(limit, || bench.float() == 0));
        assert!(bench.has(Fault::ConfigChanged));
        // The cause lasts: clearing it never gives current.
        assert_eq!(bench.app.clear(), Ok(()));
        (0..limit).for_each(|_| assert_eq!(bench.float(), 0));
        assert_eq!(bench.mode(), Mode::Faulted);
    }
    println!(
        "{} bits, {longest} ticks at the longest, {limit} allowed",
        8 * block.len()
    );
}

#[test]
fn what_was_wrong_at_power_on_keeps_the_outputs_safe_until_cleared() {
    for fault in [Fault::WatchdogReset, Fault::Crash] {
        let mut bench = Bench::new(Faults::NONE.with(fault));
        for _ in 0..2 * ARMED {
            assert_eq!(bench.float(), 0, "{fault:?}");
        }
        assert_eq!(bench.mode(), Mode::Faulted);
        assert_eq!(bench.cause(), Some(Cause::Fault));
        bench.lie_clear_and_lift();
    }
}

#[test]
fn without_a_configuration_of_its_own_there_is_never_current() {
    for fault in [
        Fault::Unconfigured,
        Fault::ConfigDamaged,
        Fault::ConfigMisfit,
        Fault::ImageDamaged,
    ] {
        let mut bench = Bench::new(Faults::NONE.with(fault));
        for _ in 0..ARMED {
            assert_eq!(bench.float(), 0, "{fault:?}");
        }
        assert_eq!(bench.app.clear(), Err(Busy::Configuration));
        for _ in 0..ARMED {
            assert_eq!(bench.place([0.0, -CLEARANCE]), 0, "{fault:?}");
        }
        assert_eq!(bench.app.clear(), Err(Busy::Configuration));
        assert_eq!(bench.app.may_restart(), Ok(()), "to take another one");
    }
}

#[test]
fn a_configuration_has_to_fit_the_board() {
    let board = Abilities {
        converter: ConverterConfig {
            rate: CONVERSION_RATE_HZ as f32,
            full_scale: 4_095,
        },
        cycles: 8_400.0,
        tachometers: false,
    };
    let fits = default_config();
    assert_eq!(board.misfit(&fits), None);
    // Samples are 1, 2, 4, 8 or 16 conversions; one for each has too few cycles.
    for (rate, misfit) in [
        (20e3, Some("sample_rate")),
        (15e3, Some("sample_rate")),
        // 14 bits.
        (5e3, Some("full_scale")),
        (625.0, Some("sample_rate")),
    ] {
        let mut other = fits;
        other.detector.sample_rate = rate;
        assert_eq!(board.misfit(&other), misfit, "{rate}");
    }
    let mut other = fits;
    other.sensing.full_scale = 4_095;
    assert_eq!(board.misfit(&other), Some("full_scale"));
    (other.detector.sample_rate, other.sensing.full_scale) = (5e3, 16_383);
    assert_eq!(board.misfit(&other), None);
    let emulated = Abilities {
        cycles: f32::INFINITY,
        ..board
    };
    let instants = |tuning: &mut Tuning, [release, impact]: [u8; 2]| {
        (tuning.release_instants, tuning.impact_instants) = (release, impact);
    };
    for (counts, misfit) in [
        ([16, 16], None),
        ([17, 16], Some("release_instants")),
        ([16, 17], Some("impact_instants")),
    ] {
        let mut other = fits;
        instants(&mut other.detector.tuning, counts);
        assert_eq!(board.misfit(&other), misfit, "{counts:?}");
        assert_eq!(emulated.misfit(&other), None);
    }
    let mut other = fits;
    other.detector.sample_rate = 15e3;
    assert_eq!(emulated.misfit(&other), Some("sample_rate"));
}

#[test]
fn with_the_cycles_that_a_configuration_is_held_against_no_sample_is_lost() {
    let measured = include_str!("../measured.json");
    let measured: serde_json::Value = serde_json::from_str(measured).unwrap();
    let cycles = &measured["cycles"];
    assert_eq!(cycles["period"].as_f64(), Some(cost::LEAST.into()));
    assert_eq!(cycles["samples_lost_modelled"].as_u64(), Some(0));
}

#[test]
fn a_fault_while_dropped_takes_the_permit_away() {
    let mut bench = Bench::new(Faults::NONE);
    ticks_until(20_000, || bench.place([0.0, -CLEARANCE]) & 0b0100 != 0);
    assert_eq!(bench.mode(), Mode::Arming);
    // Before anything has been proven, a loss is no fault.
    assert_eq!(ticks_until(BLIND, || bench.blind() & 0b0100 == 0), 1);
    for _ in 0..BLIND {
        bench.blind();
    }
    assert!(!bench.has(Fault::SensorsLost));
    let mut bench = Bench::watching();
    for tick in 1..=20_000 {
        let time = seconds(tick);
        bench.place([0.0, -(0.5 * GRAVITY * time * time).min(CLEARANCE)]);
    }
    assert_eq!((bench.mode(), bench.outputs()), (Mode::Dropped, 0b0100));
    ticks_until(BLIND, || bench.blind() == 0);
    ticks_until(BLIND, || {
        bench.has(Fault::SensorsLost) || bench.blind() != 0
    });
    assert!(bench.has(Fault::SensorsLost));
}

/// The lowest bit of the clearance, in the first coefficient that is one.
fn flip_a_bit_of_the_coefficients(app: &mut App) {
    let monitor = core::ptr::from_ref(app.monitor().0).cast::<u32>();
    let app = core::ptr::from_mut(app).cast::<u32>();
    // SAFETY: of the monitor in the application; any number is one.
    unsafe {
        let first = app.add(monitor.offset_from_unsigned(app));
        let words = (0..MemoryScrub::steps::<Monitor>()).map(|it| first.add(it));
        let mut clearances = words.filter(|it| it.read_volatile() == (CLEARANCE as f32).to_bits());
        *clearances.next().expect("a clearance") ^= 1;
    }
}

#[test]
fn coefficients_that_change_in_memory_trip_within_two_passes() {
    let mut bench = Bench::watching();
    let pass = MemoryScrub::steps::<Monitor>() as u32;
    (0..pass).for_each(|_| assert_eq!(bench.float(), WATCHING));
    flip_a_bit_of_the_coefficients(&mut bench.app);
    ticks_until(2 * pass, || bench.float() == 0);
    assert!(bench.has(Fault::MemoryChanged));
    // The cause lasts: clearing it never gives current.
    assert_eq!(bench.app.clear(), Ok(()));
    for _ in 0..ARMED {
        assert_eq!(bench.float() & 0b0001, 0);
    }
    assert_eq!(bench.mode(), Mode::Faulted);
}

#[test]
fn coefficients_that_change_before_the_first_tick_trip_within_two_passes() {
    let pass = MemoryScrub::steps::<Monitor>() as u32;
    let mut place = core::mem::MaybeUninit::uninit();
    let app = memory::application(&mut place, &default_config(), Faults::NONE);
    let app = app.expect("a valid configuration");
    flip_a_bit_of_the_coefficients(app);
    let mut board = Desk(config_block::encode(&default_settings()));
    let sample = Bench::new(Faults::NONE).at([0.0; 2]);
    ticks_until(2 * pass, || {
        app.take(&mut board, &sample, false, 0, &mut Notices::new());
        app.faults().contains(Fault::MemoryChanged)
    });
}

#[test]
fn a_drop_outlives_the_power_until_it_is_cleared() {
    let (chip, bus) = flash(Chip::new(20));
    let mut log = DropLog::<_, 4>::mount(chip).unwrap();
    let mut bench = Bench::watching();
    let store = |log: &mut DropLog<W25q<_, _>, 4>, app: &App| {
        while log.work(Counted::default(), app.shown().latched(), || None) == Ok(true) {}
    };
    store(&mut log, &bench.app);
    assert_eq!(log.counters().uncleared, None);
    for tick in 1..SAMPLE_RATE_HZ {
        let time = seconds(tick);
        bench.place([0.0, -(0.5 * GRAVITY * time * time).min(CLEARANCE)]);
    }
    assert_eq!(
        (bench.mode(), bench.cause()),
        (Mode::Dropped, Some(Cause::Fall))
    );
    store(&mut log, &bench.app);
    // The power goes and comes, twice: nobody has cleared it.
    for _ in 0..2 {
        log = DropLog::mount(W25q::try_new(bus.clone(), NoDelay).unwrap()).unwrap();
        bench = Bench::new(Faults::NONE);
        bench.app.recall(log.counters().uncleared);
        bench.app.assume_lift();
        for _ in 0..ARMED {
            assert_eq!(bench.float() & 0b0011, 0);
        }
        assert_eq!(
            (bench.mode(), bench.cause()),
            (Mode::Dropped, Some(Cause::Fall))
        );
        store(&mut log, &bench.app);
    }
    bench.lie_clear_and_lift();
    store(&mut log, &bench.app);
    log = DropLog::mount(W25q::try_new(bus, NoDelay).unwrap()).unwrap();
    assert_eq!(log.counters().uncleared, None);
}

/// Rests of 0.1 s at a wall that is nearer by a tenth than at the commissioning check.
#[test]
fn a_wall_that_has_moved_is_told_once_until_clear_and_trips_nothing() {
    let mut config = default_config();
    config.sensing.calibration = Some(Default::default());
    let moved = |bench: &Bench| {
        let faults = bench.board.notices.iter().filter_map(|it| match it {
            Notice::Declared(event) => event.fault,
            _ => None,
        });
        faults.filter(|it| it.kind == FaultKind::Moved).count()
    };
    let mut bench = Bench::configured(&config, Faults::NONE);
    let lie = |bench: &mut Bench| {
        for _ in 0..SAMPLE_RATE_HZ {
            bench.place([0.0, -0.9 * CLEARANCE]);
        }
    };
    lie(&mut bench);
    assert_eq!(moved(&bench), 2, "a plane each");
    lie(&mut bench);
    assert_eq!(moved(&bench), 2);
    assert_eq!(bench.app.clear(), Ok(()));
    lie(&mut bench);
    assert_eq!(moved(&bench), 4);
    assert_eq!(
        bench.app.state().health.conditions(),
        [Condition::Ok; CHANNELS]
    );
    assert_eq!(bench.app.faults(), Faults::NONE);
}
