// Two triangles for each tile that a photon is in reach of, nothing for the others.

// Tiles of a row.
uniform int tile_columns;

// Places of the corners of two triangles: lower left, lower right, upper left, upper right.
const int CORNERS[6] = int[6](0, 1, 2, 2, 1, 3);

void main()
{
    int index = gl_VertexID / 6;
    int corner = CORNERS[gl_VertexID % 6];
    ivec2 first = TILE_SIDE * ivec2(index % tile_columns, index / tile_columns);
    ivec2 last = first + TILE_SIDE - 1;
    uvec4 flux = sum_of(flux_table, ivec4(max(first - REACH, 0), min(last + REACH, map_size - 1)));
    // A texel of the target stands for STEP x STEP pixels.
    vec2 place = vec2((first + TILE_SIDE * ivec2(corner & 1, corner >> 1)) / STEP);
    vec2 target = vec2((map_size + STEP - 1) / STEP);
    bool drawn = any(greaterThan(flux.rgb, uvec3(0u)));
    gl_Position = vec4(drawn ? place / target * 2.0 - 1.0 : vec2(-2.0), 0.0, 1.0);
}
