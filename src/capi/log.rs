//! What the library has to say besides statuses, for a callback of the host.

use std::ffi::{CString, c_char, c_void};
use std::fmt::{self, Write as _};
use std::sync::{Mutex, OnceLock, PoisonError};

use tracing::field::{Field, Visit};
use tracing::level_filters::LevelFilter;
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

use super::{Failure, Status, answer, out_of_range};

/// level: something of the library failed, and no status tells.
pub const VARIKERNEL_LOG_ERROR: u32 = 1;

/// level: what the host should know, such as an OpenGL error that was pending when a call began.
pub const VARIKERNEL_LOG_WARNING: u32 = 2;

/// level: what happened.
pub const VARIKERNEL_LOG_INFO: u32 = 3;

/// level: details, such as what was decided on a frame.
pub const VARIKERNEL_LOG_DEBUG: u32 = 4;

/// Takes a line of the log, in UTF-8, which is gone afterwards. `user` is passed on.
///
/// It must not throw, nor call the library; it is called on the threads that do.
pub type Log = Option<unsafe extern "C" fn(level: u32, line: *const c_char, user: *mut c_void)>;

/// The host's callback.
#[derive(Clone, Copy)]
struct Hook {
    log: unsafe extern "C" fn(u32, *const c_char, *mut c_void),
    /// As an address, which other threads may hold.
    user: usize,
    most: u32,
}

static HOOK: Mutex<Option<Hook>> = Mutex::new(None);

/// Whether lines come to [`HOOK`]; a process has one receiver of them.
static IS_INSTALLED: OnceLock<bool> = OnceLock::new();

fn hook() -> Option<Hook> {
    *HOOK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Hands lines of the log to `log` from now on, up to the level `most`: one of VARIKERNEL_LOG_... Null for `log`
/// ends that, but for lines that other threads are just handing on: `user` outlives those. For the whole
/// process; nothing is logged before.
///
/// Fails with SETTING for another level, and with INTERNAL where the process hands lines of Rust's `tracing` to
/// another receiver already.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_set_log(log: Log, user: *mut c_void, most: u32) -> Status {
    answer(|| {
        let Some(log) = log else {
            *HOOK.lock().unwrap_or_else(PoisonError::into_inner) = None;
            return Ok(());
        };
        if !(VARIKERNEL_LOG_ERROR..=VARIKERNEL_LOG_DEBUG).contains(&most) {
            return Err(out_of_range("most", most, "it is one of VARIKERNEL_LOG_..., 1 to 4"));
        }
        if !IS_INSTALLED.get_or_init(|| tracing::subscriber::set_global_default(Lines).is_ok()) {
            let text = "lines of the log go elsewhere in this process already\n\
                        help: leave varikernel_set_log out, and take them there";
            return Err(Failure::new(Status::Internal, text));
        }
        *HOOK.lock().unwrap_or_else(PoisonError::into_inner) =
            Some(Hook { log, user: user.expose_provenance(), most });
        Ok(())
    })
}

/// Makes lines of events.
struct Lines;

fn number(level: Level) -> u32 {
    match level {
        Level::ERROR => VARIKERNEL_LOG_ERROR,
        Level::WARN => VARIKERNEL_LOG_WARNING,
        Level::INFO => VARIKERNEL_LOG_INFO,
        _ => VARIKERNEL_LOG_DEBUG,
    }
}

impl Subscriber for Lines {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        let is_detail = *metadata.level() == Level::TRACE;
        metadata.is_event() && !is_detail && hook().is_some_and(|hook| number(*metadata.level()) <= hook.most)
    }

    fn register_callsite(&self, metadata: &'static Metadata<'static>) -> tracing::subscriber::Interest {
        // The hook changes, so that each event asks anew.
        if metadata.is_event() {
            tracing::subscriber::Interest::sometimes()
        } else {
            tracing::subscriber::Interest::never()
        }
    }

    fn max_level_hint(&self) -> Option<LevelFilter> {
        Some(LevelFilter::DEBUG)
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, event: &Event<'_>) {
        let Some(hook) = hook() else { return };
        let mut line = Line::default();
        event.record(&mut line);
        let text = format!("{}{}", line.message, line.fields).replace('\0', " ");
        let text = CString::new(text).unwrap_or_default();
        let user = std::ptr::with_exposed_provenance_mut(hook.user);
        // SAFETY: the host gave a callback of this type, and `user` for it.
        unsafe { (hook.log)(number(*event.metadata().level()), text.as_ptr(), user) };
    }

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

/// The message of an event, and the rest of it as `, name: value`.
#[derive(Default)]
struct Line {
    message: String,
    fields: String,
}

impl Line {
    fn add(&mut self, field: &Field, value: fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        let _ = match field.name() {
            "message" => write!(self.message, "{value}"),
            name => write!(self.fields, ", {name}: {value}"),
        };
    }
}

impl Visit for Line {
    fn record_str(&mut self, field: &Field, value: &str) {
        self.add(field, format_args!("{value}"));
    }

    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        self.add(field, format_args!("{value:?}"));
    }
}
