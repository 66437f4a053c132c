//! Files that the library would not write, made byte by byte.

use std::io::Cursor;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, Layer, LayerAttributes,
    WritableImage,
};

/// An NPY of the dtype and the shape as Python writes them.
pub(crate) fn npy(dtype: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}\n");
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    [b"\x93NUMPY\x01\x00", length.as_slice(), header.as_bytes(), data].concat()
}

/// An EXR of one row, with f32 channels.
pub(crate) fn exr(channels: &[(&str, &[f32])]) -> Vec<u8> {
    let size = (channels[0].1.len(), 1);
    let channels =
        channels.iter().map(|(name, samples)| AnyChannel::new(*name, FlatSamples::F32(samples.to_vec())));
    let layer = Layer::new(
        size,
        LayerAttributes::default(),
        Encoding::FAST_LOSSLESS,
        AnyChannels::sort(channels.collect()),
    );
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layers(ImageAttributes::with_size(size), vec![layer])
        .write()
        .to_buffered(&mut bytes)
        .unwrap();
    bytes.into_inner()
}

/// A PNG with a header alone, whose checksum is right; `colours` is 0 for grey and 2 for RGB.
pub(crate) fn png_header(width: u32, height: u32, colours: u8) -> Vec<u8> {
    let size = [width.to_be_bytes(), height.to_be_bytes()].concat();
    let chunk = [b"IHDR", size.as_slice(), &[8, colours, 0, 0, 0]].concat();
    let checksum = !chunk.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| (sum >> 1) ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 })
    });
    [b"\x89PNG\r\n\x1a\n", [0, 0, 0, 13].as_slice(), &chunk, &checksum.to_be_bytes()].concat()
}
