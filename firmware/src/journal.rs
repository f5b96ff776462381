//! What the images log.

use defmt::{error, info, warn};
use touchdown_core::event::Notice;
use touchdown_core::monitor::MonitorConfig;
use touchdown_protocol::controller::{Cause, Shown};

use crate::crash::Crash;
use crate::platform::JournalEntry;

/// The configuration in force.
pub fn config(config: &MonitorConfig) {
    let detector = &config.detector;
    info!(
        "config: channels {=u8:04b}, {=f32} Hz, {=f32} um a count, clearance {=f32} um",
        config.fitted,
        detector.sample_rate,
        config.sensing.resolution * 1e6,
        detector.machine.clearance * 1e6,
    );
}

/// What is new.
pub fn entry(entry: &JournalEntry<'_>) {
    match entry {
        JournalEntry::Notice(it) => notice(it),
        JournalEntry::Shown(it) => shown(*it),
        JournalEntry::Faults(it) => warn!("faults: {=u16:07b}", it.0),
    }
}

fn notice(notice: &Notice) {
    match *notice {
        Notice::Declared(event) => info!(
            "event {=u16}: {=str}, declared at sample {=u64}",
            event.number,
            <&str>::from(event.kind),
            event.declared
        ),
        Notice::Confirmed { number, sample } => {
            warn!("event {=u16}: confirmed at sample {=u64}", number, sample);
        }
        Notice::Withdrawn { number, sample } => {
            info!("event {=u16}: withdrawn at sample {=u64}", number, sample);
        }
        Notice::Alarm(alarm) => warn!(
            "alarm: level {=u8}, plane {=u8}, at {=f32} of the clearance, sample {=u64}",
            alarm.level as u8, alarm.plane as u8, alarm.fraction, alarm.sample
        ),
        Notice::Touch(touch) => info!(
            "touch {=u16}: ended {=bool}, onset at sample {=u64}, peak {=f32}",
            touch.number,
            touch.end.is_some(),
            touch.onset,
            touch.peak
        ),
        Notice::Ordered(ordered) => warn!(
            "order: refused {=u8}, sample {=u64}",
            ordered.refused, ordered.sample
        ),
        Notice::Outlook(outlook) => info!(
            "whirl: forward {=f32}, backward {=f32}, as of sample {=u64}",
            outlook.probability_forward, outlook.probability_backward, outlook.made_at
        ),
    }
}

fn shown(shown: Shown) {
    let outputs = shown.outputs;
    info!(
        "outputs: run {=bool}, no brake {=bool}, permit {=bool}, ready {=bool}; mode {=u8}, cause {=u8}",
        outputs.run,
        outputs.no_brake,
        outputs.permit,
        outputs.ready,
        shown.mode as u8,
        Cause::byte_of(shown.cause)
    );
}

/// The record of a crash.
pub fn crash(crash: &Crash) {
    let [configurable, hard, address] = crash.status;
    error!(
        "crash: cause {=u8}, at {=u32:#x}, {=u32:#x}; cfsr {=u32:#x}, hfsr {=u32:#x}, address {=u32:#x}",
        crash.cause as u8, crash.place, crash.detail, configurable, hard, address
    );
}
