// Each photon as a quad over the pixels that its kernel may reach (thesis 2.6.2).

// The weighted area that each photon's kernel covers, row by row; 0: it does not contribute.
uniform sampler2D covered;

flat out vec3 kernel_position;
flat out vec3 kernel_normal;
flat out vec3 kernel_across;
flat out vec3 kernel_along;
flat out vec3 kernel_through;
flat out float kernel_number;
flat out vec3 density;
flat out ivec2 home;

void main()
{
    home = ivec2(floor(pixel_of(photon_position)));
    int width = textureSize(covered, 0).x;
    float area = texelFetch(covered, ivec2(gl_InstanceID % width, gl_InstanceID / width), 0).r;
    // Outside of the picture, unless it contributes.
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    kernel_position = kernel_normal = kernel_across = kernel_along = kernel_through = density = vec3(0.0);
    kernel_number = 0.0;
    if (area > 0.0) {
        Surface surface = surface_at(home);
        Kernel kernel = kernel_on(photon_position, surface, radius_at(home));
        ivec4 pixels = reach(kernel, to_clip, home);
        ivec2 corner = ivec2((gl_VertexID & 1) == 0 ? pixels.x : pixels.z + 1,
                             (gl_VertexID & 2) == 0 ? pixels.y : pixels.w + 1);
        gl_Position = vec4(vec2(corner) / vec2(map_size) * 2.0 - 1.0, 0.0, 1.0);
        kernel_position = kernel.position;
        kernel_normal = kernel.normal;
        kernel_across = kernel.across;
        kernel_along = kernel.along;
        kernel_through = kernel.through;
        kernel_number = kernel.number;
        density = photon_power / area;
    }
}
