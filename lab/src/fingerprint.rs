//! A short name for many bytes.

/// FNV-1a, 64 bits, as 16 hexadecimal digits: the same for the same bytes on every machine, and no proof
/// against forgery.
#[must_use]
pub(super) fn fingerprint(bytes: impl IntoIterator<Item = u8>) -> String {
    let hash = bytes.into_iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_values() {
        // Test vectors of G. Fowler, L. C. Noll, K.-P. Vo and D. Eastlake, "The FNV Non-Cryptographic Hash
        // Algorithm".
        assert_eq!(fingerprint(*b""), "cbf29ce484222325");
        assert_eq!(fingerprint(*b"a"), "af63dc4c8601ec8c");
        assert_eq!(fingerprint(*b"foobar"), "85944171f73967e8");
    }
}
