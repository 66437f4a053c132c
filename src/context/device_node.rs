//! The files in /dev through which a driver reaches its card: whether this user may open them.

use std::path::Path;

use super::refusal::Refusal;

/// Who may open a file.
#[cfg_attr(not(unix), expect(dead_code, reason = "other systems have no such files"))]
struct Owner {
    /// The number of the group that it belongs to.
    group: u32,
    /// Its permission bits.
    mode: u32,
}

/// Why the file can't be opened, if it can't.
#[cfg(unix)]
pub(super) fn refusal(node: &Path) -> Option<Refusal> {
    use std::fs::{self, OpenOptions};
    use std::os::unix::fs::MetadataExt as _;

    let error = OpenOptions::new().read(true).write(true).open(node).err()?;
    let owner = fs::metadata(node).ok().map(|data| Owner { group: data.gid(), mode: data.mode() });
    let groups = fs::read_to_string("/etc/group").unwrap_or_default();
    Some(explain(node, &error, owner.as_ref(), &groups))
}

/// Other systems have no such files.
#[cfg(not(unix))]
pub(super) fn refusal(_node: &Path) -> Option<Refusal> {
    None
}

/// `groups` is the text of /etc/group.
#[cfg(any(unix, test))]
fn explain(node: &Path, error: &std::io::Error, owner: Option<&Owner>, groups: &str) -> Refusal {
    use std::io::ErrorKind;

    let node = node.display();
    if error.kind() == ErrorKind::NotFound {
        let remedy =
            "in a container, pass the card on (`--device /dev/dri`); elsewhere, load its kernel's driver";
        return Refusal::new(format!("there is no {node} here"), remedy);
    }
    let reason = format!("{node} can't be opened: {error}");
    let denied = error.kind() == ErrorKind::PermissionDenied;
    let Some(Owner { group, mode }) = owner.filter(|_| denied) else {
        return Refusal::new(
            reason,
            format!("find out why {node} can't be opened, or choose another device"),
        );
    };
    // Membership in root's group grants far more than access to a card.
    if mode & 0o060 != 0o060 || *group == 0 {
        let reason = format!("{reason}; its group may not open it (mode {:o}, group {group})", mode & 0o777);
        return Refusal::new(reason, format!("sudo chgrp render {node} && sudo chmod 660 {node}"));
    }
    match name_of(*group, groups) {
        Some(name) => Refusal::new(
            format!("{reason}; it belongs to the group {name}"),
            format!(
                "sudo usermod -aG {name} $USER, and log in again (in a container: `--group-add {group}`)"
            ),
        ),
        None => Refusal::new(
            format!("{reason}; it belongs to the group {group}, which has no name here"),
            format!("run the container with `--group-add {group}`"),
        ),
    }
}

/// The name of a group, by lines as `render:x:106:user`.
#[cfg(any(unix, test))]
fn name_of(group: u32, groups: &str) -> Option<&str> {
    groups.lines().find_map(|line| {
        let mut fields = line.split(':');
        let (name, _password, number) = (fields.next()?, fields.next()?, fields.next()?);
        (number.parse() == Ok(group)).then_some(name)
    })
}

#[cfg(test)]
mod tests {
    use std::io::{Error, ErrorKind};

    use super::*;

    const GROUPS: &str = "root:x:0:\nvideo:x:44:\nrender:x:106:somebody\nbroken\n";

    fn denied(group: u32, mode: u32) -> Refusal {
        let error = Error::from(ErrorKind::PermissionDenied);
        explain(Path::new("/dev/dri/renderD128"), &error, Some(&Owner { group, mode }), GROUPS)
    }

    #[test]
    fn the_group_of_the_node_is_named_with_its_remedy() {
        let render = denied(106, 0o020_660);
        assert!(
            render.reason.starts_with("/dev/dri/renderD128 can't be opened: permission denied"),
            "{render:?}"
        );
        assert!(render.reason.ends_with("group render"), "{render:?}");
        assert!(render.remedy.starts_with("sudo usermod -aG render $USER,"), "{render:?}");
        assert!(denied(44, 0o660).remedy.starts_with("sudo usermod -aG video $USER,"));
        assert_eq!(denied(992, 0o660).remedy, "run the container with `--group-add 992`");
    }

    #[test]
    fn a_group_that_may_not_open_it_helps_nobody() {
        for (group, mode) in [(106, 0o600), (0, 0o660), (106, 0o640)] {
            let refusal = denied(group, mode);
            assert!(refusal.reason.contains(&format!("mode {mode:o}, group {group}")), "{refusal:?}");
            assert!(refusal.remedy.contains("sudo chmod 660 /dev/dri/renderD128"), "{refusal:?}");
        }
    }

    #[test]
    fn a_node_that_is_not_there_and_one_that_is_broken_are_told_apart() {
        let of = |kind| explain(Path::new("/dev/dri/card0"), &Error::from(kind), None, GROUPS);
        assert_eq!(of(ErrorKind::NotFound).reason, "there is no /dev/dri/card0 here");
        assert!(of(ErrorKind::NotFound).remedy.contains("--device /dev/dri"));
        assert!(of(ErrorKind::Other).remedy.contains("find out why"));
        assert!(of(ErrorKind::PermissionDenied).remedy.contains("find out why"), "its group is not known");
    }
}
