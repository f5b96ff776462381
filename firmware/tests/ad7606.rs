//! The driver's every move on its pins and its bus, against mocks; its times against a converter that is as slow as
//! one may be.

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use embedded_hal::spi::{self, Operation, SpiDevice};
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as Level};
use embedded_hal_mock::eh1::spi::{Mock as Spi, Transaction};
use touchdown_firmware::ad7606::{Ad7606, FASTEST_CLOCK_HZ, LONGEST_CONVERSION_NS, RESET_NS};
use touchdown_firmware::board::CONVERSION_RATE_HZ;

fn levels(states: &[State]) -> Vec<Level> {
    states.iter().map(|it| Level::set(*it)).collect()
}

/// Runs one sample; `busy` is what the pin shows, `bytes` what the bus gives, if it is read.
fn sample(busy: &[State], bytes: Option<[u8; 8]>) -> Option<[u16; 4]> {
    let spi: Vec<Transaction<u8>> = bytes.map_or(vec![], |bytes| {
        vec![
            Transaction::transaction_start(),
            Transaction::read_vec(bytes.to_vec()),
            Transaction::transaction_end(),
        ]
    });
    let busy: Vec<_> = busy.iter().map(|it| Level::get(*it)).collect();
    let reset = levels(&[State::High, State::Low]);
    let mut delay = NoopDelay::new();
    let (mut spi, mut busy, mut reset) = (Spi::new(&spi), Pin::new(&busy), Pin::new(&reset));
    let mut adc = Ad7606::try_new(spi.clone(), busy.clone(), reset.clone(), &mut delay).unwrap();
    let sample = adc.take(&mut delay);
    spi.done();
    busy.done();
    reset.done();
    sample
}

#[test]
fn sample_is_read_when_the_conversion_is_over() {
    let bytes = [0x80, 0x00, 0xff, 0xff, 0x00, 0x00, 0x7f, 0xff];
    let sample = sample(&[State::High, State::High, State::Low], Some(bytes));
    assert_eq!(sample, Some([0, 32_767, 32_768, 65_535]));
}

#[test]
fn converter_that_stays_busy_gives_no_valid_channel_and_does_not_block() {
    let sample = sample(&[State::High; 43], None);
    assert_eq!(sample, None);
}

/// A converter on a clock that only delays move: pins and bus take no time, which is the worst for who must wait.
#[derive(Default)]
struct Converter {
    now: u32,
    conversion: u32,
    /// When the timer started the conversion.
    started: u32,
    /// When RESET rose, while it is high.
    reset: Option<u32>,
    reads: u32,
}

impl Converter {
    fn is_busy(&self) -> bool {
        self.now - self.started < self.conversion
    }
}

#[derive(Clone)]
struct Wire(Rc<RefCell<Converter>>);

impl ErrorType for Wire {
    type Error = Infallible;
}

impl OutputPin for Wire {
    fn set_low(&mut self) -> Result<(), Infallible> {
        let mut converter = self.0.borrow_mut();
        let rose = converter.reset.take().expect("RESET was high");
        assert!(converter.now - rose >= 100, "RESET high");
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        let mut converter = self.0.borrow_mut();
        converter.reset = Some(converter.now);
        Ok(())
    }
}

impl InputPin for Wire {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.borrow().is_busy())
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.0.borrow().is_busy())
    }
}

impl spi::ErrorType for Wire {
    type Error = Infallible;
}

impl SpiDevice for Wire {
    fn transaction(&mut self, _: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let mut converter = self.0.borrow_mut();
        assert!(!converter.is_busy(), "read before the conversion was over");
        converter.reads += 1;
        Ok(())
    }
}

impl DelayNs for Wire {
    fn delay_ns(&mut self, ns: u32) {
        self.0.borrow_mut().now += ns;
    }
}

/// Three samples of a converter that takes `conversion` (ns); those that were read, and the longest take, ns.
fn samples(conversion: u32) -> (u32, u32) {
    let converter = Rc::new(RefCell::new(Converter {
        conversion,
        now: 1_000,
        ..Converter::default()
    }));
    let wire = || Wire(Rc::clone(&converter));
    let mut delay = wire();
    let mut adc = Ad7606::try_new(wire(), wire(), wire(), &mut delay).expect("resets");
    assert_eq!(converter.borrow().reset, None);
    let mut longest = 0;
    for _ in 0..3 {
        let before = converter.borrow().now;
        converter.borrow_mut().started = before;
        adc.take(&mut delay);
        longest = longest.max(converter.borrow().now - before);
    }
    let reads = converter.borrow().reads;
    (reads, longest)
}

/// The sources' figures stand here again, so that one that is changed in the driver must be changed twice.
#[test]
fn the_driver_keeps_the_times_of_its_sources() {
    assert_eq!(
        (RESET_NS, LONGEST_CONVERSION_NS, FASTEST_CLOCK_HZ),
        (100, 4_150, 14_500_000)
    );
    for conversion in [50, 3_450, 4_000, 4_150] {
        let (reads, longest) = samples(conversion);
        assert_eq!(reads, 3, "a conversion of {conversion} ns is waited for");
        assert!(longest >= conversion);
    }
    // One that hangs is given up, in time for the next sample: with the reading, four times sixteen clocks.
    let (reads, longest) = samples(u32::MAX);
    assert_eq!(reads, 0);
    let reading = 64 * 1_000_000_000_u64 / u64::from(FASTEST_CLOCK_HZ);
    assert!(u64::from(longest) + reading < 1_000_000_000 / u64::from(CONVERSION_RATE_HZ) / 5);
}
