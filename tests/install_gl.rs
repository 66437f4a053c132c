//! `.ci/install-gl` on systems other than this one, with package managers that only write down what they are asked.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Command, Output};

/// Package managers in place of this system's: each writes what it is asked into `asked`, and a query finds only
/// what `installed` names.
const MANAGER: &str = r#"#!/bin/sh
asked=$(dirname "$0")/../asked
installed=$(dirname "$0")/../installed
case "$(basename "$0") $*" in
    dpkg-query*) for package; do :; done; grep -qx "$package" "$installed" && echo 'ii ' ;;
    rpm*|"pacman --query"*) for package; do :; done; grep -qx "$package" "$installed" ;;
    *repoquery*) ;;
    *) echo "$(basename "$0") $*" >> "$asked" ;;
esac
"#;

/// Runs the script on a system that its release file describes; what was asked comes with it, line by line.
fn on(release: &str, installed: &[&str]) -> (Output, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("bin")).unwrap();
    for name in ["apt-get", "dpkg-query", "dnf", "rpm", "pacman", "sudo"] {
        let path = at("bin").join(name);
        // What runs as root is what follows.
        fs::write(&path, if name == "sudo" { "#!/bin/sh\nexec \"$@\"\n" } else { MANAGER }).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    fs::write(at("release"), release).unwrap();
    fs::write(at("asked"), "").unwrap();
    fs::write(at("installed"), installed.join("\n")).unwrap();
    let path = format!("{}:{}", at("bin").display(), std::env::var("PATH").unwrap());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join(".ci/install-gl");
    let output = Command::new(script).env("PATH", path).env("OS_RELEASE", at("release")).output().unwrap();
    let asked = fs::read_to_string(at("asked")).unwrap();
    (output, asked.lines().map(str::to_owned).collect())
}

#[test]
fn fedora_is_asked_for_its_packages_and_osmesa_is_said_to_be_gone() {
    let (output, asked) = on("NAME=\"Fedora Linux\"\nID=fedora\n", &["gcc-c++"]);
    assert!(output.status.success(), "{output:?}");
    let [install] = &asked[..] else { panic!("{asked:?}") };
    assert!(install.starts_with("dnf install --assumeyes"), "{install}");
    assert!(install.contains(" mesa-dri-drivers ") && !install.contains("gcc-c++"), "{install}");
    assert!(
        String::from_utf8_lossy(&output.stdout).contains("mesa-libOSMesa is not offered here"),
        "{output:?}"
    );
}

#[test]
fn arch_is_asked_for_its_packages() {
    let (output, asked) = on("ID=arch\n", &["mesa", "glslang"]);
    assert!(output.status.success(), "{output:?}");
    let install = asked.last().unwrap();
    assert!(install.starts_with("pacman --sync --needed --noconfirm vulkan-swrast gcc"), "{asked:?}");
}

#[test]
fn a_system_is_known_by_what_it_is_like_and_nothing_happens_where_all_is_there() {
    let all = [
        "libegl1",
        "libgl1-mesa-dri",
        "mesa-vulkan-drivers",
        "glslang-tools",
        "g++",
        "cmake",
        "pkgconf",
        "libgl-dev",
        "libegl-dev",
        "libopengl-dev",
        "xvfb",
        "libgl1",
        "libx11-6",
        "libx11-xcb1",
        "libxcursor1",
        "libxi6",
        "libxrandr2",
        "libxkbcommon-x11-0",
        "libosmesa6",
    ];
    let mint = "ID=linuxmint\nID_LIKE=\"ubuntu debian\"\n";
    let (output, asked) = on(mint, &all);
    assert!(output.status.success(), "{output:?}");
    assert!(asked.is_empty(), "{asked:?}");
    let (_, asked) = on(mint, &all[1..]);
    assert!(
        asked.last().unwrap().ends_with("apt-get install --yes --no-install-recommends libegl1"),
        "{asked:?}"
    );
}

#[test]
fn an_unknown_system_is_named_with_what_to_install() {
    let (output, asked) = on("ID=plan9\n", &[]);
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(error.contains("plan9 is not known") && error.contains("EGL"), "{error}");
    assert!(asked.is_empty(), "{asked:?}");
}
