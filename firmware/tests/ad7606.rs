//! The driver's every move on its pins and its bus, against mocks.

use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as Level};
use embedded_hal_mock::eh1::spi::{Mock as Spi, Transaction};
use touchdown_firmware::ad7606::Ad7606;

fn levels(states: &[State]) -> Vec<Level> {
    states.iter().map(|it| Level::set(*it)).collect()
}

/// Runs one sample; `busy` is what the pin shows, `bytes` what the bus gives, if it is read.
fn sample(busy: &[State], bytes: Option<[u8; 8]>) -> touchdown_core::sample::Sample {
    let spi: Vec<Transaction<u8>> = bytes.map_or(vec![], |bytes| {
        vec![
            Transaction::transaction_start(),
            Transaction::read_vec(bytes.to_vec()),
            Transaction::transaction_end(),
        ]
    });
    let convst = levels(&[State::High, State::Low, State::High]);
    let busy: Vec<_> = busy.iter().map(|it| Level::get(*it)).collect();
    let reset = levels(&[State::High, State::Low]);
    let mut delay = NoopDelay::new();
    let (spi, convst, busy, reset) = (
        Spi::new(&spi),
        Pin::new(&convst),
        Pin::new(&busy),
        Pin::new(&reset),
    );
    let mut adc = Ad7606::try_new(spi, convst, busy, reset, &mut delay).unwrap();
    adc.start(&mut delay).unwrap();
    let sample = adc.take(&mut delay);
    let (mut spi, mut convst, mut busy, mut reset) = adc.release();
    spi.done();
    convst.done();
    busy.done();
    reset.done();
    sample
}

#[test]
fn sample_is_read_when_the_conversion_is_over() {
    let bytes = [0x80, 0x00, 0xff, 0xff, 0x00, 0x00, 0x7f, 0xff];
    let sample = sample(&[State::High, State::High, State::Low], Some(bytes));
    assert_eq!(sample.counts, [0, 32_767, 32_768, 65_535]);
    assert_eq!(sample.valid, 0b1111);
}

#[test]
fn converter_that_stays_busy_gives_no_valid_channel_and_does_not_block() {
    let sample = sample(&[State::High; 43], None);
    assert_eq!(sample.valid, 0);
}
