//! STM32F405: sampled by its own converter, 20 000 times a second.
//!
//! The tick is the converter's interrupt, the only one and so the highest. It must be over before
//! the next sample, 50 us later; a tick that is not loses samples, which are counted and latched,
//! and goes on. What it reports goes through a queue to the idle loop, which logs.

mod clocks;
mod converter;
mod outputs;
mod record;

use core::cell::RefCell;
use core::panic::PanicInfo;

use critical_section::Mutex;
use defmt::{error, info};
use heapless::spsc::{Producer, Queue};
use stm32f4::stm32f405::{Interrupt, NVIC, Peripherals};
use touchdown_core::config_block;
use touchdown_core::controller::{Fault, Faults, Outputs};
use touchdown_core::event::Notice;

use self::clocks::CORE_HZ;
use self::converter::Converter;
use self::outputs::{OutputPins, Watchdog};
use super::{Board, SAMPLE_RATE_HZ, default_settings};
use crate::app::App;
use crate::crash::{Cause, Crash};
use crate::journal;
use crate::overrun::Overruns;

/// Notices on their way to the log. If it is full they are dropped; events are numbered, so a gap
/// shows.
pub type Outbox = Queue<Notice, 64>;

static TICK: Mutex<RefCell<Option<Tick>>> = Mutex::new(RefCell::new(None));

struct Silicon {
    pins: OutputPins,
    watchdog: Watchdog,
    outbox: Producer<'static, Notice>,
    block: config_block::Block,
}

impl Board for Silicon {
    fn report(&mut self, notice: &Notice) {
        let _ = self.outbox.enqueue(*notice);
    }

    fn drive(&mut self, outputs: Outputs) {
        self.pins.drive(outputs);
    }

    fn config(&self) -> &[u8] {
        &self.block
    }

    fn feed(&mut self) {
        self.watchdog.feed();
    }
}

struct Tick {
    app: App,
    converter: Converter,
    board: Silicon,
    overruns: Overruns,
}

/// Starts sampling, and logs.
pub fn main(outbox: &'static mut Outbox) -> ! {
    let (Some(core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        unreachable!("main runs once");
    };
    let pins = OutputPins::new(chip.GPIOC, &chip.RCC);
    info!("touchdown {=str} on stm32f405", env!("CARGO_PKG_VERSION"));
    let mut found = Faults::NONE;
    if Watchdog::has_bitten(&chip.RCC) {
        error!("watchdog reset");
        found = found.with(Fault::WatchdogReset);
    }
    if let Some(Crash {
        cause,
        place,
        detail,
    }) = record::read()
    {
        error!(
            "crash: cause {=u8}, at {=u32:#x}, {=u32:#x}",
            cause as u8, place, detail
        );
        found = found.with(Fault::Crash);
    }
    let settings = default_settings();
    journal::config(&settings.monitor);
    let app = match App::try_new(&settings.monitor, found) {
        Ok(app) => app,
        Err(refusal) => {
            error!("config: {=str}", refusal.parameter());
            idle()
        }
    };

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
        board: Silicon {
            pins,
            watchdog: Watchdog::start(chip.IWDG, &chip.DBGMCU),
            outbox,
            block: config_block::encode(&settings),
        },
        overruns: Overruns::new(CORE_HZ / SAMPLE_RATE_HZ),
    };
    critical_section::with(|cs| TICK.replace(cs, Some(tick)));
    // SAFETY: what the handler needs is in place, and no critical section is open.
    unsafe { NVIC::unmask(Interrupt::ADC) };

    let mut known = (Outputs::SAFE, Faults::NONE);
    loop {
        while let Some(notice) = inbox.dequeue() {
            journal::notice(&notice);
        }
        let seen = with_tick(|tick| (tick.app.outputs(), tick.app.condition().faults));
        let Some((outputs, faults)) = seen else {
            continue;
        };
        if outputs != known.0 {
            journal::outputs(outputs);
        }
        if faults != known.1 {
            journal::faults(faults);
        }
        known = (outputs, faults);
    }
}

fn with_tick<T>(act: impl FnOnce(&mut Tick) -> T) -> Option<T> {
    critical_section::with(|cs| TICK.borrow_ref_mut(cs).as_mut().map(act))
}

/// The tick: the converter has a sample.
pub fn on_converted() {
    let now = cortex_m::peripheral::DWT::cycle_count();
    with_tick(|tick| {
        let lost = tick.overruns.tick(now);
        let sample = tick.converter.take();
        tick.app.tick(&mut tick.board, &sample, lost);
    });
}

/// The end of a program that panics: outputs dropped, a record left, reset.
pub fn on_panic(info: &PanicInfo) -> ! {
    record::stop(|| Crash::of_panic(info))
}

/// Likewise after a fault of the core at `pc`, called from `lr`.
pub fn on_hard_fault(pc: u32, lr: u32) -> ! {
    record::stop(|| Crash {
        cause: Cause::HardFault,
        place: pc,
        detail: lr,
    })
}

/// Likewise after an interrupt that nothing serves.
pub fn on_stray_interrupt(number: i16) -> ! {
    record::stop(|| Crash {
        cause: Cause::StrayInterrupt,
        place: number as u32,
        detail: 0,
    })
}

fn start_cycle_counter(mut dcb: cortex_m::peripheral::DCB, mut dwt: cortex_m::peripheral::DWT) {
    dcb.enable_trace();
    dwt.enable_cycle_counter();
}

/// With the outputs without current there is nothing left to do.
fn idle() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}
