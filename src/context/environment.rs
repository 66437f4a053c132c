//! Variables of the environment that change which renderer Mesa takes and what it offers.

use std::env;

use super::refusal::{INSTALL, Refusal};

/// The value of a variable, if it is set.
pub(super) type Get<'a> = &'a dyn Fn(&str) -> Option<String>;

/// How the names of variables begin that the drivers of OpenGL, EGL and Vulkan read.
const PREFIXES: [&str; 16] = [
    "MESA_",
    "GALLIUM_",
    "LIBGL_",
    "EGL_",
    "__EGL_",
    "__GL",
    "LP_",
    "LVP_",
    "DRAW_",
    "GALLIVM_",
    "NIR_",
    "OSMESA_",
    "SOFTPIPE_",
    "ST_DEBUG",
    "VK_",
    "ZINK_",
];

/// Variables that choose the driver.
#[cfg(any(all(feature = "egl", not(target_vendor = "apple")), feature = "window"))]
const DRIVER: [&str; 2] = ["GALLIUM_DRIVER", "MESA_LOADER_DRIVER_OVERRIDE"];

/// Mesa's renderers on the processor.
const SOFTWARE: [&str; 2] = ["llvmpipe", "softpipe"];

/// The environment of this process.
pub(super) fn get(name: &str) -> Option<String> {
    env::var_os(name).map(|value| value.to_string_lossy().into_owned())
}

/// What the environment sets of all that drivers of OpenGL, EGL and Vulkan read, as `NAME=value`, in
/// alphabetical order.
///
/// Some values crash the process inside of the driver; a program that has to survive that tries a device in
/// another process first.
#[must_use]
pub fn driver_variables() -> Vec<String> {
    let mut found: Vec<_> = env::vars_os()
        .map(|(name, value)| (name.to_string_lossy().into_owned(), value))
        .filter(|(name, _)| is_of_drivers(name))
        .map(|(name, value)| format!("{name}={}", value.to_string_lossy()))
        .collect();
    found.sort_unstable();
    found
}

fn is_of_drivers(name: &str) -> bool {
    PREFIXES.iter().any(|prefix| name.starts_with(prefix))
}

/// The variable that keeps Mesa from OpenGL 3.3, if one does.
#[cfg(any(all(feature = "egl", not(target_vendor = "apple")), feature = "window"))]
pub(super) fn obstacle(get: Get<'_>) -> Option<Refusal> {
    version_override(get).or_else(|| driver(get)).or_else(|| no_llvm(get))
}

/// As [`obstacle`], for OSMesa, which has no other drivers.
#[cfg(feature = "osmesa")]
pub(super) fn obstacle_of_osmesa(get: Get<'_>) -> Option<Refusal> {
    let name = "GALLIUM_DRIVER";
    let foreign = get(name).filter(|value| !value.is_empty() && !SOFTWARE.contains(&value.as_str()));
    let of_driver = foreign.map(|value| {
        let reason =
            format!("the environment sets {name}={value}, and OSMesa has only llvmpipe and softpipe");
        Refusal::new(reason, format!("use EGL (--device egl), or unset {name}"))
    });
    of_driver.or_else(|| version_override(get)).or_else(|| no_llvm(get))
}

/// What may help where a driver gives no reason for `symptom`: to try without the [`driver_variables`].
#[must_use]
pub fn unexplained(symptom: &str) -> Refusal {
    without(symptom, &driver_variables())
}

fn without(symptom: &str, set: &[String]) -> Refusal {
    if set.is_empty() {
        return Refusal::new(symptom, format!("update the driver of this device, or {INSTALL}"));
    }
    let names = set.iter().map(|variable| variable.split('=').next().unwrap_or_default());
    let options: Vec<_> = names.map(|name| format!("-u {name}")).collect();
    Refusal::new(
        format!("{symptom}; the environment sets {}, which drivers read", set.join(" ")),
        format!("try without: `env {} varikernel devices`", options.join(" ")),
    )
}

/// A version below 3.3, read as Mesa reads it: numbers first, then perhaps FC or COMPAT. What is no number is
/// ignored.
fn version_override(get: Get<'_>) -> Option<Refusal> {
    let of_opengl = |value: &str| {
        let (major, rest) = value.split_once('.')?;
        Some((leading(major)?, leading(rest)?))
    };
    let too_old = |name: &str, value: &str, least: &str| {
        Refusal::new(
            format!("the environment sets {name}={value}, and this needs {least}"),
            format!("unset {name} (`env -u {name} varikernel ...`), or set it to {least} or more"),
        )
    };
    let name = "MESA_GL_VERSION_OVERRIDE";
    if let Some(value) = get(name)
        && of_opengl(&value).is_some_and(|version| version < (3, 3))
    {
        return Some(too_old(name, &value, "3.3"));
    }
    let name = "MESA_GLSL_VERSION_OVERRIDE";
    let value = get(name)?;
    leading(&value).is_some_and(|version| version < 330).then(|| too_old(name, &value, "330"))
}

/// The number that a text begins with.
fn leading(text: &str) -> Option<u32> {
    let digits = text.trim_start().find(|letter: char| !letter.is_ascii_digit());
    let text = text.trim_start();
    text[..digits.unwrap_or(text.len())].parse().ok()
}

/// A driver that is set by name and is none of Mesa's software renderers.
#[cfg(any(all(feature = "egl", not(target_vendor = "apple")), feature = "window"))]
fn driver(get: Get<'_>) -> Option<Refusal> {
    let (name, value) = DRIVER.iter().find_map(|name| {
        let value = get(name)?;
        let is_usual = value.is_empty() || SOFTWARE.contains(&value.as_str());
        (!is_usual).then_some((name, value))
    })?;
    let reason = format!("the environment sets {name}={value}");
    Some(if value == "zink" {
        Refusal::new(
            format!("{reason}, which draws through Vulkan and finds no device of it"),
            format!(
                "install a driver of Vulkan (on the processor: sudo apt-get install mesa-vulkan-drivers, and \
                 set LIBGL_ALWAYS_SOFTWARE=true beside it), or unset {name}"
            ),
        )
    } else {
        Refusal::new(reason, format!("unset {name}, or set it to llvmpipe or softpipe"))
    })
}

/// Vertices without LLVM: llvmpipe is then older than 3.3.
fn no_llvm(get: Get<'_>) -> Option<Refusal> {
    let name = "DRAW_USE_LLVM";
    let value = get(name)?;
    let is_off = ["0", "n", "no", "f", "false"].contains(&value.to_lowercase().as_str());
    let is_llvmpipe = get("GALLIUM_DRIVER").is_none_or(|driver| driver != "softpipe");
    (is_off && is_llvmpipe).then(|| {
        let reason = format!("the environment sets {name}={value}, without which llvmpipe has no OpenGL 3.3");
        Refusal::new(reason, format!("unset {name}"))
    })
}

#[cfg(all(test, any(all(feature = "egl", not(target_vendor = "apple")), feature = "window")))]
mod tests {
    use super::*;

    /// What `check` returns where `variables` are set.
    fn with(variables: &[(&str, &str)], check: fn(Get<'_>) -> Option<Refusal>) -> Option<Refusal> {
        check(&|name| variables.iter().find(|(set, _)| *set == name).map(|(_, value)| (*value).to_owned()))
    }

    #[test]
    fn versions_are_read_as_mesa_reads_them() {
        let (opengl, glsl) = ("MESA_GL_VERSION_OVERRIDE", "MESA_GLSL_VERSION_OVERRIDE");
        for value in ["2.1", "3.2", "0.5", "1.0", "2.1COMPAT", "2.1FC", "3.0FC", " 3.1"] {
            let refusal = with(&[(opengl, value)], version_override).unwrap();
            assert!(refusal.reason.contains(&format!("{opengl}={value}")), "{refusal:?}");
            assert!(refusal.remedy.starts_with(&format!("unset {opengl} ")), "{refusal:?}");
        }
        for value in ["3.3", "3.3FC", "3.3COMPAT", "4.6", "10.0", "", "garbage", "2", "-2.1", "99999999999.0"]
        {
            assert_eq!(with(&[(opengl, value)], version_override), None, "{value}");
        }
        for value in ["120", "130", "140", "150", "0", "99", "329", "120 es"] {
            let refusal = with(&[(glsl, value)], version_override).unwrap();
            assert!(refusal.reason.contains(&format!("{glsl}={value}, and this needs 330")), "{refusal:?}");
        }
        for value in ["330", "460", "", "abc", "-1", "99999999999"] {
            assert_eq!(with(&[(glsl, value)], version_override), None, "{value}");
        }
        assert_eq!(with(&[], obstacle), None);
    }

    #[test]
    fn drivers_that_mesa_has_elsewhere_are_named() {
        for name in DRIVER {
            let zink = with(&[(name, "zink")], obstacle).unwrap();
            assert!(
                zink.reason.contains(&format!("{name}=zink")) && zink.reason.contains("Vulkan"),
                "{zink:?}"
            );
            assert!(zink.remedy.contains("mesa-vulkan-drivers") && zink.remedy.ends_with(name), "{zink:?}");
            let other = with(&[(name, "bogus")], obstacle).unwrap();
            assert!(other.reason.ends_with("=bogus") && other.remedy.starts_with("unset "), "{other:?}");
            for value in ["", "llvmpipe", "softpipe"] {
                assert_eq!(with(&[(name, value)], obstacle), None, "{value}");
            }
        }
    }

    #[test]
    fn llvmpipe_without_llvm_for_vertices_is_too_old() {
        assert!(with(&[("DRAW_USE_LLVM", "0")], obstacle).unwrap().reason.contains("DRAW_USE_LLVM=0"));
        assert!(with(&[("DRAW_USE_LLVM", "False")], obstacle).is_some());
        assert_eq!(with(&[("DRAW_USE_LLVM", "1")], obstacle), None);
        assert_eq!(with(&[("DRAW_USE_LLVM", "0"), ("GALLIUM_DRIVER", "softpipe")], obstacle), None);
    }

    #[test]
    fn what_nobody_explains_names_what_is_set() {
        let refusal = without("it broke", &["LP_A=1".to_owned(), "MESA_B=x".to_owned()]);
        assert_eq!(refusal.reason, "it broke; the environment sets LP_A=1 MESA_B=x, which drivers read");
        assert_eq!(refusal.remedy, "try without: `env -u LP_A -u MESA_B varikernel devices`");
        let refusal = without("it broke", &[]);
        assert!(refusal.reason == "it broke" && refusal.remedy.contains("apt-get install"), "{refusal:?}");
    }

    #[cfg(feature = "osmesa")]
    #[test]
    fn osmesa_knows_fewer_drivers() {
        let zink = with(&[("GALLIUM_DRIVER", "zink")], obstacle_of_osmesa).unwrap();
        assert!(zink.reason.contains("OSMesa has only llvmpipe and softpipe"), "{zink:?}");
        assert_eq!(
            with(&[("MESA_LOADER_DRIVER_OVERRIDE", "zink")], obstacle_of_osmesa),
            None,
            "it reads none"
        );
        assert!(with(&[("MESA_GLSL_VERSION_OVERRIDE", "120")], obstacle_of_osmesa).is_some());
        assert_eq!(with(&[("GALLIUM_DRIVER", "softpipe")], obstacle_of_osmesa), None);
    }

    #[test]
    fn variables_of_drivers_are_known_by_their_beginnings() {
        for name in [
            "MESA_DEBUG",
            "LIBGL_DRIVERS_PATH",
            "__EGL_VENDOR_LIBRARY_DIRS",
            "EGL_PLATFORM",
            "VK_ICD_FILENAMES",
        ] {
            assert!(is_of_drivers(name), "{name}");
        }
        assert!(!["HOME", "PATH", "RUST_LOG", "ST"].into_iter().any(is_of_drivers));
    }
}
