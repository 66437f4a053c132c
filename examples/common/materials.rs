//! Materials of three-d: normals for the g-buffer, and the library's textures on the screen.

use three_d::{
    Blend, ColorTexture, Cull, DepthTest, DepthTexture, Effect, EffectMaterialId, Light, Material,
    MaterialType, Program, RenderStates, Viewer, WriteMask,
};
use varikernel::glow;

/// World normals towards the camera, and the surface's number in alpha.
pub(crate) struct Normals {
    pub(crate) number: f32,
}

impl Material for Normals {
    fn id(&self) -> EffectMaterialId {
        EffectMaterialId(1)
    }

    fn fragment_shader_source(&self, _lights: &[&dyn Light]) -> String {
        "in vec3 nor; uniform float number; layout(location = 0) out vec4 normal;
        void main() { normal = vec4(normalize(gl_FrontFacing ? nor : -nor), number); }"
            .to_owned()
    }

    fn use_uniforms(&self, program: &Program, _viewer: &dyn Viewer, _lights: &[&dyn Light]) {
        program.use_uniform("number", self.number);
    }

    fn render_states(&self) -> RenderStates {
        RenderStates::default()
    }

    fn material_type(&self) -> MaterialType {
        MaterialType::Opaque
    }
}

/// States of an effect over the whole target.
fn over_everything() -> RenderStates {
    RenderStates {
        depth_test: DepthTest::Always,
        cull: Cull::Back,
        write_mask: WriteMask::COLOR,
        blend: Blend::Disabled,
    }
}

/// Albedo times the light of the photons.
pub(crate) struct ByPhotons {
    pub(crate) irradiance: glow::Texture,
}

impl Effect for ByPhotons {
    fn fragment_shader_source(
        &self,
        _lights: &[&dyn Light],
        colour: Option<ColorTexture>,
        _depth: Option<DepthTexture>,
    ) -> String {
        colour.map(|texture| texture.fragment_shader_source()).unwrap_or_default()
            + "in vec2 uvs; uniform sampler2D irradiance; layout(location = 0) out vec4 shown;
            void main() {
                vec3 light = texelFetch(irradiance, ivec2(gl_FragCoord.xy), 0).rgb;
                vec3 radiance = sample_color(uvs).rgb * light / 3.14159265;
                shown = vec4(pow(radiance / (1.0 + radiance), vec3(1.0 / 2.2)), 1.0);
            }"
    }

    fn id(&self, _colour: Option<ColorTexture>, _depth: Option<DepthTexture>) -> EffectMaterialId {
        EffectMaterialId(2)
    }

    #[expect(deprecated, reason = "the texture is not the engine's")]
    fn use_uniforms(
        &self,
        program: &Program,
        _viewer: &dyn Viewer,
        _lights: &[&dyn Light],
        colour: Option<ColorTexture>,
        _depth: Option<DepthTexture>,
    ) {
        if let Some(texture) = colour {
            texture.use_uniforms(program);
        }
        program.use_raw_texture("irradiance", glow::TEXTURE_2D, self.irradiance);
    }

    fn render_states(&self) -> RenderStates {
        over_everything()
    }
}

/// Radii as colours, from dark blue to yellow.
pub(crate) struct Radii {
    pub(crate) radii: glow::Texture,
}

impl Effect for Radii {
    fn fragment_shader_source(
        &self,
        _lights: &[&dyn Light],
        _colour: Option<ColorTexture>,
        _depth: Option<DepthTexture>,
    ) -> String {
        "uniform usampler2D radii; layout(location = 0) out vec4 shown;
        void main() {
            float share = float(texelFetch(radii, ivec2(gl_FragCoord.xy), 0).r) / 64.0;
            shown = vec4(mix(vec3(0.05, 0.0, 0.3), vec3(1.0, 0.9, 0.2), share), 1.0);
        }"
        .to_owned()
    }

    fn id(&self, _colour: Option<ColorTexture>, _depth: Option<DepthTexture>) -> EffectMaterialId {
        EffectMaterialId(3)
    }

    #[expect(deprecated, reason = "the texture is not the engine's")]
    fn use_uniforms(
        &self,
        program: &Program,
        _viewer: &dyn Viewer,
        _lights: &[&dyn Light],
        _colour: Option<ColorTexture>,
        _depth: Option<DepthTexture>,
    ) {
        program.use_raw_texture("radii", glow::TEXTURE_2D, self.radii);
    }

    fn render_states(&self) -> RenderStates {
        over_everything()
    }
}
