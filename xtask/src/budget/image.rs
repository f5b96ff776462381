//! What an image's symbols and code say: what the tick can reach, and the stack.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use addr2line::gimli::{EndianSlice, LittleEndian, Reader};
use anyhow::{Context, ensure};
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};

use super::calls::{self, Function, Graph};
use crate::files;

/// Names of what a panic needs.
const PANICS: [&str; 2] = ["rust_begin_unwind", "panicking"];
/// Where the core puts registers before an interrupt, with those of the floating-point unit: 26 words and one to
/// align them (ARMv7-M Architecture Reference Manual, B1.5.6 and B1.5.7).
const EXCEPTION_FRAME: u64 = 4 * 27;

/// What can be reached in an image that has the tick and nothing else.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reached {
    /// Functions that call those of a panic.
    pub panics: Vec<String>,
    /// Functions for f64.
    pub soft_float: Vec<String>,
}

/// Reads the symbols of the image.
pub fn look(image: &Path) -> anyhow::Result<Reached> {
    let elf = files::bytes(image)?;
    let file = object::File::parse(&*elf)?;
    let mut found = Reached::default();
    let (mut functions, mut has_panic) = (0, false);
    for symbol in file.symbols().filter(|it| it.kind() == SymbolKind::Text) {
        let name = symbol.name()?;
        functions += 1;
        if is_soft_float(name) {
            found.soft_float.push(name.to_owned());
        }
        has_panic |= is_panic(name);
    }
    // A stripped image would pass whatever is in it.
    ensure!(functions > 0, "the image has no symbols");
    if has_panic {
        let graph = graph(&elf)?;
        let callers = graph.callers(is_panic).into_iter();
        found.panics = callers.map(str::to_owned).collect();
        ensure!(!found.panics.is_empty(), "a panic that nobody calls");
    }
    Ok(found)
}

fn is_panic(name: &str) -> bool {
    PANICS.iter().any(|it| name.contains(it))
}

/// Whether it computes in f64: Run-time ABI for the Arm Architecture, tables 2 to 8, and GCC's names.
fn is_soft_float(name: &str) -> bool {
    let name = name.rsplit("::").next().unwrap_or(name);
    let arm = name.strip_prefix("__aeabi_");
    let of_f64 = |it: &str| it.starts_with('d') || it.ends_with("2d") || it.starts_with("cd");
    // A division of integers by zero.
    arm.is_some_and(|it| of_f64(it) && !it.contains("div0"))
        || (name.starts_with("__") && name.contains("df"))
}

/// Stack of an image, in bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stack {
    main: u64,
    /// Of the tick, and of sampling on top of it.
    interrupts: [u64; 2],
    /// Functions called through a pointer, or compiled elsewhere, whose frames are not in it.
    open: Vec<String>,
}

impl Stack {
    /// Functions that call through a pointer.
    fn pointers(&self) -> impl Iterator<Item = &str> {
        let open = self.open.iter();
        open.filter_map(|it| it.strip_prefix(calls::POINTERS))
    }

    /// Of the deepest chain from the start, and of the interrupts on top of it.
    pub fn bytes(&self) -> u64 {
        let [tick, sampling] = self.interrupts;
        self.main + EXCEPTION_FRAME + tick + EXCEPTION_FRAME + sampling
    }
}

impl fmt::Display for Stack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (main, [tick, sampling]) = (self.main, self.interrupts);
        write!(
            f,
            "{} bytes: main {main}, tick {tick}, sampling {sampling}, registers twice {EXCEPTION_FRAME}; not in it: {} functions \
             without a stated frame, and pointers in {}",
            self.bytes(),
            self.open.len() - self.pointers().count(),
            self.pointers().collect::<Vec<_>>().join(", ")
        )
    }
}

/// Adds up the deepest chains.
pub fn stack(image: &Path) -> anyhow::Result<Stack> {
    let bytes = files::bytes(image)?;
    let graph = graph(&bytes)?;
    ensure!(graph.knows_frames(), "the image tells no stack sizes");
    let deepest = |name: &str| {
        let deepest = graph.deepest(name)?;
        for line in &deepest.chain {
            println!("    {line}");
        }
        Ok::<_, anyhow::Error>(deepest)
    };
    let (main, tick, sampling) = (deepest("Reset")?, deepest("PendSV")?, deepest("ADC")?);
    let mut open = [main.open, tick.open, sampling.open].concat();
    open.sort();
    open.dedup();
    Ok(Stack {
        main: main.bytes,
        interrupts: [tick.bytes, sampling.bytes],
        open,
    })
}

fn graph(elf: &[u8]) -> anyhow::Result<Graph> {
    let file = object::File::parse(elf)?;
    let text = file.section_by_name(".text").context("no code")?;
    let code = text.data()?;
    let frames = match file.section_by_name(".stack_sizes") {
        Some(section) => frames(section.data()?)?,
        None => BTreeMap::new(),
    };
    let mut is_code = BTreeMap::new();
    let mut functions = vec![];
    for symbol in file.symbols() {
        let (name, address) = (symbol.name()?, symbol.address());
        if name.starts_with("$t") || name.starts_with("$d") {
            is_code.insert(address, name.starts_with("$t"));
        } else if symbol.kind() == SymbolKind::Text && symbol.size() > 0 {
            let address = address & !1;
            functions.push(Function {
                name: format!("{:#}", rustc_demangle::demangle(name)),
                address,
                size: symbol.size(),
                frame: frames.get(&address).copied(),
            });
        }
    }
    Ok(Graph::new(text.address(), code, &is_code, functions))
}

/// Address and frame of each function: an address of four bytes, then a ULEB128.
fn frames(bytes: &[u8]) -> anyhow::Result<BTreeMap<u64, u64>> {
    let mut rest = EndianSlice::new(bytes, LittleEndian);
    let mut frames = BTreeMap::new();
    while !rest.is_empty() {
        let address = u64::from(rest.read_u32()? & !1);
        let frame = rest.read_uleb128()?;
        frames.entry(address).or_insert(frame);
    }
    Ok(frames)
}
