//! The C interface of `include/varikernel.h`: the pipelines by handles, plain structs and status codes.
//!
//! The header is generated from the files here, so their comments speak to C programmers; `examples/cpp` is a
//! host that uses it. What C can get wrong and we can see is a status: null pointers, values out of range,
//! another thread, no current context. A panic, which is a bug of the library, ends at the boundary as
//! [`Status::Internal`]. What can't be seen is for the host to keep: pointers are valid or null, handles are
//! used between their creation and destruction.

#![expect(unsafe_code, reason = "C hands over pointers; rule 8 of CONTRIBUTING.md names this module")]
#![expect(unreachable_pub, reason = "C is the caller, and cbindgen takes what says `pub`")]

mod context;
mod frame;
mod handle;
mod irradiance;
mod log;
mod pipeline;
mod settings;
mod status;
mod version;

use context::{Context, Home, destroy};
use frame::{PlainFrame, texture};
use handle::Handle;
use settings::PlainSettings;
use status::{Failure, Status, answer};

/// The value behind a pointer of C.
///
/// # Safety
/// `pointer` is null or valid for reads while the reference is in use.
unsafe fn given<'a, T>(pointer: *const T, name: &str) -> Result<&'a T, Failure> {
    // SAFETY: guaranteed by the caller.
    unsafe { pointer.as_ref() }.ok_or_else(|| null(name))
}

/// Whether there is a place to write to; asked before any work.
fn check_place<T>(pointer: *mut T, name: &str) -> Result<(), Failure> {
    if pointer.is_null() { Err(null(name)) } else { Ok(()) }
}

fn null(name: &str) -> Failure {
    Failure::new(Status::InvalidArgument, format!("{name} is null"))
}

/// Whether a struct of C is as long as this version's.
fn check_size(name: &str, size: u32, expected: usize) -> Result<(), Failure> {
    if usize::try_from(size) == Ok(expected) {
        return Ok(());
    }
    Err(Failure::new(
        Status::InvalidArgument,
        format!(
            "{name} has a size of {size} bytes, this library's has {expected}\n\
             help: fill it with {name}_default first, and compile with the header of version {}",
            env!("CARGO_PKG_VERSION")
        ),
    ))
}

/// Whether a flag of C is 0 or 1.
fn flag(name: &'static str, value: u32) -> Result<bool, Failure> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(out_of_range(name, value, "it is 0 or 1")),
    }
}

fn out_of_range(name: &'static str, value: u32, reason: &str) -> Failure {
    crate::error::Error::Setting { name, value: value.to_string(), reason: reason.to_owned() }.into()
}
