//! Commands that glow lacks. Those beyond OpenGL 3.3 serve only to put a host's state back.

use std::ffi::{CStr, c_void};

use glow::HasContext as _;

use super::Gl;
use super::home::Home;
use super::loader::command;

type GetBooleans = unsafe extern "system" fn(parameter: u32, index: u32, values: *mut u8);
type IsEnabled = unsafe extern "system" fn(capability: u32, index: u32) -> u8;
type GetDoubles = unsafe extern "system" fn(parameter: u32, values: *mut f64);
type GetIndexedFloats = unsafe extern "system" fn(parameter: u32, index: u32, values: *mut f32);
type GetIndexedDoubles = unsafe extern "system" fn(parameter: u32, index: u32, values: *mut f64);
type ClipControl = unsafe extern "system" fn(origin: u32, depth: u32);
type BeginConditionalRender = unsafe extern "system" fn(query: u32, mode: u32);
type EndConditionalRender = unsafe extern "system" fn();

/// Commands, where the loader has them.
#[derive(Debug, Default)]
pub(super) struct Commands {
    home: Option<Home>,
    pub(super) get_booleans: Option<GetBooleans>,
    pub(super) get_doubles: Option<GetDoubles>,
    pub(super) is_enabled: Option<IsEnabled>,
    pub(super) conditional_render: Option<ConditionalRender>,
    /// OpenGL 4.1: viewports, depth ranges and scissor tests by index.
    pub(super) viewports: Option<Viewports>,
    /// OpenGL 4.5.
    pub(super) clip_control: Option<ClipControl>,
    /// OpenGL 4.0: blend factors and equations of each draw buffer.
    pub(super) blends_by_buffer: bool,
    /// OpenGL 4.0: transform feedback that pauses.
    pub(super) pauses_feedback: bool,
    /// KHR_debug, or OpenGL 4.3: passes and objects can be named.
    pub(super) names_things: bool,
}

/// What tells whether conditional rendering is on.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConditionalRender {
    pub(super) begin: BeginConditionalRender,
    pub(super) end: EndConditionalRender,
}

/// What reads the state of one viewport.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewports {
    pub(super) get_floats: GetIndexedFloats,
    pub(super) get_doubles: GetIndexedDoubles,
}

impl Commands {
    /// Those that a loader has, of a context that is current.
    pub(super) fn load(loader: &mut impl FnMut(&CStr) -> *const c_void) -> Self {
        let mut all = |names: &[&CStr]| names.iter().all(|name| !loader(name).is_null());
        let names_things = all(&[c"glPushDebugGroup", c"glPopDebugGroup", c"glObjectLabel"]);
        let blends_by_buffer = all(&[c"glBlendFuncSeparatei", c"glBlendEquationSeparatei"]);
        let pauses_feedback = all(&[c"glPauseTransformFeedback", c"glResumeTransformFeedback"]);
        let sets_viewports = all(&[c"glViewportArrayv", c"glDepthRangeArrayv"]);
        let get_floats = command!(loader, c"glGetFloati_v", GetIndexedFloats);
        let get_doubles = command!(loader, c"glGetDoublei_v", GetIndexedDoubles);
        let viewports = get_floats.zip(get_doubles).filter(|_| sets_viewports);
        let begin = command!(loader, c"glBeginConditionalRender", BeginConditionalRender);
        let end = command!(loader, c"glEndConditionalRender", EndConditionalRender);
        Self {
            home: Home::of(loader),
            get_booleans: command!(loader, c"glGetBooleani_v", GetBooleans),
            get_doubles: command!(loader, c"glGetDoublev", GetDoubles),
            is_enabled: command!(loader, c"glIsEnabledi", IsEnabled),
            conditional_render: begin.zip(end).map(|(begin, end)| ConditionalRender { begin, end }),
            viewports: viewports.map(|(get_floats, get_doubles)| Viewports { get_floats, get_doubles }),
            clip_control: command!(loader, c"glClipControl", ClipControl),
            blends_by_buffer,
            pauses_feedback,
            names_things,
        }
    }

    /// Where there is no loader: only what glow has.
    pub(super) fn of_glow() -> Self {
        Self { names_things: true, blends_by_buffer: true, pauses_feedback: true, ..Self::default() }
    }

    /// Whether the context that they were loaded in is current.
    pub(super) fn is_at_home(&self) -> bool {
        self.home.is_none_or(Home::is_current)
    }

    /// Without those that the context does not have: a loader may know commands of any version.
    pub(super) fn of_context(mut self, glow: &glow::Context) -> Self {
        let (version, extensions) = (glow.version(), glow.supported_extensions());
        let has = |major, minor, extension: &str| {
            (version.major, version.minor) >= (major, minor) || extensions.contains(extension)
        };
        self.viewports = self.viewports.filter(|_| has(4, 1, "GL_ARB_viewport_array"));
        self.clip_control = self.clip_control.filter(|_| has(4, 5, "GL_ARB_clip_control"));
        self.blends_by_buffer &= has(4, 0, "GL_ARB_draw_buffers_blend");
        self.pauses_feedback &= has(4, 0, "GL_ARB_transform_feedback2");
        self.names_things &= glow.supports_debug();
        self
    }
}

/// What a context has more than OpenGL 3.3 core does, as far as a host's state is concerned.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extent {
    /// How many viewports there are, if they have an index.
    pub(super) viewports: u32,
    /// Whether it has the state of OpenGL before 3.1.
    pub(super) is_compatible: bool,
    /// Whether it tells of errors: not with KHR_no_error, where what would be one may end the process.
    pub(super) tells_errors: bool,
}

impl Extent {
    pub(super) fn of(glow: &glow::Context, commands: &Commands) -> Self {
        // SAFETY: the context is current, and of a version that has these states.
        unsafe {
            let viewports = commands.viewports.map(|_| glow.get_parameter_i32(glow::MAX_VIEWPORTS));
            let mask = |name| glow.get_parameter_i32(name).cast_unsigned();
            // Some drivers leave the mask empty.
            let is_compatible = mask(glow::CONTEXT_PROFILE_MASK) & glow::CONTEXT_COMPATIBILITY_PROFILE_BIT
                != 0
                || glow.supported_extensions().contains("GL_ARB_compatibility");
            Self {
                viewports: viewports.map_or(0, i32::cast_unsigned),
                is_compatible,
                tells_errors: mask(glow::CONTEXT_FLAGS) & glow::CONTEXT_FLAG_NO_ERROR_BIT == 0,
            }
        }
    }
}

impl Gl {
    pub(super) fn commands(&self) -> &Commands {
        &self.inner.commands
    }

    pub(super) fn extent(&self) -> Extent {
        self.inner.extent
    }

    /// The colour mask of draw buffer `index`.
    pub(super) fn color_mask(&self, index: u32) -> [bool; 4] {
        let mut mask = [0_u8; 4];
        match self.commands().get_booleans {
            // SAFETY: GL_COLOR_WRITEMASK has four values, and the mask has room for them.
            Some(get) => unsafe { get(glow::COLOR_WRITEMASK, index, mask.as_mut_ptr()) },
            // SAFETY: the context is current; the mask of buffer 0 has four values.
            None => return unsafe { self.glow().get_parameter_bool_array::<4>(glow::COLOR_WRITEMASK) },
        }
        mask.map(|value| value != 0)
    }

    /// Whether a capability is on, of a draw buffer or viewport if it is one of those.
    pub(super) fn is_enabled(&self, capability: u32, index: Option<u32>) -> bool {
        // SAFETY: the context is current; blending has one value for each index, which OpenGL converts.
        unsafe {
            match (self.commands().is_enabled, index) {
                (Some(is_enabled), Some(index)) => is_enabled(capability, index) != 0,
                (None, Some(index)) => self.glow().get_parameter_indexed_i32(capability, index) != 0,
                (_, None) => self.glow().is_enabled(capability),
            }
        }
    }

    /// Of a viewport, or of all.
    pub(super) fn depth_range(&self, viewport: Option<u32>) -> [f64; 2] {
        let mut range = [0.0_f64; 2];
        let commands = self.commands();
        // SAFETY: the context is current; a depth range has two values.
        unsafe {
            match (commands.viewports.zip(viewport), commands.get_doubles) {
                (Some((commands, index)), _) => {
                    (commands.get_doubles)(glow::DEPTH_RANGE, index, range.as_mut_ptr());
                }
                (None, Some(get)) => get(glow::DEPTH_RANGE, range.as_mut_ptr()),
                (None, None) => {
                    let mut rounded = [0_f32; 2];
                    self.glow().get_parameter_f32_slice(glow::DEPTH_RANGE, &mut rounded);
                    range = rounded.map(f64::from);
                }
            }
        }
        range
    }

    pub(super) fn set_clip_control(&self, origin: u32, depth: u32) {
        if let Some(set) = self.commands().clip_control {
            // SAFETY: the context is current, and has this command.
            unsafe { set(origin, depth) };
        }
    }
}
