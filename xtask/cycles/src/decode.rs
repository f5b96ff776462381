//! Classes of Thumb-2 instructions that differ in cycles, by the encodings of the ARMv7-M Architecture Reference
//! Manual, A5 and A7. Registers of the floating-point unit are bits of a mask, S0 lowest.

/// What an instruction does, as far as its cycles depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// One cycle.
    #[default]
    Plain,
    /// Folded into the one before.
    IfThen,
    MultiplyAdd,
    Divide,
    /// One word, half or byte.
    Load,
    /// At an address that an immediate offset gives.
    Store,
    /// At one that a register gives, or of the floating-point unit.
    LateStore,
    /// Of so many words.
    Multiple(u8),
    /// By a table in the code.
    TableBranch,
    /// MSR, MRS, CPS and barriers.
    System,
    FpArithmetic,
    FpMultiplyAdd,
    FpDivide,
    /// Between core registers and the unit.
    FpMove,
}

/// An instruction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Instruction {
    pub address: u32,
    pub bytes: u32,
    pub kind: Kind,
    /// Address of the literal that it loads.
    pub literal: Option<u32>,
    /// Reads memory.
    pub loads: bool,
    /// Registers of the unit that it needs as it begins: the addend of a multiplication comes later.
    pub fp_reads: u32,
    /// Likewise, by arithmetic: moves, changes of sign and what loads write are there at once.
    pub fp_writes: u32,
}

/// That at `address`, of these halves.
pub fn decode(address: u32, first: u16, second: u16) -> Instruction {
    let mut it = Instruction {
        address,
        bytes: if first >= 0xe800 { 4 } else { 2 },
        ..Instruction::default()
    };
    match first {
        0..0xe800 => narrow(&mut it, first),
        _ if first & 0xec00 == 0xec00 => floating(&mut it, first, second),
        0xe800..0xf000 => wide_multiple(&mut it, first, second),
        // All else with this bit are branches, and cost what being taken costs.
        0xf000..0xf800 if second & 0x8000 != 0 => {
            if second & 0x5000 == 0 && first & 0x0380 == 0x0380 {
                it.kind = Kind::System;
            }
        }
        0xf000..0xf800 => {}
        _ => wide_single(&mut it, first, second),
    }
    it
}

impl Instruction {
    /// It loads the literal `by` above that address which code here sees as its own, aligned.
    fn load_above(&mut self, by: u32) {
        self.literal = Some(((self.address + 4) & !3).wrapping_add(by));
    }

    /// Of a wide load: a literal where its base is the address of the code, `by` above or below it by the U bit.
    fn load_literal(&mut self, first: u16, by: u32) {
        if first & 0xf == 0xf {
            let up = first & 0x80 != 0;
            self.load_above(if up { by } else { by.wrapping_neg() });
        }
    }
}

fn narrow(it: &mut Instruction, first: u16) {
    let of_list = |list: u16| Kind::Multiple(list.count_ones() as u8);
    (it.kind, it.loads) = match first {
        0x4800..0x5000 => {
            it.load_above(u32::from(first & 0xff) * 4);
            (Kind::Load, true)
        }
        0x5000..0x5600 => (Kind::LateStore, false),
        0x5600..0x6000 => (Kind::Load, true),
        0x6000..0xa000 if first & 0x0800 != 0 => (Kind::Load, true),
        0x6000..0xa000 => (Kind::Store, false),
        0xb400..0xb600 => (of_list(first & 0x1ff), false),
        0xb660..0xb680 => (Kind::System, false),
        0xbc00..0xbe00 => (of_list(first & 0x1ff), true),
        0xbf00..0xc000 if first & 0xf != 0 => (Kind::IfThen, false),
        0xc000..0xd000 => (of_list(first & 0xff), first & 0x0800 != 0),
        _ => (Kind::Plain, false),
    };
}

/// Load and store of several words, table branches; and shifted registers.
fn wide_multiple(it: &mut Instruction, first: u16, second: u16) {
    let bit = |place: u32| first >> place & 1 != 0;
    if first & 0xfe00 != 0xe800 {
        return;
    }
    it.loads = bit(4);
    it.kind = if !bit(6) {
        Kind::Multiple(second.count_ones() as u8)
    } else if first & 0xfff0 == 0xe8d0 && second & 0xffe0 == 0xf000 {
        Kind::TableBranch
    } else if bit(8) || bit(5) {
        if it.loads {
            it.load_literal(first, u32::from(second & 0xff) * 4);
        }
        Kind::Multiple(2)
    } else if it.loads {
        Kind::Load
    } else {
        Kind::Store
    };
}

fn wide_single(it: &mut Instruction, first: u16, second: u16) {
    it.kind = match first {
        _ if first & 0xff90 == 0xf800 && second & 0x0fc0 == 0 => Kind::LateStore,
        _ if first & 0xff10 == 0xf800 => Kind::Store,
        _ if first & 0xfe10 == 0xf810 => {
            it.loads = true;
            it.load_literal(first, u32::from(second & 0xfff));
            Kind::Load
        }
        _ if first & 0xff80 == 0xfb00 && second & 0xf000 != 0xf000 => Kind::MultiplyAdd,
        _ if matches!(first & 0xfff0, 0xfb90 | 0xfbb0) => Kind::Divide,
        _ => Kind::Plain,
    };
}

/// A register of the unit: four bits and one more, which is the lowest of a single and the highest of a double.
fn register(double: bool, four: u16, one: u16, words: u32) -> u32 {
    let (four, one) = (u32::from(four & 0xf), u32::from(one & 1));
    let lowest = if double {
        (one << 4 | four) * 2
    } else {
        four << 1 | one
    };
    let mask = (1_u64 << words.min(32)) - 1;
    (mask << lowest.min(32)) as u32
}

fn floating(it: &mut Instruction, first: u16, second: u16) {
    if !matches!(second >> 8 & 0xf, 10 | 11) {
        return;
    }
    let double = second & 0x0100 != 0;
    let loads = first & 0x10 != 0;
    let words = if double { 2 } else { 1 };
    let at_d = |words| register(double, second >> 12, first >> 6, words);
    let n = register(double, first, second >> 7, words);
    let at_m = |words| register(double, second, second >> 5, words);
    if first & 0xffe0 == 0xec40 {
        it.kind = Kind::FpMove;
        it.fp_reads = if loads { at_m(2) } else { 0 };
    } else if first & 0x0200 == 0 {
        let single = first & 0x0120 == 0x0100;
        let words = if single {
            words
        } else {
            u32::from(second & 0xff)
        };
        it.kind = match (words, loads) {
            (1, true) if single => Kind::Load,
            (1, false) if single => Kind::LateStore,
            _ => Kind::Multiple(words as u8),
        };
        it.loads = loads;
        if loads && single {
            it.load_literal(first, u32::from(second & 0xff) * 4);
        }
        it.fp_reads = if loads { 0 } else { at_d(words) };
    } else if second & 0x10 != 0 {
        // VMOV from or to one core register; VMRS has none of the unit.
        if first & 0x00e0 != 0x00e0 {
            it.kind = Kind::FpMove;
            it.fp_reads = if loads { n } else { 0 };
        }
    } else {
        arithmetic(it, first, second, [at_d(words), n, at_m(words)]);
    }
}

fn arithmetic(it: &mut Instruction, first: u16, second: u16, [d, n, m]: [u32; 3]) {
    (it.kind, it.fp_reads, it.fp_writes) = match first >> 4 & 0xb {
        0 | 1 | 9 | 10 => (Kind::FpMultiplyAdd, n | m, d),
        8 => (Kind::FpDivide, n | m, d),
        11 => match (first & 0xf, second >> 6 & 3) {
            (_, 0 | 2) => (Kind::FpArithmetic, 0, 0),
            (0, _) | (1, 1) => (Kind::FpArithmetic, m, 0),
            (1, 3) => (Kind::FpDivide, m, d),
            (4, _) => (Kind::FpArithmetic, d | m, 0),
            // Compares with zero.
            (5, _) => (Kind::FpArithmetic, d, 0),
            _ => (Kind::FpArithmetic, m, d),
        },
        _ => (Kind::FpArithmetic, n | m, d),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    const AT: u32 = 0x0800_0100;

    /// Encodings as LLVM 14's assembler writes them (`llvm-mc -triple=thumbv7em-none-eabihf -mcpu=cortex-m4`).
    #[test]
    fn encodings_are_of_their_class() {
        for (text, first, second, bytes, kind) in [
            ("adds r0, r1, r2", 0x1888, 0, 2, Kind::Plain),
            ("ldr r0, [pc, #4]", 0x4801, 0, 2, Kind::Load),
            ("str r0, [r1, r2]", 0x5088, 0, 2, Kind::LateStore),
            ("str r0, [r1, #4]", 0x6048, 0, 2, Kind::Store),
            ("str.w r0, [r1, r2]", 0xf841, 0x0002, 4, Kind::LateStore),
            ("str r0, [r1], #4", 0xf841, 0x0b04, 4, Kind::Store),
            ("vstr s0, [r1]", 0xed81, 0x0a00, 4, Kind::LateStore),
            ("vmov r0, s3", 0xee11, 0x0a90, 4, Kind::FpMove),
            ("ldrh r0, [r1, r2]", 0x5a88, 0, 2, Kind::Load),
            ("ldr r0, [sp, #4]", 0x9801, 0, 2, Kind::Load),
            ("push {r4, r5, lr}", 0xb530, 0, 2, Kind::Multiple(3)),
            ("pop {r4, r5, pc}", 0xbd30, 0, 2, Kind::Multiple(3)),
            ("it eq", 0xbf08, 0, 2, Kind::IfThen),
            ("nop", 0xbf00, 0, 2, Kind::Plain),
            ("cpsid i", 0xb672, 0, 2, Kind::System),
            ("bx lr", 0x4770, 0, 2, Kind::Plain),
            ("push.w {r4-r11, lr}", 0xe92d, 0x4ff0, 4, Kind::Multiple(9)),
            ("ldrd r0, r1, [r2]", 0xe9d2, 0x0100, 4, Kind::Multiple(2)),
            ("tbb [pc, r0]", 0xe8df, 0xf000, 4, Kind::TableBranch),
            ("add.w r0, r1, r2, lsl #2", 0xeb01, 0x0082, 4, Kind::Plain),
            ("movw r0, #1", 0xf240, 0x0001, 4, Kind::Plain),
            ("bl #0", 0xf000, 0xf800, 4, Kind::Plain),
            ("dsb", 0xf3bf, 0x8f4f, 4, Kind::System),
            ("str.w r0, [r1, #4]", 0xf8c1, 0x0004, 4, Kind::Store),
            ("ldr.w r0, [r1, #4]", 0xf8d1, 0x0004, 4, Kind::Load),
            ("mla r0, r1, r2, r3", 0xfb01, 0x3002, 4, Kind::MultiplyAdd),
            ("mul r0, r1, r2", 0xfb01, 0xf002, 4, Kind::Plain),
            ("udiv r0, r1, r2", 0xfbb1, 0xf0f2, 4, Kind::Divide),
            ("sdiv r0, r1, r2", 0xfb91, 0xf0f2, 4, Kind::Divide),
            ("umull r0, r1, r2, r3", 0xfba2, 0x0103, 4, Kind::Plain),
            ("vadd.f32 s0, s1, s2", 0xee30, 0x0a81, 4, Kind::FpArithmetic),
            (
                "vmla.f32 s0, s1, s2",
                0xee00,
                0x0a81,
                4,
                Kind::FpMultiplyAdd,
            ),
            (
                "vfma.f32 s0, s1, s2",
                0xeea0,
                0x0a81,
                4,
                Kind::FpMultiplyAdd,
            ),
            ("vdiv.f32 s0, s1, s2", 0xee80, 0x0a81, 4, Kind::FpDivide),
            ("vsqrt.f32 s0, s1", 0xeeb1, 0x0ae0, 4, Kind::FpDivide),
            ("vmrs APSR_nzcv, fpscr", 0xeef1, 0xfa10, 4, Kind::Plain),
            ("vldr s0, [r1]", 0xed91, 0x0a00, 4, Kind::Load),
            ("vldr d0, [r1]", 0xed91, 0x0b00, 4, Kind::Multiple(2)),
            ("vpush {d8, d9}", 0xed2d, 0x8b04, 4, Kind::Multiple(4)),
            ("vmov r0, r1, d0", 0xec51, 0x0b10, 4, Kind::FpMove),
        ] {
            let it = decode(AT, first, second);
            assert_eq!((it.bytes, it.kind), (bytes, kind), "{text}");
        }
    }

    #[test]
    fn literals_are_where_the_manual_says() {
        let literal = |first, second| decode(AT + 2, first, second).literal;
        assert_eq!(literal(0x4801, 0), Some(AT + 4 + 4));
        assert_eq!(literal(0xf8df, 0x0008), Some(AT + 4 + 8));
        assert_eq!(literal(0xf85f, 0x0008), Some(AT + 4 - 8));
        assert_eq!(literal(0xed9f, 0x0a02), Some(AT + 4 + 8));
        assert_eq!(literal(0xf8d1, 0x0004), None);
    }

    #[test]
    fn registers_of_the_unit_are_told() {
        // vadd.f32 s0, s1, s2; vmla.f32 s0, s1, s2; vcmp.f32 s0, s1; vcmp.f32 s2, #0; vmov r0, s3; vpush {d8}; vneg.f32 s0, s1.
        let of = |first, second| {
            let it = decode(AT, first, second);
            (it.fp_reads, it.fp_writes)
        };
        assert_eq!(of(0xee30, 0x0a81), (0b110, 0b1));
        assert_eq!(of(0xee00, 0x0a81), (0b110, 0b1));
        assert_eq!(of(0xeeb4, 0x0a60), (0b11, 0));
        assert_eq!(of(0xeeb5, 0x1a40), (0b100, 0));
        assert_eq!(of(0xee11, 0x0a90), (0b1000, 0));
        assert_eq!(of(0xed2d, 0x8b02), (0b11 << 16, 0));
        assert_eq!(of(0xeeb1, 0x0a60), (0b10, 0));
    }
}
