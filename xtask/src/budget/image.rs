//! What an image's symbols and code say: what the tick can reach, and the stack.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;

use addr2line::gimli::{EndianSlice, LittleEndian, Reader};
use anyhow::{Context, ensure};
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};

use super::calls::{Deepest, Function, Graph};
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

/// Stack of an image: the deepest chains from the start, from the tick on top of it, and from sampling on top of that.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stack([Deepest; 3]);

impl Stack {
    /// Of all three, and of what the core puts between them.
    pub fn bytes(&self) -> u64 {
        let own: u64 = self.0.iter().map(|it| it.bytes).sum();
        own + 2 * EXCEPTION_FRAME
    }
}

impl fmt::Display for Stack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [main, tick, sampling] = self.0.each_ref().map(|it| it.bytes);
        let frameless: BTreeSet<_> = self.0.iter().flat_map(|it| &it.frameless).collect();
        let pointers: BTreeSet<_> = self.0.iter().flat_map(|it| &it.pointers).collect();
        let pointers: Vec<_> = pointers.into_iter().map(String::as_str).collect();
        write!(
            f,
            "{} bytes: main {main}, tick {tick}, sampling {sampling}, registers twice {EXCEPTION_FRAME}; not in it: {} functions \
             without a stated frame, and pointers in {}",
            self.bytes(),
            frameless.len(),
            pointers.join(", ")
        )
    }
}

/// Finds the deepest chains, and prints them.
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
    Ok(Stack([
        deepest("Reset")?,
        deepest("PendSV")?,
        deepest("ADC")?,
    ]))
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
            let (address, name) = (address & !1, rustc_demangle::demangle(name));
            let frame = frames.get(&address).copied();
            functions.push(Function::new(
                format!("{name:#}"),
                address,
                symbol.size(),
                frame,
            ));
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
