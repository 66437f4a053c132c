//! What happens when a signal ends the program: no unfinished file stays, and the exit status shows the
//! signal.

use varikernel::image::discard_unfinished_files;

/// From now on, unfinished files are removed before a signal ends the program.
pub(crate) fn leave_no_unfinished_files() {
    if let Err(error) = listen() {
        tracing::warn!("an interrupted run may leave a file that ends in .part: {error}");
    }
}

#[cfg(unix)]
fn listen() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let ignored = ignored_signals();
    let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| ignored & (1 << (signal - 1)) == 0);
    let mut signals = Signals::new(heard)?;
    std::thread::Builder::new().name("signals".to_owned()).spawn(move || {
        for signal in &mut signals {
            // Held to the end, so that no other thread begins a file or finishes one that is gone.
            let _discarded = discard_unfinished_files();
            // The signal itself ends the program, as its sender expects: a shell answers 128 and its number.
            if emulate_default_handler(signal).is_err() {
                std::process::exit(128 + signal);
            }
        }
    })?;
    Ok(())
}

/// The signals that the parent process set to be ignored, as `nohup` does with that of a closed terminal: one
/// bit each, the lowest for signal 1. None where the system does not report them.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    ignored_in(&status)
}

#[cfg(unix)]
fn ignored_in(status: &str) -> u64 {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(windows)]
fn listen() -> Result<(), ctrlc::Error> {
    /// STATUS_CONTROL_C_EXIT, with which Windows itself ends a program at Ctrl+C.
    const INTERRUPTED: i32 = 0xc000_013a_u32.cast_signed();
    ctrlc::set_handler(|| {
        let _discarded = discard_unfinished_files();
        std::process::exit(INTERRUPTED);
    })
}

#[cfg(not(any(unix, windows)))]
fn listen() -> std::io::Result<()> {
    Ok(())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn what_is_ignored_stands_in_the_status() {
        let status = "Name:\tvarikernel\nSigBlk:\t0000000000000002\nSigIgn:\t0000000000001001\nSigCgt:\t0\n";
        // SIGHUP is 1 and SIGPIPE 13.
        assert_eq!(ignored_in(status), 1 | 1 << 12);
        assert_eq!(ignored_in(""), 0);
        assert_eq!(ignored_in("SigIgn:\twhat"), 0);
    }
}
