// The photon's share of a pixel, as irradiance, and one for the fragment; blending adds them up.

flat in vec3 kernel_position;
flat in vec3 kernel_normal;
flat in vec3 kernel_across;
flat in vec3 kernel_along;
flat in vec3 kernel_through;
flat in float kernel_number;
// Power over the area that the kernel covers.
flat in vec3 density;
flat in ivec2 home;

// Irradiance: red, green and blue, in power per square of a scene unit; a: fragments.
layout(location = 0) out vec4 irradiance_and_fragments;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Kernel kernel = Kernel(
        kernel_position, kernel_normal, kernel_number, kernel_across, kernel_along, kernel_through);
    float weight = weight_of_photon(kernel, home, pixel, surface_at(pixel));
    irradiance_and_fragments = vec4(density * weight, 1.0);
}
