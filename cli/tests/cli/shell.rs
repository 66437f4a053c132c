//! What a shell and `man` need: completions and manual pages.

use std::fs;
use std::process::Command;

use crate::Workplace;

#[test]
fn completions_are_of_every_verb_and_bash_takes_them() {
    let place = Workplace::new();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let run = place.command(&format!("completions {shell}")).assert().success();
        let text = String::from_utf8(run.get_output().stdout.clone()).unwrap();
        for word in ["render", "devices", "completions", "antialias", "max-radius"] {
            assert!(text.contains(word), "{word} for {shell}");
        }
        if shell == "bash" {
            place.put("completions", text.as_bytes());
        }
    }
    let ask = "source completions; COMP_WORDS=(varikernel ren); COMP_CWORD=1; \
               _varikernel varikernel ren varikernel; echo ${COMPREPLY[@]}";
    let answer = Command::new("bash").args(["-c", ask]).current_dir(place.folder.path()).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&answer.stdout).trim(), "render", "{answer:?}");
}

#[test]
fn each_verb_has_a_manual_page() {
    let place = Workplace::new();
    place.command("man -o share/man1").assert().success();
    let folder = place.folder.path().join("share/man1");
    for page in ["varikernel", "varikernel-render", "varikernel-man"] {
        let text = fs::read_to_string(folder.join(format!("{page}.1"))).unwrap();
        assert!(text.contains(&format!(".TH {page} 1")), "{page}: {text}");
        assert!(text.contains(".SH OPTIONS") || text.contains(".SH SUBCOMMANDS"), "{page}");
    }
    assert!(!folder.join("varikernel-help.1").exists());
}

#[test]
fn an_unknown_shell_and_a_folder_that_is_a_file_are_refused() {
    let place = Workplace::new();
    place.refuses("completions csh", &["possible values: bash, elvish, fish, powershell, zsh"]);
    place.put("taken", b"a file");
    place.refuses("man -o taken", &["taken"]);
}
