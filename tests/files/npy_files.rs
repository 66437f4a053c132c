//! NPY as NumPy and others write it, byte by byte.

use glam::UVec2;
use varikernel::image::Image;

use crate::{assert_refused, read, small_map, written};

/// Version 1 of the format: signature, length of the header, header, data.
fn npy(header: &str, data: &[u8]) -> Vec<u8> {
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    [b"\x93NUMPY\x01\x00", length.as_slice(), header.as_bytes(), data].concat()
}

pub(crate) fn array(descr: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    npy(&format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}\n"), data)
}

/// Two rows of three.
fn expected() -> Image<u32> {
    Image::from_values(UVec2::new(3, 2), vec![1, 0, 100, 7, 2, 3])
}

#[test]
fn every_dtype_in_both_byte_orders() {
    macro_rules! samples {
        ($values:tt, $($name:literal $type:ty),*) => {$(
            let values: [$type; 6] = $values;
            let little: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            let big: Vec<u8> = values.iter().flat_map(|value| value.to_be_bytes()).collect();
            assert_eq!(read("a.npy", &array(concat!("<", $name), "(2, 3)", &little)).unwrap(), expected());
            assert_eq!(read("a.npy", &array(concat!(">", $name), "(2, 3)", &big)).unwrap(), expected());
        )*};
    }
    samples!([1, 0, 100, 7, 2, 3], "u1" u8, "u2" u16, "u4" u32, "u8" u64);
    samples!([1, 0, 100, 7, 2, 3], "i1" i8, "i2" i16, "i4" i32, "i8" i64);
    samples!([1., 0., 100., 7., 2., 3.], "f4" f32, "f8" f64);
    // Halves by hand: 1 is 2^0, 100 is 1.5625 * 2^6, 7 is 1.75 * 2^2, 2 is 2^1, 3 is 1.5 * 2^1.
    let halves = [0x3c00_u16, 0, 0x5640, 0x4700, 0x4000, 0x4200];
    let little: Vec<u8> = halves.iter().flat_map(|half| half.to_le_bytes()).collect();
    let big: Vec<u8> = halves.iter().flat_map(|half| half.to_be_bytes()).collect();
    assert_eq!(read("a.npy", &array("<f2", "(2, 3)", &little)).unwrap(), expected());
    assert_eq!(read("a.npy", &array(">f2", "(2, 3)", &big)).unwrap(), expected());

    assert_eq!(read("a.npy", &array("|u1", "(2, 3)", &[1, 0, 100, 7, 2, 3])).unwrap(), expected());
    let mask = Image::from_values(UVec2::new(2, 1), vec![1, 0]);
    assert_eq!(read("a.npy", &array("|b1", "(1, 2)", &[1, 0])).unwrap(), mask);
}

#[test]
fn fortran_order_is_column_after_column() {
    let header = "{'descr': '|u1', 'fortran_order': True, 'shape': (2, 3), }";
    assert_eq!(read("a.npy", &npy(header, &[1, 7, 0, 2, 100, 3])).unwrap(), expected());
}

#[test]
fn other_spellings_of_the_header() {
    let header = "{\"shape\" : (2,3),\"fortran_order\":False,\"descr\":\"|u1\"}";
    assert_eq!(read("a.npy", &npy(header, &[1, 0, 100, 7, 2, 3])).unwrap(), expected());

    // As Python 2 writes them, and as numpy.save does where others do not.
    for header in [
        "{'descr': '|u1', 'fortran_order': False, 'shape': (2L, 3L), }",
        "{'descr': '|u1', 'fortran_order': False, 'shape': (2L, 3L)}          \n",
        "{u'descr': u'|u1', u'fortran_order': False, u'shape': (2, 3)}",
        "{u\"descr\": u\"|u1\", u\"fortran_order\": False, u\"shape\": (2l, 3l,), }",
        "{'descr': b'|u1', 'fortran_order': False, 'shape': (2, 3)}",
        "{ 'descr' :\t'|u1' ,\n 'fortran_order' : False , 'shape' : ( 2 , 3 , ) , }",
        "{'shape': (2, 3), 'descr': '|u1', 'fortran_order': False}",
    ] {
        assert_eq!(read("a.npy", &npy(header, &[1, 0, 100, 7, 2, 3])).unwrap(), expected(), "{header}");
    }

    let header = "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 3), }\n";
    let length = u32::try_from(header.len()).unwrap().to_le_bytes();
    let version_2 =
        [b"\x93NUMPY\x02\x00", length.as_slice(), header.as_bytes(), &[1, 0, 100, 7, 2, 3]].concat();
    assert_eq!(read("a.npy", &version_2).unwrap(), expected());
}

#[test]
fn the_file_written_is_the_one_that_numpy_writes() {
    // numpy.save(file, numpy.array([[258, 1]], "u4")), by the description of the format.
    let text = "{'descr': '<u4', 'fortran_order': False, 'shape': (1, 2), }";
    let header = format!("{text:117}\n");
    let image = Image::from_values(UVec2::new(2, 1), vec![258, 1]);
    assert_eq!(written("a.npy", &image), npy(&header, &[2, 1, 0, 0, 1, 0, 0, 0]));
}

#[test]
fn values_that_are_no_counts() {
    let floats = |values: [f64; 6]| {
        let data: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        read("a.npy", &array("<f8", "(2, 3)", &data))
    };
    assert_refused(
        floats([0., 1., 2., 3., -2., -1.]),
        &["(1, 1)", "-2.0, negative", "2 of 6", "number of photons"],
    );
    assert_refused(floats([0., 1., 2.5, 3., 4., 5.]), &["(2, 0)", "2.5, not a whole number", "1 of 6"]);
    assert_refused(
        floats([0., 1., 2., f64::NAN, 4., 5.]),
        &["(0, 1)", "NaN, not a number", "0 where there are none"],
    );
    assert_refused(floats([f64::INFINITY, 1., 2., 3., 4., 5.]), &["(0, 0)", "inf, infinite"]);
    assert_refused(
        floats([0., 4_294_967_296., 2., 3., 4., 5.]),
        &["(1, 0)", "4294967296.0, above 4294967295"],
    );
    assert_eq!(floats([-0., 4_294_967_295., 2., 3., 4., 5.]).unwrap().at(1, 0), u32::MAX);

    let negative = array("|i1", "(1, 2)", &[5, 0xff]);
    assert_refused(read("a.npy", &negative), &["(1, 0)", "-1, negative", "1 of 2"]);
    let large = array("<u8", "(1, 1)", &[0, 0, 0, 0, 1, 0, 0, 0]);
    assert_refused(read("a.npy", &large), &["(0, 0)", "4294967296, above"]);
    // 1.5, and the largest half is a count; infinity is 2^16 by its exponent.
    assert_refused(read("a.npy", &array("<f2", "(1, 1)", &[0x00, 0x3e])), &["is 1.5, not a whole number"]);
    assert_refused(read("a.npy", &array(">f2", "(1, 1)", &[0x7c, 0x00])), &["is inf, infinite"]);
    assert_refused(read("a.npy", &array(">f2", "(1, 1)", &[0x7e, 0x00])), &["is NaN, not a number"]);
    assert_eq!(read("a.npy", &array(">f2", "(1, 1)", &[0x7b, 0xff])).unwrap().values(), [65504]);
    let f4 = array("<f4", "(1, 1)", &0.1_f32.to_le_bytes());
    assert_refused(read("a.npy", &f4), &["is 0.1, not a whole number"]);
}

#[test]
fn the_first_refused_pixel_is_that_of_the_image_in_fortran_order_too() {
    let header = "{'descr': '|i1', 'fortran_order': True, 'shape': (2, 3), }";
    let data = [1, 0x80, 0, 2, 0xff, 3];
    assert_refused(read("a.npy", &npy(header, &data)), &["(2, 0) is -1", "2 of 6"]);
}

#[test]
fn arrays_that_are_no_map() {
    for dtype in ["<c8", "<U5", "|S4", "|O", "<m8[s]", "<f16", "<u3", "=u4", "", "u", "<é4"] {
        assert_refused(read("a.npy", &array(dtype, "(2, 3)", &[0; 64])), &[dtype, "dtype", "astype"]);
    }
    let structured = npy("{'descr': [('a', '<u4')], 'fortran_order': False, 'shape': (1, 1), }", &[0; 4]);
    assert_refused(read("a.npy", &structured), &["structured"]);
    for (shape, count) in [("()", "0"), ("(6,)", "1"), ("(1, 2, 3)", "3")] {
        assert_refused(
            read("a.npy", &array("|u1", shape, &[0; 6])),
            &[shape, &format!("{count} dimensions")],
        );
    }
    for shape in ["(0, 5)", "(5, 0)"] {
        assert_refused(read("a.npy", &array("|u1", shape, &[])), &["no pixels"]);
    }
}

#[test]
fn headers_that_claim_too_much() {
    let claims = |shape| read("a.npy", &array("<f8", shape, &[0; 8]));
    assert_refused(claims("(1000000000, 1000000000)"), &["1000000000 x 1000000000", "65536 a side"]);
    assert_refused(claims("(18446744073709551615, 2)"), &["18446744073709551615", "65536 a side"]);
    assert_refused(claims("(99999999999999999999, 2)"), &["\"shape\""]);
    assert_refused(claims("(-1, 2)"), &["\"shape\""]);
    assert_refused(claims("(1LL, 2)"), &["\"shape\""]);
    assert_refused(claims("(L, 2)"), &["\"shape\""]);
    assert_refused(claims("(16385, 16384)"), &["16384 x 16385", "268435456 in all"]);
    assert_refused(claims("(16384, 16384)"), &["truncated", "2147483648 bytes", "has 8"]);

    let endless = [b"\x93NUMPY\x02\x00", 0xffff_ffff_u32.to_le_bytes().as_slice()].concat();
    assert_refused(read("a.npy", &endless), &["4294967295"]);
}

#[test]
fn data_that_ends_too_early() {
    assert_refused(read("a.npy", &array("<u2", "(2, 3)", &[0; 11])), &["truncated", "12 bytes", "has 11"]);
}

#[test]
fn what_follows_the_data_is_not_read() {
    // As numpy.load does with the first of several arrays in a file.
    let first = array("|u1", "(2, 3)", &[1, 0, 100, 7, 2, 3]);
    let second = array("<f8", "(1,)", &[0xff; 8]);
    assert_eq!(read("a.npy", &[first.clone(), second].concat()).unwrap(), expected());
    assert_eq!(read("a.npy", &[first, vec![0]].concat()).unwrap(), expected());
}

#[test]
fn headers_that_are_broken() {
    let nested = npy(&"(".repeat(60_000), &[]);
    assert_refused(read("a.npy", &nested), &["\"descr\""]);
    for (header, key) in [
        ("{}", "descr"),
        ("{'descr'}", "descr"),
        ("{'descr': '<u4}", "descr"),
        ("{'descr': é", "descr"),
        ("{'descr': '<u4', 'fortran_order': Maybe}", "fortran_order"),
        ("{'descr': '<u4', 'fortran_order': True, 'shape': 5}", "shape"),
        ("{'descr': '<u4', 'fortran_order': True, 'shape': (5", "shape"),
        ("{'descr': '<u4', 'fortran_order': True, 'shape': (5.0, 1)}", "shape"),
    ] {
        assert_refused(read("a.npy", &npy(header, &[0; 4])), &[&format!("entry \"{key}\"")]);
    }
    assert_refused(read("a.npy", &npy("\u{0}", &[])), &["entry"]);
    assert_refused(read("a.npy", b"\x93NUMPY\x09\x00\x01\x00 "), &["version 9"]);
    let mut not_text = written("a.npy", &small_map());
    not_text[20] = 0xff;
    assert_refused(read("a.npy", &not_text), &["header could not be read"]);
}
