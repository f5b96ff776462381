//! A core whose ticks take time, a line of 115 200 baud and a flash that is long busy, around the real main loop.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

use touchdown_core::event::{Event, Notice};
use touchdown_core::oversampling::ConverterConfig;
use touchdown_core::sample::Sample;
use touchdown_firmware::board::{
    Abilities, Board, CONVERSION_RATE_HZ, SAMPLE_RATE_HZ, default_settings,
};
use touchdown_firmware::drop_log::DropLog;
use touchdown_firmware::intake::Intake;
use touchdown_firmware::main_loop::MainLoop;
use touchdown_firmware::memory::Memory;
use touchdown_firmware::outgoing::Outgoing;
use touchdown_firmware::platform::Platform;
use touchdown_firmware::tick::TickTask;
use touchdown_firmware::w25q::W25q;
use touchdown_protocol::config_block::{self, Block};
use touchdown_protocol::controller::{Faults, Outputs, Shown};
use touchdown_protocol::link::{Frame, Refusal};
use touchdown_protocol::wire::Incoming;

use super::chip::{Bus, Chip, NoDelay, flash};
use super::rig::BOOT;

/// All times in ns. A sample, a conversion, and a byte of the line.
pub const PERIOD: u64 = 1_000_000_000 / SAMPLE_RATE_HZ as u64;
pub const CONVERSION: u64 = 1_000_000_000 / CONVERSION_RATE_HZ as u64;
const BYTE: u64 = 86_806;
/// Of each call of the main loop.
const CALL: u64 = 2_000;

pub const ABILITIES: Abilities = Abilities {
    converter: ConverterConfig {
        rate: CONVERSION_RATE_HZ as f32,
        full_scale: 4_095,
    },
    cycles: 8_400.0,
    tachometers: false,
};

pub type Log = DropLog<W25q<Bus, NoDelay>, 5>;

/// The pins.
#[derive(Default)]
pub struct Pins {
    pub outputs: Outputs,
    /// Time of each change.
    pub changes: Vec<(u64, Outputs)>,
    now: u64,
    /// What was told.
    pub events: Vec<Event>,
}

impl Pins {
    fn set(&mut self, outputs: Outputs) {
        if outputs != self.outputs {
            self.changes.push((self.now, outputs));
        }
        self.outputs = outputs;
    }
}

pub struct Desk {
    block: Block,
    pins: Rc<RefCell<Pins>>,
}

impl Board for Desk {
    fn report(&mut self, notice: &Notice) {
        if let Notice::Declared(event) = notice {
            self.pins.borrow_mut().events.push(*event);
        }
    }

    fn drive(&mut self, shown: Shown) {
        self.pins.borrow_mut().set(shown.outputs);
    }

    fn config(&self) -> &[u8] {
        &self.block
    }

    fn feed(&mut self) {}
}

pub struct Machine {
    pub now: u64,
    next_conversion: u64,
    converted: u64,
    /// Samples so far, and those of them that had a tick.
    pub given: u64,
    pub taken: u64,
    /// Of the time, s.
    source: Box<dyn FnMut(f64) -> Sample>,
    /// Time of the tick of each sample taken.
    pub cost: Box<dyn FnMut(u64) -> u64>,
    intake: Intake<'static>,
    pub tick: TickTask<'static, Desk>,
    pub pins: Rc<RefCell<Pins>>,
    /// To the controller, and from it with the time of each byte's end.
    pub line: VecDeque<u8>,
    pub said: Vec<(u64, u8)>,
    next_byte: u64,
    came: VecDeque<u8>,
    out: Outgoing,
    log: Option<Log>,
    pub bus: Bus,
    /// The service input.
    pub service: bool,
}

/// The machine and its main loop.
pub fn started(
    source: impl FnMut(f64) -> Sample + 'static,
    cost: impl FnMut(u64) -> u64 + 'static,
) -> (Machine, MainLoop) {
    let pins = Rc::new(RefCell::new(Pins::default()));
    let desk = Desk {
        block: config_block::encode(&default_settings()),
        pins: Rc::clone(&pins),
    };
    let memory = Box::leak(Box::new(Memory::empty()));
    let settings = default_settings();
    let filled = memory.fill(&settings, &ABILITIES, (Faults::NONE, BOOT), desk);
    let (intake, tick, below) = filled.expect("a valid configuration");
    let (flash, bus) = flash(Chip::new(20));
    let machine = Machine {
        now: 0,
        next_conversion: CONVERSION,
        converted: 0,
        given: 0,
        taken: 0,
        source: Box::new(source),
        cost: Box::new(cost),
        intake,
        tick,
        pins,
        line: VecDeque::new(),
        said: Vec::new(),
        next_byte: BYTE,
        came: VecDeque::new(),
        out: Outgoing::default(),
        log: Log::mount(flash).ok(),
        bus,
        service: true,
    };
    (machine, below)
}

impl Machine {
    /// The main loop works so long, and is interrupted.
    pub fn work(&mut self, mut left: u64) {
        while self.now + left >= self.next_event() {
            left -= self.next_event() - self.now;
            let samples = self.given;
            self.advance_to(self.next_event());
            if self.given > samples {
                self.ticks();
            }
        }
        self.now += left;
    }

    /// The ticks of the samples that wait, one after another, as the sampling interrupt asks for.
    fn ticks(&mut self) {
        while self.tick.step() {
            self.taken += 1;
            let end = self.now + (self.cost)(self.taken);
            while self.next_event() <= end {
                self.advance_to(self.next_event());
            }
            self.now = end;
        }
    }

    fn next_event(&self) -> u64 {
        self.next_conversion.min(self.next_byte)
    }

    /// The sampling interrupt and the line, whatever else goes on.
    fn advance_to(&mut self, time: u64) {
        self.now = self.now.max(time);
        self.pins.borrow_mut().now = time;
        if time == self.next_conversion {
            let sample = (self.source)(time as f64 * 1e-9);
            self.converted += 1;
            self.given = self.converted * CONVERSION / PERIOD;
            self.next_conversion += CONVERSION;
            let arrival = Incoming {
                service: self.service,
                ..sample.into()
            };
            if self.intake.take(arrival, 0) {
                self.pins.borrow_mut().set(Outputs::SAFE);
            }
        }
        if time == self.next_byte {
            self.next_byte += BYTE;
            self.came.extend(self.line.pop_front());
            self.said.extend(self.out.pop().map(|byte| (time, byte)));
        }
    }
}

impl Platform for Machine {
    type Board = Desk;
    type Log = Log;

    fn abilities(&self) -> Abilities {
        ABILITIES
    }

    fn hold<T>(&mut self, act: impl FnOnce(&mut TickTask<'static, Desk>) -> T) -> T {
        self.work(CALL);
        act(&mut self.tick)
    }

    fn receive(&mut self) -> Option<u8> {
        self.work(CALL);
        self.came.pop_front()
    }

    fn send(&mut self, frame: &Frame) -> bool {
        self.out.push(frame)
    }

    fn is_idle(&mut self) -> bool {
        self.out.is_empty()
    }

    fn is_sent(&mut self) -> bool {
        self.out.is_empty()
    }

    fn log(&mut self) -> &mut Option<Log> {
        &mut self.log
    }

    fn store(&mut self, _: &[u8]) -> Result<(), Refusal> {
        Err(Refusal::NoStore)
    }

    fn reset(&mut self) {}
}
