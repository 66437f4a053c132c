//! Places that the pixels around show.

use std::ops::Range;

use glam::{IVec2, UVec2};

use super::nearest::LEAST_AGREEMENT;
use super::sight::Place;

/// Places by pixels.
pub(super) struct Neighbours<'a> {
    size: UVec2,
    pub(super) places: &'a [Place],
    /// Where the places of each pixel begin, and where the last end.
    begins: Vec<usize>,
}

impl<'a> Neighbours<'a> {
    /// Of a picture of `size`; places are in the order of their pixels.
    pub(super) fn new(size: UVec2, places: &'a [Place]) -> Self {
        let mut begins = Vec::with_capacity(size.element_product() as usize + 1);
        let mut begin = 0;
        for pixel in 0..=size.element_product() {
            begin += places[begin..].iter().take_while(|place| place.pixel < pixel).count();
            begins.push(begin);
        }
        Self { size, places, begins }
    }

    /// The places of a pixel.
    pub(super) fn of_pixel(&self, pixel: u32) -> Range<usize> {
        self.begins[pixel as usize]..self.begins[pixel as usize + 1]
    }

    /// The places of the pixel that is so far away from another.
    pub(super) fn at(&self, pixel: u32, away: IVec2) -> Range<usize> {
        let at = UVec2::new(pixel % self.size.x, pixel / self.size.x).as_ivec2() + away;
        let inside = at.cmpge(IVec2::ZERO).all() && at.cmplt(self.size.as_ivec2()).all();
        let at = at.as_uvec2();
        if inside { self.of_pixel(at.y * self.size.x + at.x) } else { 0..0 }
    }

    /// The places of the pixel that is so far away, on the same surface.
    pub(super) fn of(&self, place: &Place, away: IVec2) -> impl Iterator<Item = usize> {
        self.at(place.pixel, away).filter(|&index| {
            let other = &self.places[index];
            (other.surface - place.surface).abs() < 0.5 && other.normal.dot(place.normal) > LEAST_AGREEMENT
        })
    }
}
