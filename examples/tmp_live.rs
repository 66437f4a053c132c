use std::sync::Arc;
use std::time::Instant;
use varikernel::context::*;
use varikernel::render::*;
use varikernel::scene::Scene;
fn main() {
    let gl = open(&DeviceChoice::Auto).unwrap();
    let scene = Arc::new(Scene::shipped("cornell-glass").unwrap());
    let mut s = LiveSettings::new(&scene);
    s.size = glam::UVec2::new(512, 384);
    s.photons_per_step = 5000;
    s.shadow_rays_per_step = 1 << 15;
    let t = Instant::now();
    let mut l = Live::new(&gl, scene.clone(), s).unwrap();
    println!("new {:?}", t.elapsed());
    for i in 0..12 {
        let t = Instant::now();
        l.step().unwrap();
        let a = t.elapsed();
        let _ = l.inspect(glam::UVec2::new(9, 9)).unwrap();
        println!("step {i} {:?} with gl {:?} {:?}", a, t.elapsed(), l.times());
    }
    s.irradiance.search.search.min_photons = 200;
    let t = Instant::now();
    l.change(s).unwrap();
    println!("change n {:?}", t.elapsed());
    for i in 0..3 {
        let t = Instant::now();
        l.step().unwrap();
        let _ = l.inspect(glam::UVec2::new(9, 9)).unwrap();
        println!("step {i} {:?}", t.elapsed());
    }
    s.camera.position.x += 1.0;
    let t = Instant::now();
    l.change(s).unwrap();
    println!("change camera {:?}", t.elapsed());
}
