//! A host's query that runs while the library is called.

use glow::HasContext as _;
use varikernel::{Error, Frame, MaskMaker, RadiusPipeline, StatePolicy, context};

use super::host::Host;
use super::{Watch, borrowed_textures, calls, choices};
use crate::support::planned;

/// Begins a query of the host, calls, ends it, and gives its result.
fn across(host: &Host, kind: u32, call: impl FnOnce()) -> u64 {
    let glow = host.gl.glow();
    // SAFETY: the context is current, and the query is of this kind.
    unsafe {
        let query = glow.create_query().unwrap();
        glow.begin_query(kind, query);
        let running = |when: &str| {
            let mut name = 0;
            (host.commands.get_queryiv)(kind, glow::CURRENT_QUERY, &raw mut name);
            assert_eq!(name.cast_unsigned(), query.0.get(), "the query runs {when} the call");
        };
        running("before");
        call();
        running("after");
        glow.end_query(kind);
        let result = glow.get_query_parameter_u32(query, glow::QUERY_RESULT);
        assert_eq!(glow.get_error(), glow::NO_ERROR, "{kind:#06x}");
        glow.delete_query(query);
        result.into()
    }
}

fn check(choice: &context::DeviceChoice, policy: StatePolicy) {
    let host = Host::new(choice);
    let watch = Watch::new(&host, policy, borrowed_textures(&host), None);
    let map = calls::map(&watch);
    let expected = calls::expected();
    let mut pipeline = calls::pipeline(&watch);
    let mut adaptive =
        RadiusPipeline::new(&watch.gl, map.size(), map.format(), planned(*pipeline.settings())).unwrap();
    let mut maker = MaskMaker::new(&watch.gl, map.size()).unwrap();
    let frames = |pipeline: &mut RadiusPipeline| {
        pipeline.render(&map).unwrap();
    };
    // Each pass draws a triangle, and no triangle is captured.
    let primitives = across(&host, glow::PRIMITIVES_GENERATED, || frames(&mut pipeline));
    assert_eq!(primitives, across(&host, glow::PRIMITIVES_GENERATED, || frames(&mut pipeline)));
    assert!(primitives >= 8, "{primitives}");
    let captured = glow::TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN;
    assert_eq!(across(&host, captured, || frames(&mut pipeline)), 0);
    // At least the radii of all pixels are drawn.
    let samples = across(&host, glow::SAMPLES_PASSED, || frames(&mut pipeline));
    assert!(samples >= u64::from(map.size().x * map.size().y), "{samples}");
    assert_eq!(across(&host, glow::ANY_SAMPLES_PASSED, || frames(&mut pipeline)), 1);
    for kind in [glow::TIME_ELAPSED, glow::SAMPLES_PASSED] {
        across(&host, kind, || {
            for _ in 0..3 {
                adaptive.update(&Frame::new(&map)).unwrap();
            }
            maker.from_depth(crate::support::usual_depth(watch.textures[1])).unwrap();
            assert_eq!(pipeline.radii().read().unwrap(), expected.radius);
        });
    }

    // Calls that need a query of their own return an error, and do nothing.
    across(&host, glow::TIME_ELAPSED, || {
        let mut timer = varikernel::gl::Timer::new(&watch.gl).unwrap();
        let mut has_run = false;
        let result = timer.time(|| {
            has_run = true;
            Ok(())
        });
        assert!(matches!(result, Err(Error::QueryRunning { kind: "GL_TIME_ELAPSED" })), "{result:?}");
        assert!(!has_run);
        // A proof does not time.
        assert!(pipeline.certify(&map).unwrap().is_proved());
    });
    // Drivers may count both kinds of samples by one counter.
    for kind in [glow::SAMPLES_PASSED, glow::ANY_SAMPLES_PASSED] {
        across(&host, kind, || {
            let certificate = pipeline.certify(&map);
            let is_busy = matches!(certificate, Err(Error::QueryRunning { kind: "GL_SAMPLES_PASSED" }));
            assert!(is_busy || kind == glow::ANY_SAMPLES_PASSED, "{certificate:?}");
            varikernel::gl::time(&watch.gl, || Ok(())).unwrap();
        });
    }
    assert!(pipeline.certify(&map).unwrap().is_proved(), "as good as before");
    watch.unchanged("calls within queries");
}

#[test]
fn a_running_query_of_the_host_is_not_disturbed() {
    for choice in choices() {
        for policy in [StatePolicy::Restore, StatePolicy::Defaults] {
            check(&choice, policy);
        }
    }
}
