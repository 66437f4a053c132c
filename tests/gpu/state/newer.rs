//! States of OpenGL 4.0 to 4.6 that change what passes draw, or that passes might change.

use glow::HasContext as _;

use super::host::Host;
use super::snapshot::{DRAW_BUFFERS, Snapshot};

/// Of a binding without an index, or a value.
const INTEGERS: &[(&str, u32)] = &[
    ("vertices: of a patch", glow::PATCH_VERTICES),
    ("transformation: clip origin", glow::CLIP_ORIGIN),
    ("transformation: clip depth", glow::CLIP_DEPTH_MODE),
    ("binding: program pipeline", glow::PROGRAM_PIPELINE_BINDING),
    ("binding: draw indirect buffer", glow::DRAW_INDIRECT_BUFFER_BINDING),
    ("binding: dispatch indirect buffer", glow::DISPATCH_INDIRECT_BUFFER_BINDING),
    ("binding: query buffer", glow::QUERY_BUFFER_BINDING),
    ("binding: shader storage buffer", glow::SHADER_STORAGE_BUFFER_BINDING),
    ("binding: atomic counter buffer", glow::ATOMIC_COUNTER_BUFFER_BINDING),
];
const CAPABILITIES: [u32; 2] = [glow::SAMPLE_SHADING, glow::PRIMITIVE_RESTART_FIXED_INDEX];
const BLENDING: [u32; 6] = [
    glow::BLEND_SRC_RGB,
    glow::BLEND_DST_RGB,
    glow::BLEND_SRC_ALPHA,
    glow::BLEND_DST_ALPHA,
    glow::BLEND_EQUATION_RGB,
    glow::BLEND_EQUATION_ALPHA,
];

impl Host {
    /// Whether these states are there: Mesa's contexts are of the newest version whatever is asked for.
    pub(super) fn is_newer(&self) -> bool {
        !self.is_strict && (self.gl.glow().version().major, self.gl.glow().version().minor) >= (4, 5)
    }

    pub(super) fn snapshot_of_newer(&self) -> Snapshot {
        let mut states = Snapshot::new();
        let (glow, commands) = (self.gl.glow(), &self.commands);
        // SAFETY: the context is current; every buffer has room for its state's values.
        unsafe {
            for &(name, state) in INTEGERS {
                states.push((name.to_owned(), vec![glow.get_parameter_i32(state).into()]));
            }
            for capability in CAPABILITIES {
                let name = format!("capability: {capability:#06x}");
                states.push((name, vec![i64::from(glow.is_enabled(capability))]));
            }
            for index in 0..self.limit(glow::MAX_VIEWPORTS) {
                let mut viewport = [0_f32; 4];
                (commands.get_floati_v)(glow::VIEWPORT, index, viewport.as_mut_ptr());
                let viewport = viewport.map(|side| side.to_bits().into());
                states.push((format!("transformation: viewport {index}"), viewport.to_vec()));
                let mut range = [0_f64; 2];
                (commands.get_doublei_v)(glow::DEPTH_RANGE, index, range.as_mut_ptr());
                let range = range.map(|limit| limit.to_bits().cast_signed());
                states.push((format!("transformation: depth range {index}"), range.to_vec()));
                let is_on = (commands.is_enabledi)(glow::SCISSOR_TEST, index);
                states.push((format!("fragments: scissor test {index}"), vec![is_on.into()]));
                let mut scissors = [0_f32; 4];
                (commands.get_floati_v)(glow::SCISSOR_BOX, index, scissors.as_mut_ptr());
                let scissors = scissors.map(|side| side.to_bits().into());
                states.push((format!("fragments: scissor box {index}"), scissors.to_vec()));
            }
            for index in 0..DRAW_BUFFERS {
                let values = BLENDING.map(|state| glow.get_parameter_indexed_i32(state, index).into());
                states.push((format!("blending: factors of draw buffer {index}"), values.to_vec()));
            }
        }
        states
    }

    /// Sets each of them to something unusual, and each index to something else.
    pub(super) fn set_newer(&self) {
        let glow = self.gl.glow();
        let count = self.limit(glow::MAX_VIEWPORTS);
        // SAFETY: the context is current, and has these commands.
        unsafe {
            for index in 0..count {
                let at = f64::from(index);
                #[expect(clippy::cast_possible_truncation, reason = "small numbers")]
                let shift = at as f32;
                // No whole numbers, which OpenGL 3.3 does not have.
                glow.viewport_f32_slice(index, 1, &[[0.25 + shift, 0.5, 7.75 + shift, 9.125]]);
                // No f32.
                glow.depth_range_f64_slice(index, 1, &[[0.1 + at / 100.0, 0.9 - at / 300.0]]);
                let side = index.cast_signed();
                glow.scissor_slice(index, 1, &[[1 + side, 2, 3, 4 + side]]);
                if index % 2 == 0 {
                    glow.enable_draw_buffer(glow::SCISSOR_TEST, index);
                } else {
                    glow.disable_draw_buffer(glow::SCISSOR_TEST, index);
                }
            }
            let factors = [glow::ZERO, glow::SRC_COLOR, glow::DST_COLOR, glow::SRC_ALPHA, glow::DST_ALPHA];
            for index in 0..DRAW_BUFFERS {
                let [first, second] = [index as usize % 5, (index as usize + 2) % 5].map(|at| factors[at]);
                glow.blend_func_separate_draw_buffer(index, first, second, second, glow::CONSTANT_COLOR);
                let equation = if index % 2 == 0 { glow::MIN } else { glow::FUNC_REVERSE_SUBTRACT };
                glow.blend_equation_separate_draw_buffer(index, equation, glow::MAX);
            }
            (self.commands.clip_control)(glow::UPPER_LEFT, glow::ZERO_TO_ONE);
            glow.patch_parameter_i32(glow::PATCH_VERTICES, 7);
            for capability in CAPABILITIES {
                glow.enable(capability);
            }
            let mut pipeline = 0;
            (self.commands.gen_program_pipelines)(1, &raw mut pipeline);
            (self.commands.bind_program_pipeline)(pipeline);
            for target in [
                glow::DRAW_INDIRECT_BUFFER,
                glow::DISPATCH_INDIRECT_BUFFER,
                glow::QUERY_BUFFER,
                glow::SHADER_STORAGE_BUFFER,
                glow::ATOMIC_COUNTER_BUFFER,
            ] {
                glow.bind_buffer(target, Some(glow.create_buffer().unwrap()));
            }
        }
    }
}
