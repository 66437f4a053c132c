//! Photons as points: the counts of the definition.

use glam::UVec2;
use varikernel::reference::photon_density;
use varikernel::render::Renderer;
use varikernel::scene::Scene;
use varikernel::settings::{Kernel, KernelRadius};

use crate::stage::{photon_at, settings, shown, traced, wall};
use crate::support::egl;

#[test]
fn counts_are_those_of_the_definition_and_a_lost_photon_is_seen() {
    let gl = egl();
    for name in ["cornell-glass", "mirror-ring"] {
        let scene = Scene::shipped(name).unwrap();
        let photons = traced(&scene, 20_000, 3);
        let settings = settings(64, Kernel::Box, KernelRadius::Fixed(1));
        let mut renderer = Renderer::with_photons(&gl, &scene, &settings, &photons).unwrap();
        let shown = shown(&renderer);
        let (layers, account) = renderer.picture(&settings).unwrap();
        let differing = |photons| {
            let expected = photon_density(&shown, photons);
            let pairs = layers.density.values().iter().zip(expected.values());
            #[expect(clippy::cast_precision_loss, reason = "small counts")]
            pairs.map(|(&found, &expected)| (found - expected as f32).abs()).sum::<f32>()
        };
        // A photon on the border of two pixels may count in either.
        let found = differing(&photons);
        assert!(found <= 4.0, "{name}: {found} photons are elsewhere");
        assert!(account.contributing > 2_000, "{name}: {account:?}");
        assert!(
            differing(&photons[photons.len() / 2..]) > 1_000.0,
            "{name}: half of the photons are missing"
        );
    }
}

#[test]
fn what_is_hidden_turned_away_or_outside_does_not_count() {
    let gl = egl();
    let scene = wall();
    let settings = settings(16, Kernel::Box, KernelRadius::Fixed(1));
    let view = scene.view(UVec2::splat(16));
    let photon = photon_at(&scene, &view, 5, 6, 1.0).unwrap();
    let behind = {
        let mut photon = photon;
        photon.position.z -= 0.5;
        photon
    };
    let turned = {
        let mut photon = photon;
        photon.normal = -photon.normal;
        photon
    };
    let outside = {
        let mut photon = photon;
        photon.position.x += 2.0;
        photon
    };
    let other = {
        let mut photon = photon;
        photon.surface += 1.0;
        photon
    };
    let photons = [photon, behind, turned, outside, other, photon];
    let mut renderer = Renderer::with_photons(&gl, &scene, &settings, &photons).unwrap();
    let (layers, account) = renderer.picture(&settings).unwrap();
    assert_eq!(account.contributing, 2);
    assert!((layers.density.at(5, 6) - 2.0).abs() < 1e-6, "{:?}", layers.density);
    assert_eq!(account.uploaded, 4, "turned away and outside are never uploaded");
}
