//! Which library was found at run time.

use std::ffi::c_char;

/// The version of this header, major part.
pub const VARIKERNEL_VERSION_MAJOR: u32 = 0;

/// The version of this header, minor part.
pub const VARIKERNEL_VERSION_MINOR: u32 = 2;

/// The version of this header, patch part.
pub const VARIKERNEL_VERSION_PATCH: u32 = 0;

/// Whether the manifest says the same of a part.
const fn is_version(part: &str, value: u32) -> bool {
    matches!(u32::from_str_radix(part, 10), Ok(number) if number == value)
}
const _: () = assert!(is_version(env!("CARGO_PKG_VERSION_MAJOR"), VARIKERNEL_VERSION_MAJOR));
const _: () = assert!(is_version(env!("CARGO_PKG_VERSION_MINOR"), VARIKERNEL_VERSION_MINOR));
const _: () = assert!(is_version(env!("CARGO_PKG_VERSION_PATCH"), VARIKERNEL_VERSION_PATCH));

/// The version of the library that was loaded, such as "0.2.0"; never null, valid forever.
#[unsafe(no_mangle)]
pub extern "C" fn varikernel_version() -> *const c_char {
    const TEXT: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    TEXT.as_ptr().cast()
}

/// Whether the loaded library is what a header of this version describes.
///
/// Call it with VARIKERNEL_VERSION_MAJOR and VARIKERNEL_VERSION_MINOR before anything else. Before version
/// 1.0 both have to be the library's own.
#[unsafe(no_mangle)]
pub extern "C" fn varikernel_is_compatible(major: u32, minor: u32) -> bool {
    (major, minor) == (VARIKERNEL_VERSION_MAJOR, VARIKERNEL_VERSION_MINOR)
}
