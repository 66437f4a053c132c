//! Every command of OpenGL that is called, counted by its name: the loader hands out a trampoline for each,
//! which adds one and jumps to the command, whatever its arguments.

#![expect(unsafe_code, reason = "commands are wrapped to count them")]

use std::ffi::{CStr, c_void};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// As in the assembly below.
const TRAMPOLINES: usize = 4096;
const TRAMPOLINE_BYTES: usize = 32;

static CALLS: [AtomicU64; TRAMPOLINES] = [const { AtomicU64::new(0) }; TRAMPOLINES];
static COMMANDS: [AtomicUsize; TRAMPOLINES] = [const { AtomicUsize::new(0) }; TRAMPOLINES];
/// Name and address of the command behind each trampoline.
static NAMES: Mutex<Vec<(String, usize)>> = Mutex::new(Vec::new());
/// One count at a time.
static COUNTING: Mutex<()> = Mutex::new(());

#[cfg(not(target_arch = "x86_64"))]
compile_error!("the trampolines are x86-64 code: write them for this processor as well");

std::arch::global_asm!(
    ".text",
    ".p2align 5",
    "varikernel_trampolines:",
    ".set varikernel_index, 0",
    ".rept 4096",
    ".p2align 5",
    "lock incq {calls}+8*varikernel_index(%rip)",
    "jmpq *{commands}+8*varikernel_index(%rip)",
    ".set varikernel_index, varikernel_index+1",
    ".endr",
    calls = sym CALLS,
    commands = sym COMMANDS,
    options(att_syntax),
);

unsafe extern "C" {
    fn varikernel_trampolines();
}

/// The trampoline of a command; null for null.
pub(crate) fn counted(name: &CStr, address: *const c_void) -> *const c_void {
    if address.is_null() {
        return address;
    }
    let key = (name.to_str().unwrap().to_owned(), address.expose_provenance());
    let mut names = NAMES.lock().unwrap();
    let index = names.iter().position(|known| *known == key).unwrap_or_else(|| {
        assert!(names.len() < TRAMPOLINES, "more trampolines are needed");
        COMMANDS[names.len()].store(key.1, Ordering::SeqCst);
        names.push(key);
        names.len() - 1
    });
    // SAFETY: the trampolines stand one after the other, and there are more than `index`.
    unsafe { (varikernel_trampolines as *const c_void).byte_add(index * TRAMPOLINE_BYTES) }
}

/// Calls since a moment, by all contexts that were opened through [`counted`]; others wait until it is
/// dropped.
pub(crate) struct Calls {
    _alone: MutexGuard<'static, ()>,
    before: Vec<u64>,
}

impl Calls {
    pub(crate) fn new() -> Self {
        // A test that failed while it counted left nothing behind that matters.
        let alone = COUNTING.lock().unwrap_or_else(PoisonError::into_inner);
        Self { _alone: alone, before: now() }
    }

    /// Counts from here on.
    pub(crate) fn restart(&mut self) {
        self.before = now();
    }

    /// Names and numbers of the commands of OpenGL that were called; which context is current is asked of EGL.
    pub(crate) fn all(&self) -> Vec<(String, u64)> {
        let names = NAMES.lock().unwrap();
        let calls = now();
        let since =
            names.iter().enumerate().map(|(index, (name, _))| (name, calls[index] - self.before[index]));
        let of_opengl = since.filter(|(name, _)| name.starts_with("gl"));
        of_opengl.filter(|&(_, calls)| calls > 0).map(|(name, calls)| (name.clone(), calls)).collect()
    }

    pub(crate) fn of(&self, name: &str) -> u64 {
        self.all().into_iter().filter(|(known, _)| known == name).map(|(_, calls)| calls).sum()
    }
}

fn now() -> Vec<u64> {
    CALLS.iter().map(|calls| calls.load(Ordering::SeqCst)).collect()
}
