// Values that the passes of variant S pass on, by ray of a strip of tiles (gpu/fogshop/airlight_pass.cpp, which defines
// the sizes). A field of all rays is followed by the next field, so that neighbours read together. No pass holds an
// array, for any number of slices and lights.
layout(std430, binding = AT_RAY_VALUES) buffer RayValues { float ray_value[]; };
uniform int ray_count;  // of the strip
uniform int slice_count, node_count;  // uniforms, so that a shader is compiled once for all numbers of slices

// Fields. Slices begin where nodes are done with.
const int slices_from = 0, slices_to = 1;  // [m] the stretch of the ray that is sliced; empty: none
const int reach_from = 2, reach_to = 3;    // [m] that of the Gaussians alone
const int opacity_sum = 4, edges = 5;      // of the boxes; slice_count + 1 ray parameters [m]
int nodes = edges + slice_count + 1, shares = nodes + node_count;  // [m], and what of the slices ends before
int slices = nodes;                                                // depth before the first edge, then that of every slice
int scattering = slices + slice_count + 1;                         // if coloured: what they scatter, three channels each

int value_at(int field, int ray) { return field * ray_count + ray; }
int ray_of_strip() { return int(gl_GlobalInvocationID.y) * grid_width + int(gl_GlobalInvocationID.x); }
