//! What a file holds and the picture will lack, counted by kind.

/// Examples of a kind that are named.
const NAMED: usize = 8;

/// A kind of thing: for one of them, and for several.
pub(super) type Kind = (&'static str, &'static str);

/// Kinds in the order in which they were met.
#[derive(Default)]
pub(super) struct LeftOut {
    entries: Vec<Entry>,
}

struct Entry {
    kind: Kind,
    count: usize,
    /// The first few, each once.
    named: Vec<String>,
}

impl LeftOut {
    /// Adds `count` things of a kind.
    pub(super) fn add(&mut self, kind: Kind, count: usize) {
        self.entry(kind).count += count;
    }

    /// Adds one thing with its name, and what is the matter with it.
    pub(super) fn name(&mut self, kind: Kind, name: String) {
        let entry = self.entry(kind);
        entry.count += 1;
        if entry.named.len() < NAMED && !entry.named.contains(&name) {
            entry.named.push(name);
        }
    }

    fn entry(&mut self, kind: Kind) -> &mut Entry {
        let place = self.entries.iter().position(|entry| entry.kind == kind).unwrap_or_else(|| {
            self.entries.push(Entry { kind, count: 0, named: Vec::new() });
            self.entries.len() - 1
        });
        &mut self.entries[place]
    }

    /// Each kind in a few words: `3 normal textures`, `1 extension (KHR_materials_sheen)`.
    pub(super) fn words(self) -> Vec<String> {
        let words = |Entry { kind: (one, many), count, named }: Entry| {
            let what = if count == 1 { format!("1 {one}") } else { format!("{count} {many}") };
            match (named.is_empty(), count > NAMED) {
                (true, _) => what,
                (false, false) => format!("{what} ({})", named.join(", ")),
                (false, true) => format!("{what} ({}, ...)", named.join(", ")),
            }
        };
        self.entries.into_iter().filter(|entry| entry.count > 0).map(words).collect()
    }
}
