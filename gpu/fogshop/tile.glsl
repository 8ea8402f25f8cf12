// Tiles of pixels, each one work group, in a strip of the image at a time (fogshop/tiles.comp). After pixels.glsl.
// How many Gaussians the rays of a tile may meet, -1 if no pixel of it is wanted; which. Room for all of them, and as much again where
// fogshop/tiles.comp keeps what its invocations have found. An entry below 0 is minus one less a Gaussian that all rays pass whole.
layout(std430, binding = AT_TILE_LISTS) readonly buffer TileLists { int tile_list[]; };
uniform int tile_row;  // of the first tile of this dispatch: lists hold a strip of the image

int list_of_group() { return int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * (2 * gaussian_count + 1); }
int near_count() { return tile_list[list_of_group()]; }
ivec2 pixel_of_strip() { return ivec2(gl_GlobalInvocationID.xy) + ivec2(0, tile_row * int(LOCAL_SIZE_Y)); }
