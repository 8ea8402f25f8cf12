// State of a ray under a sun from dispatch to dispatch: the rays of the current strip, row 0 first.
struct SunState {
  double end;           // [m]
  double from;          // its light is summed up to here
  double known;         // shadows are known up to here; 1e37: to the end
  double cell, before;  // shadows: the cell in hand begins, the last shadow ray started
  double low, high;     // between which an edge is looked for
  double way;           // through all cells
  float light[3], depth[3];
  int shadow_ray;       // of the cell in hand; -1: the way is measured
  int flags;
  int halvings, index;  // of the piece in hand
  int edges, read;      // edges of shadows, and how many of them are done with
  int shadow_rays, unused;
};
struct SunRay {
  SunState state;
  double edge[EDGES];
};
layout(std430, binding = AT_SUN_RAYS) buffer SunRays { SunRay sun_rays[]; };
uniform int first_row, strip_rows;

const int lit_here = 1, lit_before = 2, searching = 4, started = 8, cut_short = 16;

// The pixel of an invocation and its place among the rays; -1: none.
int ray_in_hand(out ivec2 pixel) {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  pixel = ivec2(at.x, first_row + at.y);
  return at.x < view_width && at.y < strip_rows && pixel.y < view_height ? at.y * view_width + at.x : -1;
}
