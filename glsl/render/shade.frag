// Indirect light from diffuse surfaces, and the whole picture: radiance towards the camera.

// Irradiance by photons: red, green and blue, in power per square of a scene unit.
uniform sampler2D irradiance;
// What the irradiance is multiplied with: 1, or one over the parts that it was added up of.
uniform float scale;
// Share of light that the surface reflects: red, green and blue, 0 to 1.
uniform sampler2D albedo;
// Radiance of direct light; a: 1 where the pixel shows a diffuse surface, 0 where it shows mirrors, glass,
// lights or nothing.
uniform sampler2D direct;
// Radiance of indirect light that is seen in mirrors and through glass.
uniform sampler2D seen_through;

// Radiance of all light.
layout(location = 0) out vec4 beauty;
// Radiance of indirect light alone.
layout(location = 1) out vec4 indirect;

void main()
{
    ivec2 pixel = min(ivec2(gl_FragCoord.xy), textureSize(direct, 0) - 1);
    vec4 straight = texelFetch(direct, pixel, 0);
    vec3 reflectance = texelFetch(albedo, pixel, 0).rgb;
    // A diffuse surface sends its radiosity evenly into the half space.
    vec3 reflected = straight.a * scale * texelFetch(irradiance, pixel, 0).rgb * reflectance / 3.14159265;
    indirect = vec4(reflected + texelFetch(seen_through, pixel, 0).rgb, 1.0);
    beauty = vec4(straight.rgb + indirect.rgb, 1.0);
}
