// Radiance that leaves the medium towards the camera: the series of the face where a ray enters, eq. 24; of a camera within, that of all.
// With ENDS surfaces, backdrops and particles end rays: methods/legendre_fluids/paper_view.h.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#if ENDS
#include "wavelet_fog/lit.glsl"
uniform int has_ends, has_lit, has_seen;
#endif
layout(std430, binding = AT_FACES) readonly buffer Faces { float faces[]; };  // of paper_kept.comp
layout(std430, binding = AT_AIRLIGHT_LAYER) writeonly buffer Airlight { float airlight[]; };
layout(std430, binding = AT_MEAN_LAYER) writeonly buffer Mean { float mean_layer[]; };
layout(std430, binding = AT_STATUS) buffer Status { uint counts[]; };  // rays that meet the box, those below 0
#if ENDS
layout(std430, binding = AT_RAY_ENDS) readonly buffer Ends { float ends[]; };  // [m] along rays
layout(std430, binding = AT_SEEN) readonly buffer Seen { float seen[]; };      // of backdrops [W/m^2/sr]; -1: none
layout(std430, binding = AT_TRANSMITTANCE_LAYER) writeonly buffer Transmittance { float transmittance[]; };
layout(std430, binding = AT_SURFACE_LAYER) writeonly buffer Surface { float surface[]; };
uniform vec3 sigma_t;                                 // [1/m]
const float node[] = NODES, node_weight[] = WEIGHTS;  // of [0, 1], exact for the density on any line
#endif
uniform dvec3 box_low, box_high;                                       // [m]
uniform int system_of[3];                                               // of each channel
uniform vec3 scale;                                                    // of its solution
shared uint met, below;

const ivec3 most = max(N, R);
float series(int first, ivec3 shape, vec3 at) {
  float px[most.x], py[most.y], before = 0, p = 1, sum = 0;
  for (int i = 0; i < shape.x; ++i) {
    px[i] = p;
    float next = (float(2 * i + 1) * at.x * p - float(i) * before) / float(i + 1);
    before = p, p = next;
  }
  before = 0, p = 1;
  for (int j = 0; j < shape.y; ++j) {
    py[j] = p;
    float next = (float(2 * j + 1) * at.y * p - float(j) * before) / float(j + 1);
    before = p, p = next;
  }
  before = 0, p = 1;
  for (int k = 0; k < shape.z; ++k) {
    float plane = 0;
    for (int i = 0; i < shape.x; ++i) {
      float line = 0;
      for (int j = 0; j < shape.y; ++j) line += faces[first + (i * shape.y + j) * shape.z + k] * py[j];
      plane += px[i] * line;
    }
    sum += p * plane;
    float next = (float(2 * k + 1) * at.z * p - float(k) * before) / float(k + 1);
    before = p, p = next;
  }
  return sum;
}

vec3 local(dvec3 x) { return vec3((2 * x - box_low - box_high) / (box_high - box_low)); }

// Value, for each channel, of the series that begins at `first` of the channel's system.
vec3 all_series(int first, ivec3 shape, vec3 at) {
  vec3 value;
  for (int c = 0; c < 3; ++c) {
    bool same = c > 0 && system_of[c] == system_of[0];
    value[c] = same ? value[0] : series(system_of[c] * SERIES_STRIDE + first, shape, at);
  }
  return scale * value;
}

// Up to `end`, and what is left of light from there. False where the ray misses the box or ends before.
bool radiance(dvec3 origin, dvec3 direction, double end, out vec3 value, out vec3 left) {
  double enters = 0, leaves = 1e300LF;
  value = vec3(0), left = vec3(1);
  for (int a = 0; a < 3; ++a) {
    if (direction[a] == 0) {
      if (origin[a] < box_low[a] || origin[a] > box_high[a]) return false;
      continue;
    }
    double s = (box_low[a] - origin[a]) / direction[a], t = (box_high[a] - origin[a]) / direction[a];
    enters = max(enters, min(s, t));
    leaves = min(leaves, max(s, t));
  }
  if (enters >= min(leaves, end)) return false;
  vec3 at = local(origin + enters * direction);
  int first = 0;
  ivec3 shape = N;
  if (enters > 0) {
    vec3 far = abs(at);
    int axis = far.x >= far.y && far.x >= far.z ? 0 : far.y >= far.z ? 1 : 2;
    first = UNKNOWNS;
    for (int a = 0; a < 3; ++a) {
      if (a < axis) first += UNKNOWNS / N[a];
      if (a == axis) shape[a] = 1;
    }
  }
  value = all_series(first, shape, at);
#if ENDS
  vec3 last = local(origin + min(leaves, end) * direction);
  float column = 0;
  for (int g = 0; g < COLUMN_POINTS; ++g) column += node_weight[g] * series(DENSITY_AT, R, mix(at, last, node[g]));
  left = exp(-sigma_t * column * float(min(leaves, end) - enters));
  if (end < leaves) value -= left * all_series(0, N, last);
#endif
  return true;
}

void main() {
  if (gl_LocalInvocationIndex == 0u) met = below = 0u;
  barrier();
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x < view_width && pixel.y < view_height) {
    dvec3 origin, direction;
    view_ray(dvec2(pixel) + 0.5LF, origin, direction);
    int place = 3 * (pixel.y * view_width + pixel.x);
    vec3 value, left;
    double end = 1e300LF;
#if ENDS
    if (has_ends != 0) end = ends[place / 3];
    vec3 there = has_lit != 0 ? lit[place / 3].reflected.rgb + lit[place / 3].sum.rgb : vec3(0);
#endif
    if (radiance(origin, direction, end, value, left)) {
      atomicAdd(met, 1u);
      if (min(value.x, min(value.y, value.z)) < 0) atomicAdd(below, 1u);
    }
    for (int c = 0; c < 3; ++c) {
      float behind = 0;
#if ENDS
      behind = left[c] * (has_seen != 0 && seen[place + c] >= 0 ? seen[place + c] : there[c]);
      transmittance[place + c] = left[c];
      surface[place + c] = behind;
#endif
      airlight[place + c] = max(value[c], 0);
      mean_layer[place + c] = max(value[c], 0) + behind;
    }
  }
  barrier();
  if (gl_LocalInvocationIndex > 0u) return;
  atomicAdd(counts[0], met);
  atomicAdd(counts[1], below);
}
