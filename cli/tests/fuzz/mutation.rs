//! Files that are nearly right: seeds with some of their bytes, numbers, lines or parts changed.

use rand::seq::IndexedRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

/// Numbers that readers trip over, as text.
const WORDS: [&str; 24] = [
    "0",
    "-0",
    "-1",
    "1",
    "2",
    "3",
    "255",
    "256",
    "65535",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551616",
    "99999999999999999999999",
    "1e39",
    "-1e39",
    "1e-46",
    "1e999",
    "nan",
    "inf",
    "0.1",
    "1,5",
];
/// The same as bytes.
const NUMBERS: [i64; 12] =
    [0, 1, -1, 2, 0x7f, 0x80, 0xff, 0x7fff, 0xffff, 0x7fff_ffff, 0xffff_ffff, i64::MAX];
/// Changes of one file, at most.
const MOST: u32 = 8;
/// A file does not grow past this, in bytes.
const LONGEST: usize = 1 << 20;

/// A source of changed files.
pub(crate) struct Mutator {
    random: Pcg64,
}

impl Mutator {
    pub(crate) fn new(seed: u64) -> Self {
        Self { random: Pcg64::seed_from_u64(seed) }
    }

    /// One of `seeds`, changed; parts of the others may be put into it.
    pub(crate) fn file(&mut self, seeds: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = seeds.choose(&mut self.random).cloned().unwrap_or_default();
        for _ in 0..self.random.random_range(1..=MOST) {
            self.change(&mut bytes, seeds);
            bytes.truncate(LONGEST);
        }
        bytes
    }

    fn change(&mut self, bytes: &mut Vec<u8>, seeds: &[Vec<u8>]) {
        match self.random.random_range(0..10) {
            0 => {
                if let Some(at) = self.place(bytes.len()) {
                    bytes[at] ^= 1 << self.random.random_range(0..8);
                }
            }
            1 => {
                if let Some(at) = self.place(bytes.len()) {
                    bytes[at] = self.random.random();
                }
            }
            2 => {
                let number = NUMBERS.choose(&mut self.random).copied().unwrap_or_default().to_le_bytes();
                let width = [1, 2, 4, 8].choose(&mut self.random).copied().unwrap_or(1);
                if let Some(at) = self.place(bytes.len().saturating_sub(width)) {
                    bytes[at..at + width].copy_from_slice(&number[..width]);
                }
            }
            3 => {
                let (from, to) = self.range(bytes.len());
                bytes.drain(from..to);
            }
            4 => {
                let (from, to) = self.range(bytes.len());
                let part = bytes[from..to].to_vec();
                bytes.splice(to..to, part);
            }
            5 => {
                let other = seeds.choose(&mut self.random).cloned().unwrap_or_default();
                let (from, to) = self.range(other.len());
                let at = self.place(bytes.len()).unwrap_or(0);
                bytes.splice(at..at, other[from..to].iter().copied());
            }
            6 => {
                let end = self.place(bytes.len()).unwrap_or(0);
                bytes.truncate(end);
            }
            7 => self.change_line(bytes),
            // The likeliest to get far into a reader of text.
            _ => self.change_number(bytes),
        }
    }

    fn place(&mut self, length: usize) -> Option<usize> {
        (length > 0).then(|| self.random.random_range(0..length))
    }

    /// A part of a file, short ones more often.
    fn range(&mut self, length: usize) -> (usize, usize) {
        let from = self.place(length).unwrap_or(0);
        let longest = if self.random.random_bool(0.8) { 32 } else { length };
        let to = from + self.random.random_range(0..=longest.min(length - from));
        (from, to)
    }

    /// Puts a line twice, away, or somewhere else.
    fn change_line(&mut self, bytes: &mut Vec<u8>) {
        let mut lines: Vec<Vec<u8>> =
            bytes.split_inclusive(|&byte| byte == b'\n').map(<[u8]>::to_vec).collect();
        let Some(from) = self.place(lines.len()) else { return };
        let line = lines[from].clone();
        let to = self.random.random_range(0..=lines.len());
        match self.random.random_range(0..3) {
            0 => lines.insert(to, line),
            1 => drop(lines.remove(from)),
            _ => {
                lines.insert(to, line);
                lines.remove(if to <= from { from + 1 } else { from });
            }
        }
        *bytes = lines.concat();
    }

    /// Puts another number in the place of a run of digits.
    fn change_number(&mut self, bytes: &mut Vec<u8>) {
        let is_digit = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
        let starts: Vec<usize> = (0..bytes.len())
            .filter(|&at| is_digit(&bytes[at]) && (at == 0 || !is_digit(&bytes[at - 1])))
            .collect();
        let Some(&from) = starts.choose(&mut self.random) else { return };
        let to = bytes[from..].iter().position(|byte| !is_digit(byte)).map_or(bytes.len(), |end| from + end);
        let word = WORDS.choose(&mut self.random).copied().unwrap_or("0");
        bytes.splice(from..to, word.bytes());
    }
}
