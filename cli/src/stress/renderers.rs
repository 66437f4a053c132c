//! The same maps on every renderer found here, each in a process of its own, since Mesa reads its variables
//! once.

use std::env;
use std::process::Command;

use anyhow::Result;
use varikernel::context::{self, DeviceChoice, Missing};
use varikernel::error::Error;
use varikernel::gl::Gl;
use varikernel_lab::stress::{Bits, Found, Renderer};

use crate::device;

/// Renderers of Mesa that have to be chosen by variables, and how: its interpreter, and Zink, which draws
/// through Vulkan (here lavapipe).
const OTHERS: [(&str, &[(&str, &str)]); 2] = [
    ("softpipe", &[("GALLIUM_DRIVER", "softpipe")]),
    ("zink", &[("GALLIUM_DRIVER", "zink"), ("LIBGL_ALWAYS_SOFTWARE", "true")]),
];

/// Numbers of llvmpipe's threads.
const THREADS: [&str; 3] = ["1", "2", "8"];

/// The same maps here, on every other device, on Mesa's other renderers, and with other numbers of threads.
/// `show` gets the next one, and the share of the work that is done.
pub(super) fn all(gl: &Gl, times: u32, show: &mut dyn FnMut(&str, f64)) -> Result<Vec<Renderer>> {
    let (candidates, missing) = context::candidates();
    #[expect(clippy::cast_precision_loss, reason = "a few renderers")]
    let count = (1 + candidates.len() + OTHERS.len() + THREADS.len()) as f64;
    let mut told = 0.0;
    let mut tell = |name: &str| {
        show(name, told / count);
        told += 1.0;
    };
    tell("again");
    let again = Found::Ran(Bits::of(gl, times)?);
    let mut all = vec![Renderer { name: "again".to_owned(), found: again, of_threads: true }];
    for candidate in candidates {
        let name = candidate.choice.to_string();
        tell(&name);
        all.push(Renderer { found: in_child(&name, &[], 1), name, of_threads: false });
    }
    for Missing { platform, refusal } in missing {
        let found = Found::NotThere(refusal.reason);
        all.push(Renderer { name: platform.to_string(), found, of_threads: false });
    }
    for (name, variables) in OTHERS {
        tell(name);
        all.push(Renderer { name: name.to_owned(), found: in_child(name, variables, 1), of_threads: false });
    }
    for threads in THREADS {
        let name = format!("threads-{threads}");
        tell(&name);
        // The variable has no effect on hardware, and llvmpipe is chosen by name.
        let variables = [("GALLIUM_DRIVER", "llvmpipe"), ("LP_NUM_THREADS", threads)];
        all.push(Renderer { name, found: in_child("llvmpipe", &variables, times), of_threads: true });
    }
    Ok(all)
}

/// What a child prints: only where no context is to be had the device is not there; all else that goes wrong
/// is an error.
pub(super) fn found_here(device: &DeviceChoice, times: u32) -> Result<Found> {
    match device::open(device) {
        Ok(gl) => Ok(Found::Ran(Bits::of(&gl, times)?)),
        Err(Error::NoContext { reason, .. }) => Ok(Found::NotThere(last_tried(&reason).to_owned())),
        Err(error) => Err(error.into()),
    }
}

/// What this program finds in a process of its own.
fn in_child(device: &str, variables: &[(&str, &str)], times: u32) -> Found {
    let program = match env::current_exe() {
        Ok(program) => program,
        Err(error) => return Found::Failed(error.to_string()),
    };
    let mut child = Command::new(program);
    child.args(["stress", "--bits", &times.to_string(), "--device", device]).envs(variables.iter().copied());
    match child.output() {
        Ok(output) => {
            let failure = (!output.status.success()).then(|| output.status.to_string());
            answer(failure.as_deref(), &output.stdout, &String::from_utf8_lossy(&output.stderr))
        }
        Err(error) => Found::Failed(error.to_string()),
    }
}

/// A child's answer, by how it failed if it did.
fn answer(failure: Option<&str>, stdout: &[u8], stderr: &str) -> Found {
    if let Some(status) = failure {
        let first = stderr.lines().next().unwrap_or_default();
        return Found::Failed(format!("{status}: {first}"));
    }
    serde_json::from_slice(stdout).unwrap_or_else(|error| Found::Failed(format!("no answer: {error}")))
}

/// The last of what was tried.
fn last_tried(reason: &str) -> &str {
    reason.lines().next_back().unwrap_or_default().trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reason_is_the_last_thing_that_was_tried() {
        let text = "no usable context; tried:\n  egl:0: is \"llvmpipe\"\n  osmesa: not found";
        assert_eq!(last_tried(text), "osmesa: not found");
        assert_eq!(last_tried("it broke"), "it broke");
    }

    #[test]
    fn only_a_child_that_says_so_is_not_there() {
        let absent = Found::NotThere("osmesa: not found".to_owned());
        let text = serde_json::to_vec(&absent).unwrap();
        assert_eq!(answer(None, &text, ""), absent);
        let failed = |text: &str| Found::Failed(text.to_owned());
        assert_eq!(answer(Some("exit status: 2"), &text, "error: a\nb"), failed("exit status: 2: error: a"));
        assert_eq!(answer(Some("signal: 11"), b"", ""), failed("signal: 11: "));
        assert!(matches!(answer(None, b"{", ""), Found::Failed(reason) if reason.starts_with("no answer: ")));
    }

    #[test]
    fn a_device_that_no_machine_has_is_not_there() {
        let device = DeviceChoice::Named("no-such-device".to_owned());
        assert!(matches!(found_here(&device, 1), Ok(Found::NotThere(_))));
    }
}
