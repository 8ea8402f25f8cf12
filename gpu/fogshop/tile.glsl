// Tiles of pixels, each one work group, in a strip of the image at a time (fogshop/tiles.comp). After pixels.glsl.
layout(std430, binding = 1) readonly buffer TileCounts { int tile_count[]; };
uniform int tile_row;  // of the first tile of this dispatch: lists hold a strip of the image

int tile_of_group() { return int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x); }
// How many Gaussians the rays of the tile may meet; -1: no pixel of it is wanted.
int near_count() { return tile_count[tile_of_group()]; }
ivec2 pixel_of_strip() { return ivec2(gl_GlobalInvocationID.xy) + ivec2(0, tile_row * int(LOCAL_SIZE_Y)); }
