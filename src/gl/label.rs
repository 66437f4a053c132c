//! Names of passes and objects, as RenderDoc and apitrace show them: KHR_debug, where it is there.

use glow::HasContext as _;

use super::{Gl, Target, Texture};

impl Gl {
    /// Counts the debug groups that a call may push, if the host's may be all that there are.
    pub(super) fn count_groups(&self, asks: bool) {
        let Some(glow) = self.live().filter(|_| self.commands().names_things) else { return };
        // SAFETY: the context is current, and has KHR_debug.
        let limit = |name| unsafe { glow.get_parameter_i32(name) };
        let left =
            asks.then(|| limit(glow::MAX_DEBUG_GROUP_STACK_DEPTH) - limit(glow::DEBUG_GROUP_STACK_DEPTH));
        self.inner.groups_left.set(left.map_or(u32::MAX, |left| u32::try_from(left).unwrap_or(0)));
    }

    /// Runs `work` inside a debug group that RenderDoc and apitrace show as `label`.
    pub(super) fn labelled<T>(&self, label: &str, work: impl FnOnce() -> T) -> T {
        let left = &self.inner.groups_left;
        let Some(glow) = self.live().filter(|_| self.commands().names_things && left.get() > 0) else {
            return work();
        };
        left.set(left.get() - 1);
        // SAFETY: the context is current and has KHR_debug.
        unsafe { glow.push_debug_group(glow::DEBUG_SOURCE_APPLICATION, 0, label) };
        let result = work();
        left.set(left.get() + 1);
        if let Some(glow) = self.live() {
            // SAFETY: as above; the group was pushed before the work.
            unsafe { glow.pop_debug_group() };
        }
        result
    }

    /// Names an object, which was bound at least once since it exists from then on.
    pub(super) fn label(&self, kind: u32, name: u32, label: &str) {
        if let Some(glow) = self.live().filter(|_| self.commands().names_things) {
            // SAFETY: the context is current and has KHR_debug; a label has no effect on rendering.
            unsafe { glow.object_label(kind, name, Some(format!("varikernel: {label}"))) };
        }
    }

    /// Names the objects of the handle itself.
    pub(super) fn label_own_objects(&self) {
        if !self.commands().names_things {
            return;
        }
        let (glow, array) = (self.glow(), self.inner.vertex_array);
        // SAFETY: the context is current; the host's vertex array is bound again a line later.
        unsafe {
            let bound = glow.get_parameter_vertex_array(glow::VERTEX_ARRAY_BINDING);
            glow.bind_vertex_array(Some(array));
            glow.bind_vertex_array(bound);
        }
        self.label(glow::VERTEX_ARRAY, array.0.get(), "no vertices");
        self.label(glow::SAMPLER, self.inner.nearest.0.get(), "nearest");
        self.label(glow::SAMPLER, self.inner.nearest_mipmap.0.get(), "nearest of a level");
    }
}

impl Texture {
    /// Names the texture.
    pub(crate) fn labelled(self, label: &str) -> Self {
        self.gl().label(glow::TEXTURE, self.name().0.get(), label);
        self
    }
}

impl Target {
    /// Names the textures that are ours, as many as there are, and the framebuffers and the depth buffer by
    /// the first of them.
    pub(crate) fn labelled(self, labels: &[&str]) -> Self {
        let gl = self.texture().gl();
        for (texture, label) in self.textures().iter().zip(labels).filter(|(texture, _)| texture.is_ours()) {
            gl.label(glow::TEXTURE, texture.name().0.get(), label);
        }
        for framebuffer in &self.framebuffers {
            gl.label(glow::FRAMEBUFFER, framebuffer.0.get(), labels[0]);
        }
        if let Some(depth) = &self.depth {
            gl.label(glow::TEXTURE, depth.name().0.get(), &format!("{}, depth", labels[0]));
        }
        self
    }
}
