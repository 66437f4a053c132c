//! A host's OpenGL state is the same after every call as before, also after an error, under both policies.

#![expect(unsafe_code, reason = "a host speaks OpenGL itself")]

mod calls;
mod host;
mod irradiance;
mod newer;
mod obstacles;
mod pictures;
mod queries;
mod snapshot;
mod unusual;

use std::collections::BTreeSet;

use glam::UVec2;
use glow::HasContext as _;
use varikernel::{Gl, StatePolicy, context};

use crate::masks;
use crate::osmesa::osmesa_is_here;
use crate::support::{random_map, working_candidates};
use host::Host;
use snapshot::Snapshot;
use unusual::{Objects, PLANTS, density_texture};

/// A host's state before calls.
struct Watch<'a> {
    host: &'a Host,
    /// What the library is given.
    gl: Gl,
    objects: Option<&'a Objects>,
    textures: [glow::Texture; 2],
    before: Snapshot,
}

impl<'a> Watch<'a> {
    fn new(
        host: &'a Host,
        policy: StatePolicy,
        textures: [glow::Texture; 2],
        objects: Option<&'a Objects>,
    ) -> Self {
        let gl = host.gl.with_state_policy(policy);
        let mut watch = Self { host, gl, objects, textures, before: Vec::new() };
        watch.before = watch.now();
        watch
    }

    fn now(&self) -> Snapshot {
        let mut states = self.host.snapshot();
        states.extend(self.objects.into_iter().flat_map(|objects| self.host.snapshot_of_objects(objects)));
        if self.gl.state_policy() == StatePolicy::Defaults {
            // The one state without a default.
            states.retain(|(name, _)| !name.starts_with("transformation: viewport"));
        }
        states
    }

    /// A buffer of the host without room.
    fn buffer(&self) -> glow::Buffer {
        let glow = self.host.gl.glow();
        // SAFETY: the context is current; a name becomes a buffer when it is bound.
        unsafe {
            let bound = glow.get_parameter_buffer(glow::ARRAY_BUFFER_BINDING);
            let buffer = glow.create_buffer().unwrap();
            glow.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
            glow.bind_buffer(glow::ARRAY_BUFFER, bound);
            buffer
        }
    }

    fn unchanged(&self, call: &str) {
        for ((name, before), (_, after)) in self.before.iter().zip(self.now()) {
            assert_eq!(*before, after, "{call} changed the host's {name}, {:?}", self.gl.state_policy());
        }
    }
}

/// Families of states that differ.
fn changed(before: &Snapshot, after: &Snapshot) -> BTreeSet<String> {
    assert_eq!(before.len(), after.len());
    let differ = before.iter().zip(after).filter(|(before, after)| before != after);
    differ.map(|((name, _), _)| name.split(':').next().unwrap().to_owned()).collect()
}

const SIZE: UVec2 = UVec2::new(12, 19);

fn borrowed_textures(host: &Host) -> [glow::Texture; 2] {
    let density = random_map(SIZE.x, SIZE.y, 4);
    let textures = [density_texture(host, SIZE, density.values()), masks::depth_and_stencil(&host.gl, SIZE)];
    // SAFETY: the context is current.
    unsafe { host.gl.glow().bind_texture(glow::TEXTURE_2D, None) };
    textures
}

/// All calls under unusual state, which has to stay.
fn check_restore(host: &Host) {
    let textures = borrowed_textures(host);
    let usual = host.snapshot();
    let objects = host.set_everything(textures);
    let same: Vec<_> = usual
        .iter()
        .zip(&host.snapshot())
        .filter(|(usual, now)| usual == now)
        .map(|(state, _)| state.0.clone())
        .collect();
    // Queries that the library needs itself, which a test of their own holds.
    let queries = ["query: 0x8914", "query: 0x8c2f", "query: 0x88bf"];
    let groups = host.is_strict.then_some("debug: depth of groups");
    // Off at every other index, so that no index may take another's.
    let viewports = if host.is_newer() { host.limit(glow::MAX_VIEWPORTS) } else { 0 };
    let scissors = (1..viewports).step_by(2).map(|index| format!("fragments: scissor test {index}"));
    let expected: Vec<_> = groups.into_iter().chain(queries).map(str::to_owned).chain(scissors).collect();
    assert_eq!(same, expected, "every other state is unusual");
    let watch = Watch::new(host, StatePolicy::Restore, textures, Some(&objects));
    calls::all(&watch);
    irradiance::all(&watch);
    pictures::all(&watch);
}

/// All calls under default state, which has to be default afterwards.
fn check_defaults(choice: &context::DeviceChoice) {
    let host = Host::new(choice);
    let watch = Watch::new(&host, StatePolicy::Defaults, borrowed_textures(&host), None);
    calls::all(&watch);
    irradiance::all(&watch);
    pictures::all(&watch);
}

/// The first EGL device that works.
fn egl_choice() -> context::DeviceChoice {
    let candidates = working_candidates();
    let mut choices = candidates.into_iter().map(|candidate| candidate.choice);
    choices.find(|choice| matches!(choice, context::DeviceChoice::Egl(_))).unwrap()
}

/// That, and OSMesa where it can be had.
#[track_caller]
fn choices() -> Vec<context::DeviceChoice> {
    let osmesa = osmesa_is_here().then_some(context::DeviceChoice::OsMesa);
    [Some(egl_choice()), osmesa].into_iter().flatten().collect()
}

#[test]
fn every_call_leaves_the_state_of_a_host_as_it_was_on_egl() {
    check_restore(&Host::new(&egl_choice()));
}

#[test]
fn every_call_leaves_the_state_of_a_host_as_it_was_on_osmesa() {
    if osmesa_is_here() {
        check_restore(&Host::new(&context::DeviceChoice::OsMesa));
    }
}

/// What is newer than OpenGL 3.3 is not asked for where the loader does not have it.
#[test]
fn every_call_leaves_the_state_as_it_was_with_the_commands_of_3_3_alone() {
    check_restore(&Host::strict(&egl_choice()));
}

#[test]
fn every_call_leaves_defaults_behind_on_egl() {
    check_defaults(&egl_choice());
}

#[test]
fn every_call_leaves_defaults_behind_on_osmesa() {
    if osmesa_is_here() {
        check_defaults(&context::DeviceChoice::OsMesa);
    }
}

/// Handles of both policies on one context, in turns; a call of one policy inside of one of the other.
#[test]
fn both_policies_live_side_by_side() {
    let host = Host::new(&egl_choice());
    let textures = borrowed_textures(&host);
    let defaults = Watch::new(&host, StatePolicy::Defaults, textures, None);
    let restore = Watch::new(&host, StatePolicy::Restore, textures, None);
    assert_eq!(
        host.gl.state_policy(),
        StatePolicy::Restore,
        "the handle that another is made of stays as it is"
    );
    for _ in 0..2 {
        for [timing, timed] in [[&defaults, &restore], [&restore, &defaults]] {
            let mut pipeline = calls::pipeline(timed);
            let map = calls::map(timed);
            // SAFETY: the context is current.
            unsafe { host.gl.glow().viewport(0, 0, 0, 0) };
            varikernel::gl::time(&timing.gl, || {
                pipeline.render(&map)?;
                // The timer's own query runs.
                assert_eq!(changed(&timed.before, &timed.now()), BTreeSet::from(["query".to_owned()]));
                Ok(())
            })
            .unwrap();
            defaults.unchanged("a timed call");
            assert_eq!(pipeline.radii().read().unwrap(), calls::expected().radius);
        }
    }
}

/// A stencil reference that the host set while it drew to no stencil, when drivers return 0 for it.
#[test]
fn a_stencil_reference_is_kept_that_cannot_be_asked_for() {
    for choice in choices() {
        let host = Host::new(&choice);
        let textures = borrowed_textures(&host);
        let glow = host.gl.glow();
        let mut maker = varikernel::MaskMaker::new(&host.gl, SIZE).unwrap();
        // SAFETY: the context is current, and the texture has depth and stencil.
        let reference = |attached: bool| unsafe {
            let framebuffer = glow.create_framebuffer().unwrap();
            glow.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(framebuffer));
            let (target, attachment) = (glow::DRAW_FRAMEBUFFER, glow::DEPTH_STENCIL_ATTACHMENT);
            let texture = attached.then_some(textures[1]);
            glow.framebuffer_texture_2d(target, attachment, glow::TEXTURE_2D, texture, 0);
            // A driver sees what is attached when it is asked whether that is complete.
            let is_complete = glow.check_framebuffer_status(target) == glow::FRAMEBUFFER_COMPLETE;
            assert_eq!(is_complete, attached);
            glow.get_parameter_i32(glow::STENCIL_REF)
        };
        // SAFETY: the context is current.
        unsafe { glow.stencil_func(glow::LESS, 3, 0xFF) };
        assert_eq!([reference(true), reference(false)], [3, 0], "the reference cannot be asked for");
        maker.from_depth(crate::support::usual_depth(textures[1])).unwrap();
        maker.from_stencil(textures[1], 5, 0xFF).unwrap();
        maker.from_stencil(textures[0], 5, 0xFF).unwrap_err();
        assert_eq!(reference(true), 3);
    }
}

#[test]
fn a_planted_change_in_each_family_is_seen() {
    let host = Host::new(&egl_choice());
    let textures = borrowed_textures(&host);
    let objects = host.set_everything(textures);
    let mut watch = Watch::new(&host, StatePolicy::Restore, textures, Some(&objects));
    let families: BTreeSet<_> =
        watch.before.iter().map(|(name, _)| name.split(':').next().unwrap().to_owned()).collect();
    let planted: BTreeSet<_> = PLANTS.iter().map(|(family, _)| (*family).to_owned()).collect();
    assert_eq!(planted, families);
    for (family, plant) in PLANTS {
        watch.before = watch.now();
        // SAFETY: the context is current.
        unsafe { plant(&host, &objects) };
        assert_eq!(changed(&watch.before, &watch.now()), BTreeSet::from([(*family).to_owned()]));
    }
}
