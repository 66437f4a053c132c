// Two triangles for each tile of the class that a pass is for, nothing for the others.

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;
// The class of each tile.
uniform usampler2D tile_classes;
// Tiles of a row.
uniform int tile_columns;

// Places of the corners of two triangles: lower left, lower right, upper left, upper right.
const int CORNERS[6] = int[6](0, 1, 2, 2, 1, 3);

void main()
{
    int index = gl_VertexID / 6;
    int corner = CORNERS[gl_VertexID % 6];
    ivec2 tile = ivec2(index % tile_columns, index / tile_columns);
    bool drawn = texelFetch(tile_classes, tile, 0).r == uint(CLASS);
    // A texel of the target stands for a block of SIDE x SIDE pixels.
    vec2 place = vec2((tile + ivec2(corner & 1, corner >> 1)) * (TILE_SIDE / SIDE));
    vec2 target = vec2((map_size + SIDE - 1) / SIDE);
    gl_Position = vec4(drawn ? place / target * 2.0 - 1.0 : vec2(-2.0), 0.0, 1.0);
}
