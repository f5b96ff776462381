//! AD7606: eight channels of 16 bit, +-10 V, all sampled at one instant. Serial mode, first four
//! channels, over embedded-hal.
//!
//! Sources: [DS] Analog Devices, AD7606/AD7606-6/AD7606-4, Rev. C, timing specifications, as its figures are
//! known; held against what others build by it: [L] Linux, drivers/iio/adc/ad7606.c; [G] GSI,
//! bel_projects, modules/ad7606/ad7606.vhd. Where they differ the safer one is kept. SPI mode 2 (clock
//! idles high, data are taken on its falling edge: DS page 28), chip select by the device. A timer starts the conversion by
//! CONVST, so that software jitter does not reach the sampling instant. It must be over before the data are read; nothing
//! here waits for longer than [`LONGEST_CONVERSION_NS`].

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::spi::SpiDevice;
use touchdown_core::sample::CHANNELS;

/// Fastest clock at 3.3 V, Hz: f_SCLK. G: 14.5 MHz, which is DS's for VDRIVE above 2.7 V; its 17 MHz are for above
/// 3.3 V, which a supply of 3.3 V is not.
pub const FASTEST_CLOCK_HZ: u32 = 14_500_000;
/// Shortest RESET pulse, ns: t_RESET. L: 100; DS and G: 50.
pub const RESET_NS: u32 = 100;
/// Longest conversion without oversampling, ns: t_CONV. DS only: 4 us typical, 4.15 us at most.
pub const LONGEST_CONVERSION_NS: u32 = 4_150;
/// Reads of BUSY, 100 ns apart, before the converter is given up.
const READS: u32 = LONGEST_CONVERSION_NS.div_ceil(100);

/// The converter.
pub struct Ad7606<S, B> {
    spi: S,
    busy: B,
}

impl<S: SpiDevice, B: InputPin> Ad7606<S, B> {
    /// Resets the converter; `None` where its pin fails.
    pub fn try_new(
        spi: S,
        busy: B,
        mut reset: impl OutputPin,
        delay: &mut impl DelayNs,
    ) -> Option<Self> {
        reset.set_high().ok()?;
        delay.delay_ns(RESET_NS);
        reset.set_low().ok()?;
        Some(Self { spi, busy })
    }

    /// Waits for the end of the conversion, and reads it. Offset binary: 0 for -10 V, 32768 for 0 V, 65535 for +10 V less one
    /// count. `None` where a pin or the SPI fails, or BUSY does not go low in time.
    pub fn take(&mut self, delay: &mut impl DelayNs) -> Option<[u16; CHANNELS]> {
        let mut reads = 0;
        while self.busy.is_high().ok()? {
            reads += 1;
            if reads > READS {
                return None;
            }
            delay.delay_ns(100);
        }
        let mut bytes = [0; 2 * CHANNELS];
        self.spi.read(&mut bytes).ok()?;
        let mut codes = [0; CHANNELS];
        for (code, &[high, low]) in codes.iter_mut().zip(bytes.as_chunks().0) {
            // Two's complement on the line, V1 first.
            *code = u16::from_be_bytes([high, low]) ^ 0x8000;
        }
        Some(codes)
    }
}
