// How wide each pixel's light was gathered.

// What was gathered; a: radius in pixels.
uniform sampler2D irradiance;

// The radius to the nearest whole pixel; 0 where nothing is lit.
layout(location = 0) out uint radius;

void main()
{
    radius = uint(texelFetch(irradiance, ivec2(gl_FragCoord.xy), 0).a + 0.5);
}
