//! Cycles of a sequence of instructions. What each is taken from, and what could not be checked: `docs/build/timing.md`.

use std::mem;

use crate::decode::{Instruction, Kind};
use crate::flash::{Flash, WAIT_STATES, line};

/// Refills of the pipeline by a branch: one to three cycles.
const REFILL: Cycles = Cycles::new(1, 2, 3);
/// A literal at the most: its line of flash after one of code, and the bus that fetches code.
const LITERAL_MOST: u64 = 2 * WAIT_STATES + 1;

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
        Kind::IfThen => Cycles::new(0, 1, 1),
        Kind::MultiplyAdd => Cycles::new(1, 1, 2),
        Kind::Divide => Cycles::new(2, 12, 12),
        // At the most one more where the address is what the instruction before computed.
        Kind::Load => Cycles::new(2, 2, 3),
        Kind::Store => Cycles::new(1, 1, 3),
        Kind::LateStore => Cycles::new(1, 2, 3),
        Kind::Multiple(words) => {
            let words = u64::from(words);
            Cycles::new(1 + words, 1 + words, 2 + words)
        }
        Kind::TableBranch => Cycles::new(2, 3, 3),
        Kind::FpMove => Cycles::exactly(2),
        Kind::System => Cycles::new(1, 2, 4),
        Kind::FpMultiplyAdd => Cycles::exactly(3),
        // Instructions of the core alone may run meanwhile: at the least all of them do.
        Kind::FpDivide => Cycles::new(1, 14, 14),
    }
}

/// Without wait states and the refill of a branch, after the instruction that ran before.
fn cost(it: &Instruction, last: Option<&Instruction>) -> Cycles {
    let mut cost = alone(it.kind);
    let Some(last) = last else { return cost };
    let store = |kind| matches!(kind, Kind::Store | Kind::LateStore);
    if it.kind == Kind::Load || store(it.kind) {
        match last.kind {
            Kind::Load => (cost.lower, cost.modelled) = (1, 1),
            kind if store(kind) => cost.lower = 1,
            _ => {}
        }
    }
    if it.kind == Kind::IfThen && last.bytes == 2 {
        cost.modelled = 0;
    }
    if last.fp_writes & it.fp_reads != 0 {
        cost.modelled += 1;
        cost.upper += 1;
    }
    cost
}

/// Lines of an instruction, the last one if it is another.
fn lines(it: &Instruction) -> (u32, Option<u32>) {
    let (first, last) = (line(it.address), line(it.address + it.bytes - 1));
    (first, (last != first).then_some(last))
}

/// What the flash is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Nothing,
    Code(u32),
    Data(u32),
}

/// Gives `take` what an instruction costs after the one that ran before: cycles that are known before it runs, and what is
/// asked after them.
fn each_part(it: &Instruction, last: Option<&Instruction>, mut take: impl FnMut(Cycles, Asked)) {
    let follows = |last: &&Instruction| last.address + last.bytes == it.address;
    let before = last.filter(follows);
    let mut known = match (last, before) {
        (Some(_), None) => REFILL,
        _ => Cycles::default(),
    };
    let (first, next) = lines(it);
    // At the most each line waits anew, and so does the target of each branch.
    let is_new = before.is_none_or(|it| line(it.address + it.bytes - 1) != first);
    for line in is_new.then_some(first).into_iter().chain(next) {
        known.upper += WAIT_STATES;
        take(mem::take(&mut known), Asked::Code(line));
    }
    known.add(cost(it, last));
    let literal = it.literal.map(line);
    known.upper += literal.map_or(0, |_| LITERAL_MOST);
    take(known, literal.map_or(Asked::Nothing, Asked::Data));
}

/// What is known of some instructions before they run, and what follows them.
#[derive(Clone, Copy, Debug)]
struct KnownStep {
    /// Address of the instruction that ends it.
    end: u32,
    instructions: u32,
    cycles: Cycles,
    then: Asked,
}

/// Instructions in a row: only its first is jumped to, and only its last may jump.
pub struct Block {
    first: Instruction,
    last: Instruction,
    /// Of all but the first.
    steps: Vec<KnownStep>,
}

impl Block {
    /// Nothing of no instructions.
    pub fn of(code: &[Instruction]) -> Option<Self> {
        let (&first, &last) = code.first().zip(code.last())?;
        let mut steps = vec![];
        let (mut instructions, mut cycles) = (0, Cycles::default());
        for pair in code.windows(2) {
            let [before, it] = pair else { continue };
            instructions += 1;
            each_part(it, Some(before), |known, then| {
                cycles.add(known);
                if it.loads || then != Asked::Nothing {
                    steps.push(KnownStep {
                        end: it.address,
                        instructions: mem::take(&mut instructions),
                        cycles: mem::take(&mut cycles),
                        then,
                    });
                }
            });
        }
        steps.push(KnownStep {
            end: last.address,
            instructions,
            cycles,
            then: Asked::Nothing,
        });
        Some(Self { first, last, steps })
    }
}

/// A stretch of instructions, as they are run. An instruction that its condition skips counts as one that runs.
pub struct Stretch<'a> {
    pub instructions: u32,
    pub cycles: Cycles,
    flash: Flash,
    last: Option<&'a Instruction>,
    /// Of the block that runs.
    rest: &'a [KnownStep],
}

impl<'a> Stretch<'a> {
    pub fn new() -> Self {
        Self {
            instructions: 0,
            cycles: Cycles::default(),
            flash: Flash::cold(),
            last: None,
            rest: &[],
        }
    }

    /// Begins anew, with nothing in the flash's caches: the work below the tick has run through them.
    pub fn begin(&mut self) {
        (self.instructions, self.cycles) = (0, Cycles::default());
        (self.last, self.rest) = (None, &[]);
        self.flash.forget();
    }

    /// A block begins to run; the one before has run to its end.
    pub fn enter(&mut self, block: &'a Block) {
        self.run_to(u32::MAX);
        self.run(&block.first);
        (self.last, self.rest) = (Some(&block.last), &block.steps);
    }

    /// The block has run so far that the instruction at `address` is done.
    pub fn run_to(&mut self, address: u32) {
        while let Some((step, rest)) = self.rest.split_first()
            && step.end <= address
        {
            self.instructions += step.instructions;
            self.take(step.cycles, step.then);
            self.rest = rest;
        }
    }

    /// The instruction at which a block begins.
    fn run(&mut self, it: &'a Instruction) {
        self.instructions += 1;
        let last = self.last.replace(it);
        each_part(it, last, |known, then| self.take(known, then));
    }

    fn take(&mut self, known: Cycles, then: Asked) {
        self.cycles.add(known);
        self.cycles.modelled += match then {
            Asked::Nothing => 0,
            Asked::Code(line) => self.flash.wait_for_code(line, self.cycles.modelled),
            Asked::Data(line) => self.flash.wait_for_data(line),
        };
    }

    /// The last instruction has read a datum in flash at this address.
    #[cfg(not(test))]
    pub fn read(&mut self, address: u32) {
        self.cycles.modelled += self.flash.wait_for_data(line(address));
        self.cycles.upper += LITERAL_MOST;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FLASH;
    use crate::decode::decode;

    /// Of instructions at those places from the beginning of the flash.
    fn cycles(code: &[(u32, u16, u16)]) -> [u64; 3] {
        let code = code.iter();
        let code: Vec<_> = code.map(|it| decode(FLASH + it.0, it.1, it.2)).collect();
        let mut stretch = Stretch::new();
        code.iter().for_each(|it| stretch.run(it));
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
        assert_eq!(cycles(&[(0, 0x6808, 0), (2, 0x681a, 0)]), [3, 8, 11]);
        // str r0, [r1, #4] before, and str r0, [r1, r2] after a load.
        assert_eq!(cycles(&[(0, 0x6048, 0), (2, 0x681a, 0)]), [2, 8, 11]);
        assert_eq!(cycles(&[(0, 0x6808, 0), (2, 0x5088, 0)]), [3, 8, 11]);
    }

    #[test]
    fn an_fp_result_used_at_once_waits() {
        // vadd s0, s1, s2; vadd s3, s0, s2: against vadd s3, s4, s2.
        let add = (0, 0xee30, 0x0a81);
        assert_eq!(cycles(&[add, (4, 0xee70, 0x1a01)]), [2, 8, 8]);
        assert_eq!(cycles(&[add, (4, 0xee72, 0x1a01)]), [2, 7, 7]);
        // vdiv s0, s1, s2.
        assert_eq!(cycles(&[(0, 0xee80, 0x0a81)]), [1, 19, 19]);
    }

    #[test]
    fn a_literal_waits_for_its_line() {
        assert_eq!(cycles(&[(0, 0x4810, 0)]), [2, 12, 19]);
        assert_eq!(cycles(&[(0, 0x4810, 0), (2, 0x4910, 0)]), [3, 13, 33]);
    }

    #[test]
    fn loads_of_several_words_and_table_branches_cost_what_the_manual_says() {
        // ldmia r0!, {r1-r3}; push {r4, r5, lr}; tbb [pc, r0], and its target.
        assert_eq!(cycles(&[(0, 0xc80e, 0)]), [4, 9, 10]);
        assert_eq!(cycles(&[(0, 0xb530, 0)]), [4, 9, 10]);
        assert_eq!(cycles(&[(0, 0xe8df, 0xf000), (8, ADDS, 0)]), [4, 11, 17]);
    }

    #[test]
    fn it_is_folded_onto_a_narrow_instruction() {
        assert_eq!(cycles(&[(0, ADDS, 0), (2, 0xbf08, 0)]), [1, 6, 7]);
        assert_eq!(cycles(&[(0, 0xf240, 1), (4, 0xbf08, 0)]), [1, 7, 7]);
    }

    #[test]
    fn an_instruction_across_lines_waits_for_both() {
        // movw at 14: the second line is read ahead only since the first is there.
        assert_eq!(cycles(&[(14, 0xf240, 1)]), [1, 11, 11]);
    }

    #[test]
    fn a_block_takes_what_its_instructions_take_one_by_one() {
        // Loads, literals, floats and wide instructions across lines, 40 times over.
        let halves = [
            0x6808, 0x681a, 0x4810, 0xee30, 0x0a81, 0xee70, 0x1a01, 0x1888, 0xf240, 0x0001, 0xbd30,
        ];
        let halves: Vec<u16> = halves.into_iter().cycle().take(440).collect();
        let (mut code, mut at) = (vec![], 0);
        while let [first, rest @ ..] = &halves[at..] {
            let it = decode(FLASH + 2 * at as u32, *first, *rest.first().unwrap_or(&0));
            at += it.bytes as usize / 2;
            code.push(it);
        }
        let (mut one_by_one, mut whole, mut in_parts) =
            (Stretch::new(), Stretch::new(), Stretch::new());
        code.iter().for_each(|it| one_by_one.run(it));
        let block = Block::of(&code).unwrap();
        whole.enter(&block);
        whole.run_to(u32::MAX);
        assert_eq!(whole.cycles, one_by_one.cycles);
        assert_eq!(whole.instructions as usize, code.len());
        // Nothing is left of what ran before.
        in_parts.enter(&block);
        in_parts.begin();
        in_parts.enter(&block);
        for (k, it) in code.iter().enumerate().filter(|(_, it)| it.loads) {
            in_parts.run_to(it.address);
            assert_eq!(in_parts.instructions as usize, k + 1);
        }
        in_parts.run_to(u32::MAX);
        assert_eq!(in_parts.cycles, one_by_one.cycles);
    }

    #[test]
    fn an_expensive_loop_is_seen_as_more_cycles() {
        let turn = |body: (u16, u16)| [(0, body.0, body.1), (4, 0xe7fc, 0)];
        let loops = |body| cycles(&turn(body).repeat(100));
        let (cheap, dear) = (loops((0xee30, 0x0a81)), loops((0xee80, 0x0a81)));
        assert_eq!([0, 1, 2].map(|k| dear[k] - cheap[k]), [0, 1_300, 1_300]);
    }
}
