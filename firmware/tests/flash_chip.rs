//! The driver of the serial flash: its commands, byte for byte, and the rules of the chip.

mod common;

use common::chip::{Chip, NoDelay, flash};
use embedded_hal_mock::eh1::spi::{Mock, Transaction};
use embedded_storage::nor_flash::{NorFlash, NorFlashErrorKind, ReadNorFlash};
use touchdown_firmware::w25q::{Error, W25q};

type Step = Transaction<u8>;

fn exchange(write: &[u8], read: &[u8]) -> Vec<Step> {
    vec![
        Step::transaction_start(),
        Step::write_vec(write.to_vec()),
        Step::read_vec(read.to_vec()),
        Step::transaction_end(),
    ]
}

fn send(parts: &[&[u8]]) -> Vec<Step> {
    let writes = parts.iter().map(|part| Step::write_vec(part.to_vec()));
    std::iter::once(Step::transaction_start())
        .chain(writes)
        .chain([Step::transaction_end()])
        .collect()
}

const READY: u8 = 0x00;
const BUSY: u8 = 0x01;
const ENABLED: u8 = 0x02;

fn status(value: u8) -> Vec<Step> {
    exchange(&[0x05], &[value])
}

/// W25Q64JV: EFh 40h 17h, 8 MiB; and its bus, which tells whether all steps were done.
fn started(steps: &[Vec<Step>]) -> (W25q<Mock<u8>, NoDelay>, Mock<u8>) {
    let mut all = [status(READY), exchange(&[0x9f], &[0xef, 0x40, 0x17])].concat();
    all.extend(steps.concat());
    let spi = Mock::new(&all);
    (W25q::try_new(spi.clone(), NoDelay).unwrap(), spi)
}

#[test]
fn the_part_is_asked_for() {
    let (flash, mut spi) = started(&[]);
    assert_eq!(flash.capacity(), 8 << 20);
    spi.done();
    for id in [[0xff; 3], [0; 3], [0xef, 0x40, 0x19], [0xc2, 0x20, 0x17]] {
        let steps = [status(READY), exchange(&[0x9f], &id)].concat();
        let mut spi = Mock::new(&steps);
        let refused = W25q::try_new(spi.clone(), NoDelay).err();
        assert_eq!(refused, Some(Error::Part(id)));
        spi.done();
    }
}

#[test]
fn a_program_stops_at_the_end_of_a_page() {
    let (mut flash, mut spi) = started(&[
        status(READY),
        send(&[&[0x06]]),
        status(ENABLED),
        send(&[&[0x02, 0x01, 0x02, 0xfe], &[1, 2]]),
        status(BUSY),
        status(BUSY),
        status(READY),
        send(&[&[0x06]]),
        status(ENABLED),
        send(&[&[0x02, 0x01, 0x03, 0x00], &[3]]),
    ]);
    flash.write(0x0001_02fe, &[1, 2, 3]).unwrap();
    spi.done();
}

#[test]
fn an_erase_takes_whole_sectors() {
    let (mut flash, mut spi) = started(&[
        status(READY),
        send(&[&[0x06]]),
        status(ENABLED),
        send(&[&[0x20, 0x00, 0x10, 0x00]]),
    ]);
    flash.erase(0x1000, 0x2000).unwrap();
    let unaligned = flash.erase(0x1000, 0x2001);
    assert_eq!(unaligned, Err(Error::Range(NorFlashErrorKind::NotAligned)));
    let beyond = flash.erase(8 << 20, (8 << 20) + 0x1000);
    assert_eq!(beyond, Err(Error::Range(NorFlashErrorKind::OutOfBounds)));
    spi.done();
}

#[test]
fn a_read_waits_for_the_last_change() {
    let (mut flash, mut spi) = started(&[
        status(BUSY),
        status(BUSY),
        status(READY),
        exchange(&[0x03, 0x12, 0x34, 0x56], &[7, 8]),
    ]);
    let mut bytes = [0; 2];
    assert_eq!(flash.is_busy(), Ok(true));
    flash.read(0x12_3456, &mut bytes).unwrap();
    assert_eq!(bytes, [7, 8]);
    spi.done();
}

#[test]
fn a_protected_or_stuck_chip_is_reported() {
    let (mut flash, mut spi) = started(&[status(READY), send(&[&[0x06]]), status(READY)]);
    assert_eq!(flash.write(0, &[0]), Err(Error::Protected));
    spi.done();
    let steps: Vec<_> = (0..5_000).map(|_| status(BUSY)).collect();
    let (mut flash, mut spi) = started(&steps);
    assert_eq!(flash.write(0, &[0]), Err(Error::Busy));
    spi.done();
}

#[test]
fn the_simulated_chip_has_the_rules_of_a_real_one() {
    let (mut flash, bus) = flash(Chip::new(20));
    bus.0.borrow_mut().busy_for = 3;
    let data: Vec<u8> = (0..=255).collect();
    flash.write(0x10f0, &data).unwrap();
    let mut back = [0; 256];
    flash.read(0x10f0, &mut back).unwrap();
    assert_eq!(back[..], data);
    // A second program only clears bits, and is told on.
    flash.write(0x10f0, &[0xff, 0x01]).unwrap();
    flash.read(0x10f0, &mut back).unwrap();
    assert_eq!(back[..2], [0x00, 0x01]);
    assert_eq!(bus.0.borrow().set_bits, 8);
    flash.erase(0x1000, 0x2000).unwrap();
    flash.read(0x10f0, &mut back).unwrap();
    assert_eq!(back, [0xff; 256]);
    // Two pages, two and an erase.
    assert_eq!(bus.0.borrow().operations, 4);
}
