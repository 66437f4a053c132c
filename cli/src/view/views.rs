//! What can be shown of a picture or map, and in which colours.

use glow::Texture;
use varikernel::glam::UVec2;
use varikernel::glow;

/// A stage's result as it is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum View {
    /// Direct and indirect light, tone-mapped.
    Picture,
    /// Light that was reflected more than once.
    Indirect,
    /// Lights, and what they light.
    Direct,
    /// Photons of each pixel.
    Density,
    /// R, or how wide light from tables is gathered, in pixels.
    Radius,
    /// Where MR ended the search with too few photons.
    Limited,
    /// How far the picture is from the reference.
    Error,
}

impl View {
    pub(super) const ALL: [Self; 7] = [
        Self::Picture,
        Self::Indirect,
        Self::Direct,
        Self::Density,
        Self::Radius,
        Self::Limited,
        Self::Error,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Picture => "picture",
            Self::Indirect => "indirect",
            Self::Direct => "direct",
            Self::Density => "density",
            Self::Radius => "radius",
            Self::Limited => "limited",
            Self::Error => "error",
        }
    }

    /// Its number in `glsl/show.frag`.
    pub(super) fn number(self) -> i32 {
        match self {
            Self::Picture | Self::Indirect | Self::Direct => 0,
            Self::Density => 1,
            Self::Radius => 2,
            Self::Limited => 3,
            Self::Error => 4,
        }
    }

    /// Whether a map of counts alone has it.
    pub(super) fn is_of_maps(self) -> bool {
        matches!(self, Self::Density | Self::Radius | Self::Limited)
    }
}

/// What an engine or a snapshot has to show; textures have row 0 at the top.
#[derive(Clone, Copy, Debug)]
pub(super) struct Maps {
    pub(super) size: UVec2,
    pub(super) beauty: Option<Texture>,
    pub(super) indirect: Option<Texture>,
    pub(super) direct: Option<Texture>,
    pub(super) density: Option<Texture>,
    pub(super) radii: Option<Texture>,
    pub(super) limited: Option<Texture>,
    /// Whether the radii are the widths of light from tables.
    pub(super) widths: bool,
    /// What the colours of the densities and the radii end at.
    pub(super) most_photons: f32,
    pub(super) max_radius: u32,
}

impl Maps {
    /// A view's name.
    pub(super) fn name(&self, view: View) -> &'static str {
        if self.widths && view == View::Radius { "width" } else { view.name() }
    }

    /// The tool tip of a view's name.
    pub(super) fn words(&self, view: View) -> &'static str {
        match view {
            View::Picture => "Direct and indirect light, tone-mapped",
            View::Indirect => "Light that was reflected more than once: what photons bring",
            View::Direct => "Lights, and what they light",
            View::Density => "Photons of each pixel",
            View::Radius if self.widths => "How wide each pixel's light is gathered; 0 is a pixel alone",
            View::Radius => "R: the smallest box that holds n photons",
            View::Limited => "Where MR ended the search with too few photons",
            View::Error => "Difference from the reference on the screen",
        }
    }

    /// What the colours of a view stand for, with the unit; nothing for pictures.
    pub(super) fn unit(&self, view: View) -> Option<&'static str> {
        match view {
            View::Picture | View::Indirect | View::Direct => None,
            View::Density => Some("photons a pixel"),
            View::Radius if self.widths => Some("width of light: radius in pixels"),
            View::Radius => Some("radius R in pixels"),
            View::Limited => Some("red: box of MR holds too few"),
            View::Error => Some("levels of 255, of the worst colour"),
        }
    }

    /// The floats and the whole numbers that a view reads.
    pub(super) fn of(&self, view: View) -> (Option<Texture>, Option<Texture>) {
        match view {
            View::Picture | View::Error => (self.beauty, None),
            View::Indirect => (self.indirect, None),
            View::Direct => (self.direct, None),
            View::Density => (self.density, None),
            View::Radius => (None, self.radii),
            View::Limited => (self.beauty, self.limited),
        }
    }

    /// The values at the ends of a view's colours.
    pub(super) fn range(&self, view: View) -> [f32; 2] {
        match view {
            View::Picture | View::Indirect | View::Direct | View::Limited => [0.0, 1.0],
            View::Density => [0.0, self.most_photons],
            View::Radius if self.widths => [0.0, self.max_radius as f32],
            View::Radius => [1.0, self.max_radius.max(2) as f32],
            View::Error => [0.0, 63.0],
        }
    }
}

/// The next of 1, 2, 5, 10, 20, 50 and so on, so that a legend stays while photons come.
pub(super) fn round_up(value: f32) -> f32 {
    let value = value.max(1.0);
    let power = 10.0_f32.powf(value.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|&end| end >= value * 0.9999)
        .unwrap_or(value)
}

/// Where a value lies on a legend's bar, from 0 to 1; as in `glsl/show.frag`.
pub(super) fn place(value: f32, [low, high]: [f32; 2]) -> f32 {
    ((value.clamp(low, high) + 1.0) / (low + 1.0)).ln() / ((high + 1.0) / (low + 1.0)).ln()
}

/// Values to be written on a legend's bar: its ends, and of 1, 2, 5, 10 and so on those that leave `room` to
/// their neighbours, as a share of the bar.
pub(super) fn ticks(range: [f32; 2], room: f32) -> Vec<f32> {
    let mut ticks = vec![range[0]];
    let steps = (0..10).flat_map(|power| [1.0, 2.0, 5.0].map(|factor| factor * 10.0_f32.powi(power)));
    for value in steps.filter(|&value| value > range[0] && value < range[1]) {
        let at = place(value, range);
        let before = ticks.last().map_or(0.0, |&last| place(last, range));
        if at - before > room && 1.0 - at > 1.2 * room {
            ticks.push(value);
        }
    }
    ticks.push(range[1]);
    ticks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn legends_by_hand() {
        let rounded = [0.0, 1.0, 1.5, 20.0, 21.0, 99.0].map(|value| round_up(value) as u32);
        assert_eq!(rounded, [1, 1, 2, 20, 50, 100]);
        // (1 + 1)² = 3 + 1: 1 lies halfway from 0 to 3.
        let places = [0.0, 1.0, 3.0, 9.0].map(|value| (100.0 * place(value, [0.0, 3.0])).round() as u32);
        assert_eq!(places, [0, 50, 100, 100]);
        assert_eq!(ticks([1.0, 64.0], 0.09), [1.0, 2.0, 5.0, 10.0, 20.0, 64.0]);
        assert_eq!(ticks([1.0, 64.0], 0.25), [1.0, 5.0, 20.0, 64.0]);
    }
}
