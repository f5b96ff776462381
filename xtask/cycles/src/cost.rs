//! Cycles of a sequence of instructions: Cortex-M4 Technical Reference Manual (DDI 0439), 3.3 and 7.2.3.

use crate::decode::{Instruction, Kind};
use crate::flash::{Flash, WAIT_STATES, line};

/// Refills of the pipeline by a branch: one to three cycles.
const REFILL: Cycles = Cycles::new(1, 2, 3);
/// A literal at the most: two lines of flash, after one of code.
const LITERAL_MOST: u64 = 10;

/// At the least, as modelled, at the most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cycles {
    pub lower: u64,
    pub modelled: u64,
    pub upper: u64,
}

impl Cycles {
    const fn new(lower: u64, modelled: u64, upper: u64) -> Self {
        Self {
            lower,
            modelled,
            upper,
        }
    }

    const fn exactly(cycles: u64) -> Self {
        Self::new(cycles, cycles, cycles)
    }

    fn add(&mut self, other: Self) {
        self.lower += other.lower;
        self.modelled += other.modelled;
        self.upper += other.upper;
    }
}

/// Without wait states, branches and what lies before and after.
fn alone(kind: Kind) -> Cycles {
    match kind {
        Kind::Plain | Kind::FpArithmetic => Cycles::exactly(1),
        Kind::IfThen => Cycles::new(0, 0, 1),
        Kind::MultiplyAdd => Cycles::new(1, 2, 2),
        Kind::Divide => Cycles::new(2, 12, 12),
        Kind::Load | Kind::TableBranch | Kind::FpPair => Cycles::exactly(2),
        Kind::Store => Cycles::new(1, 1, 2),
        Kind::Multiple(words) => Cycles::exactly(1 + u64::from(words)),
        Kind::System => Cycles::new(1, 2, 4),
        Kind::FpMultiplyAdd => Cycles::exactly(3),
        Kind::FpDivide => Cycles::exactly(14),
    }
}

/// A stretch of instructions, as they are run. An instruction that its condition skips counts as one that runs.
pub struct Stretch {
    pub instructions: u32,
    pub cycles: Cycles,
    flash: Flash,
    last: Option<Instruction>,
}

impl Stretch {
    /// Begins with nothing in the flash's caches: the work below the tick has run through them.
    pub fn new() -> Self {
        Self {
            instructions: 0,
            cycles: Cycles::default(),
            flash: Flash::cold(),
            last: None,
        }
    }

    /// The next instruction that is run.
    pub fn run(&mut self, it: &Instruction) {
        self.instructions += 1;
        let last = self.last.replace(*it);
        let follows = last.is_some_and(|last| last.address + last.bytes == it.address);
        if last.is_some() && !follows {
            self.cycles.add(REFILL);
        }
        self.fetch(it, last.filter(|_| follows));
        let mut cost = alone(it.kind);
        if let Some(last) = last {
            let single = |kind| matches!(kind, Kind::Load | Kind::Store);
            if single(last.kind) && single(it.kind) {
                (cost.lower, cost.modelled) = (1, 1);
            }
            if last.fp_writes & it.fp_reads != 0 {
                cost.modelled += 1;
                cost.upper += 1;
            }
        }
        self.cycles.add(cost);
        if let Some(literal) = it.literal {
            self.read(literal);
        }
    }

    /// The last instruction has read a datum in flash at this address.
    pub fn read(&mut self, address: u32) {
        self.cycles.modelled += self.flash.wait_for_data(line(address));
        self.cycles.upper += LITERAL_MOST;
    }

    fn fetch(&mut self, it: &Instruction, before: Option<Instruction>) {
        let (first, last) = (line(it.address), line(it.address + it.bytes - 1));
        let now = self.cycles.modelled;
        let wait = self.flash.wait_for_code(first, now);
        self.cycles.modelled += wait;
        // At the most each line waits anew, and so does the target of each branch.
        if before.is_none_or(|it| line(it.address + it.bytes - 1) != first) {
            self.cycles.upper += WAIT_STATES;
        }
        if last != first {
            let now = self.cycles.modelled;
            self.cycles.modelled += self.flash.wait_for_code(last, now);
            self.cycles.upper += WAIT_STATES;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FLASH;
    use crate::decode::decode;

    /// Of instructions at those places from the beginning of the flash.
    fn cycles(code: &[(u32, u16, u16)]) -> [u64; 3] {
        let mut stretch = Stretch::new();
        for &(at, first, second) in code {
            stretch.run(&decode(FLASH + at, first, second));
        }
        let Cycles {
            lower,
            modelled,
            upper,
        } = stretch.cycles;
        [lower, modelled, upper]
    }

    const ADDS: u16 = 0x1888;

    #[test]
    fn a_line_waits_once_and_plain_instructions_take_one() {
        assert_eq!(cycles(&[(0, ADDS, 0), (2, ADDS, 0)]), [2, 7, 7]);
    }

    #[test]
    fn a_taken_branch_refills_and_fetches_its_target() {
        // b .+4 to 4, in the same line: 2 cycles as modelled, at the most 3 and the line.
        assert_eq!(cycles(&[(0, 0xe000, 0), (4, ADDS, 0)]), [3, 9, 15]);
        // To another line.
        assert_eq!(cycles(&[(0, 0xe000, 0), (64, ADDS, 0)]), [3, 14, 15]);
    }

    #[test]
    fn a_load_after_a_load_is_hidden() {
        // ldr r0, [r1]; ldr r2, [r3].
        assert_eq!(cycles(&[(0, 0x6808, 0), (2, 0x681a, 0)]), [3, 8, 9]);
    }

    #[test]
    fn an_fp_result_used_at_once_waits() {
        // vadd s0, s1, s2; vadd s3, s0, s2: against vadd s3, s4, s2.
        let add = (0, 0xee30, 0x0a81);
        assert_eq!(cycles(&[add, (4, 0xee70, 0x1a01)]), [2, 8, 8]);
        assert_eq!(cycles(&[add, (4, 0xee72, 0x1a01)]), [2, 7, 7]);
        // vdiv s0, s1, s2.
        assert_eq!(cycles(&[(0, 0xee80, 0x0a81)]), [14, 19, 19]);
    }

    #[test]
    fn a_literal_waits_for_its_line() {
        assert_eq!(cycles(&[(0, 0x4810, 0)]), [2, 12, 17]);
        assert_eq!(cycles(&[(0, 0x4810, 0), (2, 0x4910, 0)]), [3, 13, 29]);
    }

    #[test]
    fn an_instruction_across_lines_waits_for_both() {
        // movw at 14: the second line is read ahead only since the first is there.
        assert_eq!(cycles(&[(14, 0xf240, 1)]), [1, 11, 11]);
    }

    #[test]
    fn an_expensive_loop_is_seen_as_more_cycles() {
        let turn = |body: (u16, u16)| [(0, body.0, body.1), (4, 0xe7fc, 0)];
        let loops = |body| cycles(&turn(body).repeat(100));
        let (cheap, dear) = (loops((0xee30, 0x0a81)), loops((0xee80, 0x0a81)));
        assert_eq!([0, 1, 2].map(|k| dear[k] - cheap[k]), [1_300; 3]);
    }
}
