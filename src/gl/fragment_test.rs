//! A mask of the fragments that pass a host's depth or stencil test.

use glow::HasContext as _;

use super::{Gl, Pass, StateGuard, Target, error_name};
use crate::error::{Error, Result};

/// What a fragment has to pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FragmentTest {
    /// The bits of the stencil value that are set in `bits` equal those of `reference`.
    Stencil {
        /// The value to compare with.
        reference: u8,
        /// The bits that count.
        bits: u8,
    },
    /// The depth is not that of the far plane: less than 1, or more than 0 where depth is reversed.
    Depth {
        /// Whether the far plane is at 0.
        reversed: bool,
    },
}

impl FragmentTest {
    /// GL_DEPTH_STENCIL_ATTACHMENT fits both kinds of test, GL_DEPTH_ATTACHMENT textures without stencil.
    fn attachments(self) -> &'static [u32] {
        match self {
            Self::Stencil { .. } => &[glow::DEPTH_STENCIL_ATTACHMENT, glow::STENCIL_ATTACHMENT],
            Self::Depth { .. } => &[glow::DEPTH_STENCIL_ATTACHMENT, glow::DEPTH_ATTACHMENT],
        }
    }
}

/// Draws `pass` over `target`, cleared to 0, where the host's `texture` of depth or stencil passes `test`.
///
/// # Errors
/// [`Error::Mismatch`] if the texture can't be attached to a target of this size; those of the pass.
pub(crate) fn fill_where(
    pass: Pass<'_>,
    gl: &Gl,
    texture: glow::Texture,
    test: FragmentTest,
    target: &mut Target,
) -> Result<()> {
    let _state = StateGuard::new(gl)?;
    gl.current()?;
    target.clear(&[0]);
    attach(gl, target, texture, test)?;
    let tests = match test {
        FragmentTest::Stencil { .. } => StateGuard::of_stencil_tests(gl),
        FragmentTest::Depth { .. } => StateGuard::of_depth_tests(gl),
    };
    // SAFETY: the context is current while the handle lives.
    unsafe {
        let glow = gl.glow();
        match test {
            FragmentTest::Stencil { reference, bits } => {
                glow.enable(glow::STENCIL_TEST);
                glow.disable(glow::DEPTH_TEST);
                glow.stencil_func(glow::EQUAL, i32::from(reference), u32::from(bits));
                glow.stencil_op(glow::KEEP, glow::KEEP, glow::KEEP);
            }
            FragmentTest::Depth { reversed } => {
                glow.disable(glow::STENCIL_TEST);
                glow.enable(glow::DEPTH_TEST);
                glow.depth_mask(false);
                // The triangle lies at depth 0.5 whatever the vertex stage does; this puts it on the far
                // plane.
                let (far, function) = if reversed { (0.0, glow::LESS) } else { (1.0, glow::GREATER) };
                glow.depth_range_f64(far, far);
                glow.depth_func(function);
            }
        }
    }
    let drawn = pass.fill(target);
    drop(tests);
    if !gl.is_lost() {
        // SAFETY: the framebuffer is bound by the pass, or by `attach`.
        unsafe { detach(gl, test) };
    }
    drawn
}

fn attach(gl: &Gl, target: &Target, texture: glow::Texture, test: FragmentTest) -> Result<()> {
    let glow = gl.glow();
    let mut status = glow::FRAMEBUFFER_UNSUPPORTED;
    for &attachment in test.attachments() {
        // SAFETY: the context is current; a name that is no texture is an error, which is checked for.
        unsafe {
            target.bind_for_drawing();
            glow.framebuffer_texture_2d(
                glow::DRAW_FRAMEBUFFER,
                attachment,
                glow::TEXTURE_2D,
                Some(texture),
                0,
            );
            status = match glow.get_error() {
                glow::NO_ERROR => glow.check_framebuffer_status(glow::DRAW_FRAMEBUFFER),
                code => code,
            };
            if status == glow::FRAMEBUFFER_COMPLETE && target.has_size_of(texture) {
                return Ok(());
            }
            glow.framebuffer_texture_2d(glow::DRAW_FRAMEBUFFER, attachment, glow::TEXTURE_2D, None, 0);
        }
    }
    if status == glow::CONTEXT_LOST {
        return Err(gl.error(status, "attaching a texture of the host", None));
    }
    let size = target.size();
    let got = match status {
        glow::FRAMEBUFFER_COMPLETE => "one of another size".to_owned(),
        glow::INVALID_ENUM..=glow::INVALID_FRAMEBUFFER_OPERATION => {
            format!("one that answers {}", error_name(status))
        }
        _ => format!("framebuffer status {status:#06x}"),
    };
    let what = match test {
        FragmentTest::Stencil { .. } => "stencil",
        FragmentTest::Depth { .. } => "depth",
    };
    Err(Error::Mismatch {
        what: "host's depth or stencil texture",
        expected: format!("a GL_TEXTURE_2D with {what}, of {} x {}", size.x, size.y),
        got,
    })
}

/// Detaches the host's texture.
unsafe fn detach(gl: &Gl, test: FragmentTest) {
    for &attachment in test.attachments() {
        // SAFETY: the caller has bound our framebuffer.
        unsafe {
            gl.glow().framebuffer_texture_2d(glow::DRAW_FRAMEBUFFER, attachment, glow::TEXTURE_2D, None, 0);
        }
    }
}
