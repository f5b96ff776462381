//! Who calls whom in Thumb-2 code, and the deepest chain.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, ensure};

/// A function of the image.
#[derive(Clone, Debug)]
pub struct Function {
    pub name: String,
    pub address: u64,
    pub size: u64,
    /// Stack that it takes itself, bytes, where the compiler told.
    pub frame: Option<u64>,
    /// Addresses that it calls.
    calls: BTreeSet<u64>,
    /// Whether it calls through a pointer.
    through_pointer: bool,
}

/// Who calls whom, by address.
#[derive(Clone, Debug)]
pub struct Graph(BTreeMap<u64, Function>);

/// The deepest chain from a function.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Deepest {
    pub bytes: u64,
    /// Frame and name, from the outermost.
    pub chain: Vec<String>,
    /// Functions that can be called and have no stated frame: what they take is not in it.
    pub frameless: BTreeSet<String>,
    /// Functions that can be called and call through a pointer: likewise.
    pub pointers: BTreeSet<String>,
}

/// A branch out of line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Branch {
    To(u64),
    ThroughPointer,
}

impl Function {
    /// Without its calls yet.
    pub fn new(name: String, address: u64, size: u64, frame: Option<u64>) -> Self {
        Self {
            name,
            address,
            size,
            frame,
            calls: BTreeSet::new(),
            through_pointer: false,
        }
    }
}

impl Graph {
    /// Of code that begins at `base`. From each address of `is_code` on there is code, or data.
    pub fn new(
        base: u64,
        code: &[u8],
        is_code: &BTreeMap<u64, bool>,
        functions: Vec<Function>,
    ) -> Self {
        let is_code =
            |address: u64| (is_code.range(..=address).next_back()).is_some_and(|it| *it.1);
        let half = |address: u64| {
            let at = address.checked_sub(base)? as usize;
            let bytes = code.get(at..at + 2)?;
            Some(u16::from_le_bytes([bytes[0], bytes[1]]))
        };
        let with_calls = functions.into_iter().map(|mut function| {
            let own = function.address..function.address + function.size;
            let mut at = own.start;
            while at < own.end {
                let Some(first) = half(at) else { break };
                let second = half(at + 2).filter(|_| first >= 0xe800);
                match branch(at, first, second) {
                    _ if !is_code(at) => {}
                    Some(Branch::To(to)) if !own.contains(&to) => _ = function.calls.insert(to),
                    Some(Branch::ThroughPointer) => function.through_pointer = true,
                    _ => {}
                }
                at += if first >= 0xe800 && is_code(at) { 4 } else { 2 };
            }
            (own.start, function)
        });
        Self(with_calls.collect())
    }

    /// Whether the compiler told what stack they take.
    pub fn knows_frames(&self) -> bool {
        self.0.values().any(|it| it.frame.is_some())
    }

    /// Functions that call one of such a name, and have none themselves.
    pub fn callers(&self, is_such: impl Fn(&str) -> bool) -> BTreeSet<&str> {
        let is_such_at = |address: &u64| self.0.get(address).is_some_and(|it| is_such(&it.name));
        let callers = (self.0.values()).filter(|it| it.calls.iter().any(is_such_at));
        let names = callers.map(|it| &*it.name);
        names.filter(|it| !is_such(it)).collect()
    }

    /// From the function of this name.
    pub fn deepest(&self, name: &str) -> anyhow::Result<Deepest> {
        let start = self.0.values().find(|it| it.name == name);
        let start = start.with_context(|| format!("the image has no {name}"))?;
        self.below(start.address, &mut vec![], &mut BTreeMap::new())
    }

    fn below(
        &self,
        address: u64,
        path: &mut Vec<u64>,
        known: &mut BTreeMap<u64, Deepest>,
    ) -> anyhow::Result<Deepest> {
        if let Some(deepest) = known.get(&address) {
            return Ok(deepest.clone());
        }
        let mut deepest = Deepest::default();
        let Some(function) = self.0.get(&address) else {
            deepest.frameless.insert(format!("{address:#x}"));
            return Ok(deepest);
        };
        let name = &function.name;
        ensure!(!path.contains(&address), "{name} calls itself: no bound");
        path.push(address);
        for &callee in &function.calls {
            let below = self.below(callee, path, known)?;
            deepest.frameless.extend(below.frameless);
            deepest.pointers.extend(below.pointers);
            if below.bytes >= deepest.bytes {
                (deepest.bytes, deepest.chain) = (below.bytes, below.chain);
            }
        }
        path.pop();
        if function.through_pointer {
            deepest.pointers.insert(name.clone());
        }
        if function.frame.is_none() {
            deepest.frameless.insert(name.clone());
        }
        let frame = function.frame.unwrap_or(0);
        deepest.bytes += frame;
        deepest.chain.insert(0, format!("{frame:5} {name}"));
        known.insert(address, deepest.clone());
        Ok(deepest)
    }
}

/// The branch that an instruction is: ARMv7-M Architecture Reference Manual, A7.7.12 (B), A7.7.18 (BL),
/// A7.7.19 (BLX), A7.7.20 (BX).
fn branch(at: u64, first: u16, second: Option<u16>) -> Option<Branch> {
    let to = |offset: i64| Some(Branch::To(at.wrapping_add_signed(offset + 4)));
    let Some(second) = second else {
        // BLX or BX by a register other than the return address.
        let by_register = first & 0xff07 == 0x4700 && first & 0x0078 != 0x0070;
        if by_register {
            return Some(Branch::ThroughPointer);
        }
        if first & 0xf800 == 0xe000 {
            return to(i64::from((first << 5) as i16 >> 4));
        }
        let conditional = first & 0xf000 == 0xd000 && first & 0x0e00 != 0x0e00;
        return conditional
            .then(|| to(i64::from(first as u8 as i8) * 2))
            .flatten();
    };
    if first & 0xf800 != 0xf000 || second & 0x8000 == 0 {
        return None;
    }
    let bit = |half: u16, place: u32| i64::from(half >> place & 1);
    let sign = bit(first, 10);
    let (j1, j2) = (bit(second, 13), bit(second, 11));
    let low = i64::from(second & 0x7ff) << 1;
    if second & 0x1000 != 0 {
        let (i1, i2) = (1 ^ j1 ^ sign, 1 ^ j2 ^ sign);
        let high = i64::from(first & 0x3ff) << 12;
        return to((-sign << 24) | i1 << 23 | i2 << 22 | high | low);
    }
    // With a condition; other codes there are no branches.
    if second & 0x4000 == 0 && first & 0x0380 != 0x0380 {
        let high = i64::from(first & 0x3f) << 12;
        return to((-sign << 20) | j2 << 19 | j1 << 18 | high | low);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn function(name: &str, address: u64, size: u64, frame: Option<u64>) -> Function {
        Function::new(name.into(), address, size, frame)
    }

    #[test]
    fn branches_go_where_the_manual_says() {
        // Encodings from an assembler: bl .+0x100, b.w .-0x20, b .-4, beq .+8, blx r3, bx lr.
        let to = |at, first, second| branch(at, first, second);
        assert_eq!(to(0x1000, 0xf000, Some(0xf87e)), Some(Branch::To(0x1100)));
        assert_eq!(to(0x1000, 0xf7ff, Some(0xbfee)), Some(Branch::To(0x0fe0)));
        assert_eq!(to(0x1000, 0xe7fc, None), Some(Branch::To(0x0ffc)));
        assert_eq!(to(0x1000, 0xd002, None), Some(Branch::To(0x1008)));
        assert_eq!(to(0x1000, 0x4798, None), Some(Branch::ThroughPointer));
        assert_eq!(to(0x1000, 0x4770, None), None);
    }

    #[test]
    fn frames_of_the_deepest_chain_add_up() {
        // At 0: bl 0x10; at 4: bl 0x20; bx lr. At 0x10 and 0x20: bx lr.
        let mut code = vec![0; 0x22];
        code[..10].copy_from_slice(&[0, 0xf0, 6, 0xf8, 0, 0xf0, 0x0c, 0xf8, 0x70, 0x47]);
        code[0x10..0x12].copy_from_slice(&[0x70, 0x47]);
        code[0x20..0x22].copy_from_slice(&[0x70, 0x47]);
        let code_only = BTreeMap::from([(0, true)]);
        let functions = vec![
            function("main", 0, 10, Some(8)),
            function("a", 0x10, 2, Some(100)),
            function("b", 0x20, 2, None),
        ];
        let graph = Graph::new(0, &code, &code_only, functions);
        let deepest = graph.deepest("main").unwrap();
        assert_eq!(deepest.bytes, 108);
        assert!(deepest.frameless.iter().eq(["b"]));
        assert!(graph.deepest("none").is_err());
    }

    #[test]
    fn recursion_has_no_bound() {
        // At 0: bl 4. At 4: bl 0.
        let code = [0, 0xf0, 0, 0xf8, 0xff, 0xf7, 0xfc, 0xff];
        let code_only = BTreeMap::from([(0, true)]);
        let functions = vec![function("a", 0, 4, Some(8)), function("b", 4, 4, Some(8))];
        let graph = Graph::new(0, &code, &code_only, functions);
        assert!(
            graph
                .deepest("a")
                .unwrap_err()
                .to_string()
                .contains("no bound")
        );
    }
}
