//! STM32F405: sampled by its own converter, 20 000 times a second.
//!
//! The tick is the converter's interrupt, the only one and so the highest. It must be over before
//! the next sample, 50 us later; a tick that is not loses samples, which are counted and stay
//! counted, and goes on. What it reports goes through a queue to the idle loop, which logs.

mod clocks;
mod converter;
mod outputs;

use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering};

use critical_section::Mutex;
use defmt::{error, info, warn};
use heapless::spsc::{Producer, Queue};
use stm32f4::stm32f405::{Interrupt, NVIC, Peripherals};
use touchdown_core::event::Notice;
use touchdown_core::monitor::MonitorConfig;

use self::clocks::CORE_HZ;
use self::converter::Converter;
use self::outputs::{TripPin, Watchdog};
use super::{Board, SAMPLE_RATE_HZ, TripOutput};
use crate::app::App;
use crate::journal;
use crate::overrun::Overruns;

/// Notices on their way to the log. If it is full they are dropped; events are numbered, so a gap
/// shows.
pub type Outbox = Queue<Notice, 64>;

static TICK: Mutex<RefCell<Option<Tick>>> = Mutex::new(RefCell::new(None));
static LOST_SAMPLES: AtomicU32 = AtomicU32::new(0);

struct Outputs {
    pin: TripPin,
    watchdog: Watchdog,
    outbox: Producer<'static, Notice>,
}

impl Board for Outputs {
    fn report(&mut self, notice: &Notice) {
        let _ = self.outbox.enqueue(*notice);
    }

    fn drive(&mut self, output: TripOutput) {
        self.pin.drive(output);
        self.watchdog.feed();
    }
}

struct Tick {
    app: App,
    converter: Converter,
    outputs: Outputs,
    overruns: Overruns,
}

/// Starts sampling, and logs.
pub fn main(config: &MonitorConfig, outbox: &'static mut Outbox) -> ! {
    let (Some(core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        unreachable!("main runs once");
    };
    let bitten = Watchdog::has_bitten(&chip.RCC);
    let pin = TripPin::new(chip.GPIOC, &chip.RCC);
    info!("touchdown {=str} on stm32f405", env!("CARGO_PKG_VERSION"));
    journal::config(config);
    let mut app = match App::try_new(config) {
        Ok(app) => app,
        Err(refusal) => {
            error!("config: {}", defmt::Display2Format(&refusal));
            idle_tripped()
        }
    };
    if bitten {
        // A core that got stuck once is not to be trusted before someone has looked at it.
        error!("watchdog reset: output stays tripped until the power is cycled");
        app.trip();
    }

    clocks::start(&chip.RCC, &chip.FLASH);
    start_cycle_counter(core.DCB, core.DWT);
    let converter = Converter::new(
        chip.ADC1,
        &chip.ADC_COMMON,
        chip.TIM2,
        &chip.GPIOA,
        &chip.RCC,
    );
    let (outbox, mut inbox) = outbox.split();
    converter.start();
    let tick = Tick {
        app,
        converter,
        outputs: Outputs {
            pin,
            watchdog: Watchdog::start(chip.IWDG, &chip.DBGMCU),
            outbox,
        },
        overruns: Overruns::new(CORE_HZ / SAMPLE_RATE_HZ),
    };
    critical_section::with(|cs| TICK.replace(cs, Some(tick)));
    // SAFETY: what the handler needs is in place, and no critical section is open.
    unsafe { NVIC::unmask(Interrupt::ADC) };

    let mut known_lost = 0;
    loop {
        while let Some(notice) = inbox.dequeue() {
            journal::notice(&notice);
        }
        let lost = LOST_SAMPLES.load(Ordering::Relaxed);
        if lost != known_lost {
            warn!("overrun: {=u32} samples lost since reset", lost);
            known_lost = lost;
        }
    }
}

/// The tick: the converter has a sample.
pub fn on_converted() {
    let now = cortex_m::peripheral::DWT::cycle_count();
    critical_section::with(|cs| {
        if let Some(tick) = TICK.borrow_ref_mut(cs).as_mut() {
            tick.overruns.tick(now);
            LOST_SAMPLES.store(tick.overruns.lost(), Ordering::Relaxed);
            let sample = tick.converter.take();
            tick.app.tick(&mut tick.outputs, &sample);
        }
    });
}

fn start_cycle_counter(mut dcb: cortex_m::peripheral::DCB, mut dwt: cortex_m::peripheral::DWT) {
    dcb.enable_trace();
    dwt.enable_cycle_counter();
}

/// With the trip output de-energised there is nothing left to do.
fn idle_tripped() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}
