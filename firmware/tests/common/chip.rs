//! A W25Q as its commands show it: a program only clears bits and wraps within its page, an erase
//! takes a sector, either needs the latch of 06h, and a cut of power leaves a torn one.

use std::cell::RefCell;
use std::rc::Rc;

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use touchdown_firmware::w25q::W25q;

const PAGE: usize = 256;
const SECTOR: usize = 4096;

/// How a cut of power leaves the operation that it hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tear {
    /// It never began.
    Before,
    /// A program: its first half. An erase: half of the sector's bits.
    Half,
    /// A program: some of its bits, all over the page. An erase: all over the sector, bits of any
    /// value, as cells between two levels read.
    Random,
    /// A program or erase that lacks a single bit.
    AllButOne,
    /// It was done, and nothing after it.
    After,
}

impl Tear {
    pub const ALL: [Self; 5] = [
        Self::Before,
        Self::Half,
        Self::Random,
        Self::AllButOne,
        Self::After,
    ];
}

/// A program or erase about to happen.
#[derive(Clone, Debug)]
pub enum Change {
    Program(usize, Vec<u8>),
    Erase(usize),
}

/// The memory and what happened to it.
#[derive(Clone)]
pub struct Chip {
    pub bytes: Vec<u8>,
    pub operations: usize,
    /// Sectors erased so far.
    pub erases: usize,
    /// Bits that a program should have set: never right.
    pub set_bits: usize,
    /// The last change, for whoever wants to tear it.
    pub last: Option<Change>,
    before: Vec<u8>,
    enabled: bool,
    /// Times that the status says busy after a change.
    pub busy_for: u32,
    busy: u32,
}

/// xorshift: the same damage every time.
pub fn random(seed: &mut u64) -> u64 {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    *seed
}

impl Chip {
    /// As delivered, of 2^`capacity` bytes.
    pub fn new(capacity: u8) -> Self {
        Self {
            bytes: vec![0xff; 1 << capacity],
            operations: 0,
            erases: 0,
            set_bits: 0,
            last: None,
            before: Vec::new(),
            enabled: false,
            busy_for: 0,
            busy: 0,
        }
    }

    /// The memory if power had been cut in the last change.
    pub fn torn(&self, tear: Tear, seed: u64) -> Self {
        let mut torn = self.clone();
        torn.enabled = false;
        let mut seed = seed | 1;
        let (start, wanted) = match self.last.as_ref().expect("no change yet") {
            Change::Program(start, _) | Change::Erase(start) => (
                *start,
                self.bytes[*start..*start + self.before.len()].to_vec(),
            ),
        };
        let is_erase = matches!(self.last, Some(Change::Erase(_)));
        let length = wanted.len();
        let lacking = (random(&mut seed) as usize % length, random(&mut seed) % 8);
        for (at, (&old, &new)) in self.before.iter().zip(&wanted).enumerate() {
            let noise = random(&mut seed) as u8;
            torn.bytes[start + at] = match tear {
                Tear::Before => old,
                Tear::After => new,
                Tear::Half if is_erase => old | noise,
                Tear::Half if at < length / 2 => new,
                Tear::Half => old,
                Tear::Random if is_erase => noise,
                Tear::Random => new | (old & noise),
                Tear::AllButOne if at == lacking.0 => {
                    let bit = 1 << lacking.1;
                    (new & !bit) | (old & bit)
                }
                Tear::AllButOne => new,
            };
        }
        torn
    }

    /// Whether the last change still goes on.
    pub fn is_busy(&self) -> bool {
        self.busy > 0
    }

    /// What the last change was.
    pub fn last_name(&self) -> (&'static str, usize) {
        match self.last {
            Some(Change::Program(start, _)) => ("program", start),
            Some(Change::Erase(start)) => ("erase", start),
            None => ("nothing", 0),
        }
    }

    /// Whether the last change programmed one of the counters' two sectors, at the beginning.
    pub fn wrote_counters(&self) -> bool {
        matches!(self.last, Some(Change::Program(start, _)) if start < 2 * SECTOR)
    }

    fn change(&mut self, change: Change) {
        assert!(self.enabled, "a change without 06h");
        self.enabled = false;
        self.operations += 1;
        self.busy = self.busy_for;
        match &change {
            Change::Program(start, data) => {
                // More than a page: the last 256 bytes count, as the buffer wraps.
                let page = start - start % PAGE;
                self.before = self.bytes[page..page + PAGE].to_vec();
                for (number, new) in data.iter().enumerate() {
                    let byte = &mut self.bytes[page + (start - page + number) % PAGE];
                    self.set_bits += (!*byte & new).count_ones() as usize;
                    *byte &= new;
                }
                self.last = Some(Change::Program(page, data.clone()));
                return;
            }
            Change::Erase(start) => {
                self.erases += 1;
                self.before = self.bytes[*start..*start + SECTOR].to_vec();
                self.bytes[*start..*start + SECTOR].fill(0xff);
            }
        }
        self.last = Some(change);
    }

    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) {
        let mut sent = Vec::new();
        let mut answered = 0;
        for operation in operations {
            match operation {
                Operation::Write(bytes) => sent.extend_from_slice(bytes),
                Operation::Read(bytes) => {
                    for byte in bytes.iter_mut() {
                        *byte = self.answer(&sent, answered);
                        answered += 1;
                    }
                }
                _ => panic!("the chip is half-duplex"),
            }
        }
        let address = |sent: &[u8]| {
            let [_, high, middle, low, ..] = *sent else {
                panic!("a command without an address")
            };
            usize::from(high) << 16 | usize::from(middle) << 8 | usize::from(low)
        };
        let idle = self.busy == 0;
        match sent[0] {
            0x05 | 0x9f | 0x03 => {}
            _ if !idle => panic!("a command to a busy chip"),
            0x06 => self.enabled = true,
            0x02 => self.change(Change::Program(address(&sent), sent[4..].to_vec())),
            0x20 => self.change(Change::Erase(address(&sent) / SECTOR * SECTOR)),
            other => panic!("unknown command {other:#04x}"),
        }
    }

    fn answer(&mut self, sent: &[u8], number: usize) -> u8 {
        match *sent {
            [0x05] => {
                let busy = self.busy > 0;
                self.busy = self.busy.saturating_sub(1);
                u8::from(busy) | u8::from(self.enabled) << 1
            }
            [0x9f] => {
                let capacity = self.bytes.len().ilog2() as u8;
                [0xef, 0x40, capacity][number % 3]
            }
            [0x03, high, middle, low] => {
                assert_eq!(self.busy, 0, "read while busy");
                let start = u32::from_be_bytes([0, high, middle, low]) as usize;
                self.bytes[(start + number) % self.bytes.len()]
            }
            _ => 0xff,
        }
    }
}

/// The chip on a bus.
#[derive(Clone)]
pub struct Bus(pub Rc<RefCell<Chip>>);

/// A flash driver on a chip.
pub fn flash(chip: Chip) -> (W25q<Bus, NoDelay>, Bus) {
    let bus = Bus(Rc::new(RefCell::new(chip)));
    (W25q::try_new(bus.clone(), NoDelay).unwrap(), bus)
}

impl ErrorType for Bus {
    type Error = ErrorKind;
}

impl SpiDevice for Bus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        self.0.borrow_mut().transaction(operations);
        Ok(())
    }
}

/// Time does not matter to the simulated chip.
pub struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}
