//! Photons on their way to the picture, and the radii of their kernels.

use super::{PhotonTotals, RadiusMap};
use crate::error::{Error, Result};
use crate::gl::{Gl, StateGuard, Vertices};
use crate::photon::PhotonPoint;

/// Photons in a buffer: as many as the table of their areas has entries, and few enough that sums of one
/// buffer's kernels stay exact to about 2^-9 (see `splat`).
const CHUNK: u32 = 1 << 16;

/// Photons on the GPU.
#[derive(Debug)]
pub struct PhotonPoints {
    gl: Gl,
    chunks: Vec<Vertices>,
    /// Buffers that [`replace`](Self::replace) left over.
    spare: Vec<Vertices>,
    borrowed: bool,
    /// Unknown of a host's.
    totals: Option<PhotonTotals>,
}

impl PhotonPoints {
    /// None yet.
    #[must_use]
    pub fn new(gl: &Gl) -> Self {
        Self {
            gl: gl.clone(),
            chunks: Vec::new(),
            spare: Vec::new(),
            borrowed: false,
            totals: Some(PhotonTotals::default()),
        }
    }

    /// Reads the first `count` photons of a vertex buffer that the host owns and keeps alive as long as this:
    /// 40 bytes each, as [`PhotonPoint`] has them. Their values may change between frames, not the buffer's
    /// size.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if it is no buffer, or has no room for them; [`Error::Gl`] when names run out.
    pub fn borrow(gl: &Gl, buffer: glow::Buffer, count: u32) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        if count > 0 {
            Vertices::check_room(gl, buffer, count, &PhotonPoint::ATTRIBUTES)?;
        }
        let chunks = (0..count).step_by(CHUNK as usize).map(|first| {
            Vertices::borrow(gl, buffer, first, CHUNK.min(count - first), &PhotonPoint::ATTRIBUTES)
        });
        Ok(Self {
            gl: gl.clone(),
            chunks: chunks.collect::<Result<_>>()?,
            spare: Vec::new(),
            borrowed: true,
            totals: None,
        })
    }

    /// Adds photons; best many at once.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if the buffer is the host's; [`Error::OutOfMemory`].
    pub fn upload(&mut self, photons: &[PhotonPoint]) -> Result<()> {
        self.check_ours()?;
        let _state = StateGuard::new(&self.gl)?;
        for chunk in photons.chunks(CHUNK as usize) {
            let vertices = match self.spare.pop() {
                Some(mut vertices) => vertices.replace(chunk).map(|()| vertices),
                None => Vertices::upload(&self.gl, chunk, &PhotonPoint::ATTRIBUTES)
                    .map(|vertices| vertices.labelled("photons")),
            };
            self.chunks.push(vertices?);
            self.totals = self.totals.map(|totals| totals + PhotonTotals::of(chunk));
        }
        Ok(())
    }

    /// Says what the photons of the host's buffer carry together, or more: light from tables has to know.
    pub fn set_totals(&mut self, totals: PhotonTotals) {
        self.totals = Some(totals);
    }

    /// What they carry together; unknown of a host's buffer until it is set.
    #[must_use]
    pub fn totals(&self) -> Option<&PhotonTotals> {
        self.totals.as_ref()
    }

    /// Puts other photons in the place of all, in the buffers that are there: for photons that are new each
    /// frame.
    ///
    /// # Errors
    /// As [`upload`](Self::upload); there are no photons then.
    pub fn replace(&mut self, photons: &[PhotonPoint]) -> Result<()> {
        self.check_ours()?;
        self.spare.append(&mut self.chunks);
        self.totals = Some(PhotonTotals::default());
        let uploaded = self.upload(photons);
        if uploaded.is_err() {
            self.spare.append(&mut self.chunks);
        }
        uploaded
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.chunks.iter().map(|chunk| u64::from(chunk.count())).sum()
    }

    pub(crate) fn chunks(&self) -> &[Vertices] {
        &self.chunks
    }

    fn check_ours(&self) -> Result<()> {
        if !self.borrowed {
            return Ok(());
        }
        Err(Error::Mismatch {
            what: "photons to add to",
            expected: "a buffer of the library".to_owned(),
            got: "a buffer of the host, which changes it itself".to_owned(),
        })
    }
}

/// Where the radii of kernels come from.
#[derive(Clone, Copy, Debug)]
pub enum KernelRadii<'a> {
    /// Each pixel's own.
    Map(&'a RadiusMap),
    /// The same for all, in pixels, up to [`MAX_PICTURE_RADIUS`](crate::settings::MAX_PICTURE_RADIUS).
    Fixed(u32),
}

impl KernelRadii<'_> {
    /// Whether it is the same for all.
    #[must_use]
    pub fn is_fixed(self) -> bool {
        matches!(self, Self::Fixed(_))
    }
}
