//! The plugin's side towards QEMU: its API version 1, as declared in `qemu-plugin.h` of QEMU 7.2.

use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};

use crate::FLASH;
use crate::cost::{Block, Stretch};
use crate::decode::{Instruction, decode};

/// SysTick's counter: a window begins at one reading of it and ends at the next.
const COUNTER: u64 = 0xe000_e018;
const NO_REGISTERS: c_int = 0;
/// Reads and writes: with reads alone QEMU 7.2 calls nothing.
const READS_AND_WRITES: c_int = 3;

type Id = u64;
type OnBlock = extern "C" fn(Id, *mut c_void);
type OnExit = extern "C" fn(Id, *mut c_void);
type OnRun = extern "C" fn(c_uint, *mut c_void);
type OnAccess = extern "C" fn(c_uint, u32, u64, *mut c_void);

unsafe extern "C" {
    fn qemu_plugin_register_vcpu_tb_trans_cb(id: Id, call: OnBlock);
    fn qemu_plugin_register_atexit_cb(id: Id, call: OnExit, data: *mut c_void);
    fn qemu_plugin_tb_n_insns(block: *const c_void) -> usize;
    fn qemu_plugin_tb_get_insn(block: *const c_void, index: usize) -> *mut c_void;
    fn qemu_plugin_insn_vaddr(instruction: *const c_void) -> u64;
    fn qemu_plugin_register_vcpu_tb_exec_cb(
        block: *mut c_void,
        call: OnRun,
        registers: c_int,
        data: *mut c_void,
    );
    fn qemu_plugin_register_vcpu_mem_cb(
        instruction: *mut c_void,
        call: OnAccess,
        registers: c_int,
        accesses: c_int,
        data: *mut c_void,
    );
}

/// The version of the API.
#[unsafe(no_mangle)]
pub static qemu_plugin_version: c_int = 1;

struct State {
    /// At each half word of the flash; stays where it is, as QEMU holds pointers into it.
    code: &'static [Instruction],
    flash_end: u64,
    /// Between two readings.
    counting: bool,
    window: Stretch<'static>,
    out: BufWriter<File>,
}

/// One core, one thread: it is only used from that.
static STATE: AtomicPtr<State> = AtomicPtr::new(ptr::null_mut());

fn state() -> &'static mut State {
    // SAFETY: set before any callback is registered, never freed, and callbacks of one core do not overlap.
    unsafe { &mut *STATE.load(Ordering::Relaxed) }
}

/// Called by QEMU.
///
/// # Safety
/// `arguments` holds `count` strings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qemu_plugin_install(
    id: Id,
    _: *const c_void,
    count: c_int,
    arguments: *const *const c_char,
) -> c_int {
    let argument = |name: &str| {
        (0..count as usize).find_map(|k| {
            // SAFETY: as the caller says.
            let text = unsafe { CStr::from_ptr(*arguments.add(k)) }.to_str().ok()?;
            text.strip_prefix(name)?.strip_prefix('=')
        })
    };
    let opened = argument("code").zip(argument("out"));
    let opened =
        opened.and_then(|(code, out)| Some((fs::read(code).ok()?, File::create(out).ok()?)));
    let Some((bytes, out)) = opened else {
        eprintln!("touchdown-cycles: needs code=FILE to read and out=FILE to write");
        return 1;
    };
    let state = Box::new(State {
        code: instructions(&bytes).leak(),
        flash_end: u64::from(FLASH) + bytes.len() as u64,
        counting: false,
        window: Stretch::new(),
        out: BufWriter::new(out),
    });
    STATE.store(Box::into_raw(state), Ordering::Relaxed);
    // SAFETY: QEMU calls with the id that these want.
    unsafe {
        qemu_plugin_register_vcpu_tb_trans_cb(id, on_block);
        qemu_plugin_register_atexit_cb(id, on_exit, ptr::null_mut());
    }
    0
}

/// Decoded here: QEMU 7.2 tells wrong sizes at the ends of pages.
fn instructions(bytes: &[u8]) -> Vec<Instruction> {
    let half = |k: usize| match bytes.get(2 * k..2 * k + 2) {
        Some(it) => u16::from_le_bytes([it[0], it[1]]),
        None => 0,
    };
    let at = |k: usize| decode(FLASH + 2 * k as u32, half(k), half(k + 1));
    (0..bytes.len() / 2).map(at).collect()
}

extern "C" fn on_block(_: Id, block: *mut c_void) {
    let state = state();
    let mut code = vec![];
    // SAFETY: the block is QEMU's, and indices are below its number of instructions.
    unsafe {
        for k in 0..qemu_plugin_tb_n_insns(block) {
            let it = qemu_plugin_tb_get_insn(block, k);
            let place = qemu_plugin_insn_vaddr(it).wrapping_sub(u64::from(FLASH)) / 2;
            let Some(known) = state.code.get(place as usize) else {
                return;
            };
            code.push(*known);
            if known.loads && known.literal.is_none() {
                let data = ptr::from_ref(known).cast_mut().cast();
                let reads = READS_AND_WRITES;
                qemu_plugin_register_vcpu_mem_cb(it, on_access, NO_REGISTERS, reads, data);
            }
        }
        // It stays: QEMU keeps what it has translated.
        if let Some(known) = Block::of(&code) {
            let data = Box::into_raw(Box::new(known)).cast();
            qemu_plugin_register_vcpu_tb_exec_cb(block, on_run, NO_REGISTERS, data);
        }
    }
}

extern "C" fn on_run(_: c_uint, data: *mut c_void) {
    let state = state();
    if state.counting {
        // SAFETY: what `on_block` registered, which stays.
        state.window.enter(unsafe { &*data.cast::<Block>() });
    }
}

/// A reading of the counter leaves its block: QEMU translates what follows anew.
extern "C" fn on_access(_: c_uint, _: u32, address: u64, data: *mut c_void) {
    let state = state();
    let in_flash = (u64::from(FLASH)..state.flash_end).contains(&address);
    if address != COUNTER && !(in_flash && state.counting) {
        return;
    }
    // SAFETY: what `on_block` registered, which stays.
    let it = unsafe { &*data.cast::<Instruction>() };
    state.window.run_to(it.address);
    if in_flash {
        state.window.read(address as u32);
        return;
    }
    if state.counting {
        write(&mut state.out, &state.window);
    }
    state.counting = !state.counting;
    state.window.begin();
}

fn write(out: &mut impl Write, window: &Stretch) {
    let it = window.cycles;
    let numbers = [it.lower, it.modelled, it.upper].map(|it| it as u32);
    for number in [window.instructions].into_iter().chain(numbers) {
        // A file that is cut is too short, which its reader notices.
        let _ = out.write_all(&number.to_le_bytes());
    }
}

extern "C" fn on_exit(_: Id, _: *mut c_void) {
    let _ = state().out.flush();
}
