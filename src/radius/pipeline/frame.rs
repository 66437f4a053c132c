//! A frame: what differs from the one before is built, then searched.

use super::{Built, Pixels, RadiusPipeline};
use crate::error::{Error, Result};
use crate::gl::{self, Gl, Sample, StateGuard};
use crate::maps::exactness::{self, CountBounds};
use crate::maps::{Changed, DensityMap, Frame, Mask, RadiusMap, Rectangle, describe};

/// Half of a frame, to be run once.
type Half<'a> = &'a mut dyn FnMut() -> Result<()>;

impl RadiusPipeline {
    /// Builds the structure and searches: all that a frame needs when nothing is known of the one before.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if the map's size or format is another than the pipeline's; [`Error::Inexact`] if
    /// the map's bounds do not prove the result exact and
    /// [`Laboratory::exactness`](crate::settings::Laboratory::exactness) asks for that; [`Error::Gl`] if the
    /// driver fails; [`Error::ContextLost`], from then on for every call.
    pub fn render(&mut self, density: &DensityMap) -> Result<&RadiusMap> {
        self.update(&Frame::new(density))
    }

    /// Builds and searches what differs from the frame before, for the pixels that need a radius.
    ///
    /// Of [`Frame::changed`], the pipeline believes what it can use: it starts anew when it has no frame
    /// before, or one of another map, or one whose counts were taken in otherwise. Only tables built by a
    /// scan and bracketed searches leave out what did not change; others do all of it, or the rectangle with
    /// a margin of MR.
    ///
    /// # Errors
    /// As [`render`](Self::render); [`Error::Mismatch`] also if the mask is not expected, or of another size;
    /// [`Error::Setting`] for photons to be added without a summed-area table.
    pub fn update(&mut self, frame: &Frame<'_>) -> Result<&RadiusMap> {
        self.update_by(frame, &mut |_, half| half())
    }

    /// As [`update`](Self::update), with the times of its halves: the build and the search. Waits for the
    /// GPU; [`StageTimes`](crate::gl::StageTimes) times the passes without waiting.
    ///
    /// # Errors
    /// As [`update`](Self::update); [`Error::QueryRunning`] while a GL_TIME_ELAPSED query of the host runs.
    pub fn update_timed(&mut self, frame: &Frame<'_>) -> Result<(&RadiusMap, [Sample; 2])> {
        let mut samples = Vec::new();
        self.update_by(frame, &mut |gl, half| {
            let ((), sample) = gl::time(gl, half)?;
            samples.push(sample);
            Ok(())
        })?;
        let [build, search] = samples[..] else { unreachable!("a frame has two halves") };
        Ok((self.search.radii(), [build, search]))
    }

    /// A frame whose halves are run by `run`.
    fn update_by(
        &mut self,
        frame: &Frame<'_>,
        run: &mut dyn FnMut(&Gl, Half<'_>) -> Result<()>,
    ) -> Result<&RadiusMap> {
        self.check_mask(frame)?;
        let plans = self.planner.is_some() && frame.changed != Changed::Nothing;
        if plans {
            self.check(frame)?;
            self.plan_frame(frame)?;
        }
        let gl = self.gl.clone();
        let outcome = run(&gl, &mut || self.build_frame(frame))
            .and_then(|()| run(&gl, &mut || self.search_frame(frame).map(drop)));
        if outcome.is_err() {
            // The radii may be of an older frame than the table.
            self.searched = None;
        }
        outcome?;
        if plans && let Some(planner) = &mut self.planner {
            planner.count(&self.tables, frame.density)?;
        }
        Ok(self.search.radii())
    }

    /// Fills the intermediate structure: the first half of [`render`](Self::render), apart for timing.
    ///
    /// # Errors
    /// As [`render`](Self::render).
    pub fn build(&mut self, density: &DensityMap) -> Result<()> {
        self.searched = None;
        self.build_frame(&Frame::new(density))
    }

    /// Searches the structure that [`build`](Self::build) last filled, from the same map.
    ///
    /// # Errors
    /// As [`render`](Self::render), and [`Error::Mismatch`] if the structure was not built from this map.
    pub fn search(&mut self, density: &DensityMap) -> Result<&RadiusMap> {
        self.search_frame(&Frame::new(density))
    }

    /// The second half of [`update`](Self::update) alone, with all that is in the frame: another mask, for
    /// one.
    ///
    /// # Errors
    /// As [`search`](Self::search) and [`update`](Self::update).
    pub fn search_frame(&mut self, frame: &Frame<'_>) -> Result<&RadiusMap> {
        let built = self.check_built(frame)?;
        self.check_mask(frame)?;
        let pixels = if frame.mask.is_some() { Pixels::OfMask } else { Pixels::All };
        let changed = if self.searched == Some(pixels) { frame.changed } else { Changed::Everything };
        if changed == Changed::Nothing {
            return Ok(self.search.radii());
        }
        let frame = Frame { changed, mask: frame.mask.or(self.every_pixel.as_ref()), ..*frame };
        let _state = StateGuard::new(&self.gl)?;
        self.searched = None;
        if built.is_empty() {
            self.search.find_nothing(&frame)?;
        } else {
            self.search.estimate(&frame, &self.tables)?;
        }
        self.gl.check("searching radii")?;
        self.searched = Some(pixels);
        Ok(self.search.radii())
    }

    /// The first half of [`update`](Self::update).
    fn build_frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        self.check(frame)?;
        let density = frame.density;
        let map = density.texture();
        let before = self.built.filter(|built| !built.is_empty());
        let bounds = self.bounds_with(frame);
        let plan = exactness::plan(&self.settings, self.size, bounds)?;
        let whole = Rectangle::whole(self.size);
        let (changed, adds) = match (frame.changed, before) {
            (Changed::Nothing, _) if self.built.is_some_and(|built| built.map == map) => return Ok(()),
            (Changed::Added, Some(_)) => (Some(whole), true),
            (Changed::Rectangle { first, size }, Some(built))
                if (built.map, built.plan, built.grown) == (map, plan, false) =>
            {
                (Rectangle::inside(self.size, first, size), false)
            }
            // Nothing that is there is of use.
            _ => {
                self.searched = None;
                (Some(whole), false)
            }
        };
        if adds && plan.count_limit != u32::MAX {
            return Err(Error::Inexact {
                reason: "so many photons were added that a box may hold more than the sums do, and counts \
                         that came in parts cannot be clamped to n"
                    .to_owned(),
                remedy: "give the map of all photons anew (Changed::Everything)".to_owned(),
            });
        }
        let _state = StateGuard::new(&self.gl)?;
        self.built = None;
        match changed {
            // No box can hold a photon, so that none will be counted.
            _ if bounds.total == 0 => (),
            Some(_) if adds => self.tables.add(density, plan)?,
            Some(changed) => self.tables.build(density, plan, changed)?,
            None => (),
        }
        self.gl.check("building the intermediate structure")?;
        self.built = Some(Built { map, plan, bounds, grown: adds });
        Ok(())
    }

    /// Lets the planner decide on a frame.
    fn plan_frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        let bounds = self.bounds_with(frame);
        let Some(planner) = &mut self.planner else { return Ok(()) };
        let order = planner.decide(&self.settings, bounds)?;
        self.set_order(order)
    }

    /// Bounds of all photons that the structure will hold after a frame: its own, and those that it adds to.
    fn bounds_with(&self, frame: &Frame<'_>) -> CountBounds {
        let bounds = frame.density.bounds();
        let before = self.built.filter(|built| frame.changed == Changed::Added && !built.is_empty());
        before.map_or(bounds, |built| built.bounds.with(bounds))
    }

    pub(super) fn check_built(&self, frame: &Frame<'_>) -> Result<Built> {
        self.check(frame)?;
        self.built.filter(|built| built.map == frame.density.texture()).ok_or_else(|| Error::Mismatch {
            what: "density map of the search",
            expected: "the one that was built last".to_owned(),
            got: "another, or none was built".to_owned(),
        })
    }

    fn check(&self, frame: &Frame<'_>) -> Result<()> {
        self.gl.current()?;
        let density = frame.density;
        if density.size() == self.size && density.format() == self.density_format {
            return Ok(());
        }
        Err(Error::Mismatch {
            what: "density map",
            expected: describe(self.size, self.density_format),
            got: describe(density.size(), density.format()),
        })
    }

    /// Checks what a search reads beside the map.
    fn check_mask(&self, frame: &Frame<'_>) -> Result<()> {
        let mismatch = |what, expected: &str, got: &str| {
            Err(Error::Mismatch { what, expected: expected.to_owned(), got: got.to_owned() })
        };
        if frame.mask.is_some() && !self.settings.masked {
            return mismatch("mask", "none, as the pipeline's settings have `masked` false", "one");
        }
        if let Some(mask) = frame.mask.filter(|mask| mask.size() != self.size) {
            return Err(Error::size("mask", self.size, mask.size()));
        }
        let inputs = [Some(frame.density.as_texture()), frame.mask.map(Mask::texture)];
        if inputs.into_iter().flatten().any(|input| self.search.radii().is_written_to(input.name())) {
            return mismatch("density map or mask", "a texture of the host", "the pipeline's own output");
        }
        Ok(())
    }
}
