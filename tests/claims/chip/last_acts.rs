//! What a program that stops does last, by the very handlers of the image for silicon: outputs without current
//! before anything else, a record that outlives the reset. And the watchdog's time. QEMU emulates neither pins
//! nor watchdog, but logs what is written to them.

use std::path::Path;
use std::time::Duration;

use tempfile::TempDir;
use touchdown_run::emulator::{Emulator, EmulatorError, built};

const LIMIT: Duration = Duration::from_secs(60);
/// RM0090: GPIOx_BSRR, and the bits that reset PC2, PC3, PC6 and PC7.
const BSRR: u32 = 0x18;
const ALL_OFF: u32 = 0x00cc_0000;
/// QEMU 7.2 calls the block at 0x40003000 after another one that it puts at the same address.
const WATCHDOG: &str = "I2S2ext";
/// RM0090: IWDG_KR, IWDG_PR, IWDG_RLR.
const KR: u32 = 0;
const PR: u32 = 4;
const RLR: u32 = 8;

/// A write to a device that is not emulated.
#[derive(Debug, PartialEq)]
struct Write {
    device: String,
    offset: u32,
    value: u32,
}

/// Runs the image that stops on purpose; what it logged, and what it wrote.
fn stopped(how: &str) -> (Result<Vec<String>, EmulatorError>, Vec<Write>) {
    let emulator = Emulator::find(Some(&built("touchdown-crash")));
    let emulator = emulator.unwrap_or_else(|error| panic!("{error}"));
    let folder = TempDir::new().expect("a folder");
    let semihosting = format!("enable=on,target=native,arg={how}");
    let arguments = [&semihosting, "-d", "unimp", "-D", "trace"];
    let log = emulator.execute(folder.path(), &arguments, LIMIT);
    (log, writes(&folder.path().join("trace")))
}

/// Lines as "GPIOC: unimplemented device write (size 4, offset 0x018, value 0x00cc0000)".
fn writes(trace: &Path) -> Vec<Write> {
    let text = std::fs::read_to_string(trace).expect("a trace");
    let hex = |text: &str| {
        let digits = text.trim().trim_start_matches("0x");
        u32::from_str_radix(digits, 16).expect("a number")
    };
    let line = |line: &str| {
        let (device, rest) = line.split_once(": unimplemented device write")?;
        let (_, rest) = rest.split_once("offset ")?;
        let (offset, value) = rest.split_once(", value ")?;
        Some(Write {
            device: device.to_owned(),
            offset: hex(offset),
            value: hex(value.trim_end_matches(')')),
        })
    };
    text.lines().filter_map(line).collect()
}

fn is_to(write: &Write, device: &str, offset: u32) -> bool {
    write.device == device && write.offset == offset
}

#[test]
fn outputs_are_dropped_first_and_the_reason_outlives_the_reset() {
    for (how, cause) in [("panic", 1), ("fault", 2), ("interrupt", 3)] {
        let (log, writes) = stopped(how);
        let log = log.unwrap_or_else(|error| panic!("{how}: {error}"));
        let [cause_told, place, _, cfsr, hfsr] = log[0].split(' ').collect::<Vec<_>>()[..] else {
            panic!("{log:?}");
        };
        assert_eq!(cause_told, cause.to_string(), "{how}: {log:?}");
        assert_ne!(place, "0x0", "{how}: {log:?}");
        // An undefined instruction, which became a hard fault: ARMv7-M, CFSR.UNDEFINSTR, HFSR.FORCED.
        let status = if how == "fault" { ["0x10000", "0x40000000"] } else { ["0x0", "0x0"] };
        assert_eq!([cfsr, hfsr], status, "{how}: {log:?}");
        // The outputs got current, the watchdog was fed; the next write of all takes the current away.
        let fed = writes
            .iter()
            .position(|it| is_to(it, WATCHDOG, KR) && it.value == 0xaaaa);
        let fed = fed.expect("a watchdog that is fed");
        let on = writes[..fed].iter().rfind(|it| is_to(it, "GPIOC", BSRR));
        assert_eq!(on.expect("outputs").value & 0xffff, 0x00c8, "{how}");
        let next = &writes[fed + 1];
        assert!(is_to(next, "GPIOC", BSRR), "{how}: {next:?}");
        assert_eq!(next.value, ALL_OFF, "{how}");
        println!("{how}: {}", log[0]);
    }
}

#[test]
fn the_watchdog_bites_after_2_ms() {
    let (_, writes) = stopped("panic");
    let of = |offset: u32| {
        let mut all = writes.iter().filter(move |it| is_to(it, WATCHDOG, offset));
        all.next().expect("is written").value
    };
    let keys = writes.iter().filter(|it| is_to(it, WATCHDOG, KR));
    let keys: Vec<_> = keys.map(|it| it.value).take(3).collect();
    // Start, unlock, feed.
    assert_eq!(keys, [0xcccc, 0x5555, 0xaaaa]);
    let cycles = f64::from((4 << of(PR)) * (of(RLR) + 1));
    // LSI, kHz: DS8626, 32 typical, 17 to 47.
    let ms = [32.0, 47.0, 17.0].map(|khz| cycles / khz);
    assert_eq!(ms[0], 2.0);
    assert!(ms[1] >= 1.3 && ms[2] <= 3.8, "{ms:?}");
}

#[test]
fn a_stack_that_overflows_stops_the_core_and_touches_no_data() {
    let (log, _) = stopped("overflow");
    // QEMU ends where the core locks up, for which silicon has the watchdog.
    let Err(EmulatorError::Failed { qemu, .. }) = log else {
        panic!("{log:?}");
    };
    assert!(qemu.contains("Lockup"), "{qemu}");
}
