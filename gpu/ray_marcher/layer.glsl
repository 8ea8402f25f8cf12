// The media as the marcher sees them: reference/ray_marcher/layer.h and kernels.h. World coordinates here are relative to a
// middle of the scene that the host subtracts in double; local coordinates are those of the CPU's kernels.
const float far_away = 1e37;  // [m] and beyond: an infinite ray
const float endless = 1e30;   // [m] stands for an endless column: any extinction makes it black, zero extinction does not

const int shape_everything = 0, shape_box = 1, shape_sphere = 2, shape_slab = 3;
const int field_none = 0, field_grid = 1, field_gaussians = 2, field_map = 3, field_series = 4;

struct Layer {
  vec3 sigma_t;    // [1/m]
  float constant;  // density in the whole region [-]
  vec3 albedo;
  int field;
  vec3 half_size;  // of the region in its frame
  int shape;
  vec4 shape_frame[3];  // local = xyz . world + w
  vec4 field_frame[3];
  vec3 lo;  // support of the field, local
  int first;  // of its Gaussians, its values of a map or a series; of its grid values, or the number of its texture
  vec3 hi;
  int count;  // of its Gaussians
  ivec3 size;  // padded samples of a grid; padded columns and rows of a map, and its knots; coefficients of a series
  int first_brick;
  ivec3 bricks;  // of a grid; degree and profile of a map
  int phase;
  float g;  // of Henyey-Greenstein
  int negative;  // some Gaussian is: the sum is clamped at -constant
  float most_varied;  // upper bound of what varies [-]
  float thickest;     // of all layers that vary, per unit of density [1/m]
};

struct Gaussian {
  vec3 center;          // local [m]
  float inverse_width;  // [1/m]
  float amplitude;      // [-]
  float limit;          // (distance / width)^2 beyond which it is zero
  float unused[2];
};

layout(std140, binding = AT_LAYERS) uniform Layers { Layer layers[LAYERS > 0 ? LAYERS : 1]; };
#if OTHER_FIELDS  // maps and series stand in one list with the Gaussians, which are its beginning
layout(std430, binding = AT_GAUSSIANS) readonly buffer FieldValues { float field_value[]; };
Gaussian gaussian_at(int i) {
  int at = 8 * i;
  return Gaussian(vec3(field_value[at], field_value[at + 1], field_value[at + 2]), field_value[at + 3], field_value[at + 4],
                  field_value[at + 5], float[2](0, 0));
}
#elif GAUSSIANS
layout(std430, binding = AT_GAUSSIANS) readonly buffer GaussianList { Gaussian gaussians[]; };
Gaussian gaussian_at(int i) { return gaussians[i]; }
#endif
#if GRIDS
#if TEXTURES
layout(binding = 0) uniform sampler3D grid_texture[TEXTURES];
#else
layout(std430, binding = AT_GRID_VALUES) readonly buffer GridValues { float grid_value[]; };      // x fastest
#endif
// Free distance of each brick of 4^3 cells [cells]; -1: not empty.
layout(std430, binding = AT_FREE_DISTANCES) readonly buffer FreeDistances { float free_distance[]; };
#endif

// Loops over layers run to a uniform: unrolled, they make programs as many times as large.
#if LAYERS > 1
uniform int layer_count;  // LAYERS
#else
const int layer_count = LAYERS;
#endif

uint work = 0;  // iterations of loops by this invocation, roughly

vec3 to_local(vec4 frame[3], vec3 x) {
  return vec3(dot(frame[0].xyz, x) + frame[0].w, dot(frame[1].xyz, x) + frame[1].w, dot(frame[2].xyz, x) + frame[2].w);
}
vec3 rotate_to_local(vec4 frame[3], vec3 v) {
  return vec3(dot(frame[0].xyz, v), dot(frame[1].xyz, v), dot(frame[2].xyz, v));
}

// Ranges [x, y] of a ray [m]; empty unless x < y.
const vec2 nothing = vec2(far_away, -far_away);

vec2 clip_axis(float o, float d, float lo, float hi, vec2 t) {
  if (abs(d) < 1e-20) return o >= lo && o <= hi ? t : nothing;
  float a = (lo - o) / d, b = (hi - o) / d;
  return vec2(max(t.x, min(a, b)), min(t.y, max(a, b)));
}
vec2 clip_box(vec3 lo, vec3 hi, vec3 o, vec3 d, vec2 t) {
  t = clip_axis(o.x, d.x, lo.x, hi.x, t);
  t = clip_axis(o.y, d.y, lo.y, hi.y, t);
  return clip_axis(o.z, d.z, lo.z, hi.z, t);
}
vec2 clip_region(int k, vec3 x, vec3 direction, vec2 t) {
  if (layers[k].shape == shape_everything) return t;
  vec3 o = to_local(layers[k].shape_frame, x), d = rotate_to_local(layers[k].shape_frame, direction);
  if (layers[k].shape == shape_box) return clip_box(-layers[k].half_size, layers[k].half_size, o, d, t);
  if (layers[k].shape == shape_slab) return clip_axis(o.x, d.x, -layers[k].half_size.x, layers[k].half_size.x, t);
  // Unit sphere: from the point of closest approach, which loses no digits for origins far away.
  float dd = dot(d, d), nearest = -dot(o, d) / dd;
  vec3 q = o + nearest * d;
  float inside = 1 - dot(q, q);
  if (!(inside > 0)) return nothing;
  float reach = sqrt(inside / dd);
  return vec2(max(t.x, nearest - reach), min(t.y, nearest + reach));
}
// The part of a ray that is in the field of layer k. The ray is already clipped to the region.
vec2 clip_field(int k, vec3 x, vec3 direction, vec2 t) {
  return clip_box(layers[k].lo, layers[k].hi, to_local(layers[k].field_frame, x),
                  rotate_to_local(layers[k].field_frame, direction), t);
}

#if GRIDS
#if TEXTURES
// By hand from eight texels: the hardware's filter has weights of 8 bits (texture_3d.h).
#define CORNER(x, y, z) texelFetch(grid_texture[s], i + ivec3(x, y, z), 0).r
void grid_corners(int k, ivec3 i, out vec4 near, out vec4 beyond) {
  near = beyond = vec4(0);
  int mine = TEXTURES > 1 ? layers[k].first : 0;
  for (int s = 0; s < TEXTURES; ++s)  // samplers are indexed by what all invocations agree on
    if (s == mine) {
      near = vec4(CORNER(0, 0, 0), CORNER(1, 0, 0), CORNER(0, 1, 0), CORNER(1, 1, 0));
      beyond = vec4(CORNER(0, 0, 1), CORNER(1, 0, 1), CORNER(0, 1, 1), CORNER(1, 1, 1));
    }
}
#else
void grid_corners(int k, ivec3 i, out vec4 near, out vec4 beyond) {
  ivec3 size = layers[k].size;
  int at = layers[k].first + i.x + size.x * (i.y + size.y * i.z), row = size.x, slice = size.x * size.y;
  near = vec4(grid_value[at], grid_value[at + 1], grid_value[at + row], grid_value[at + row + 1]);
  at += slice;
  beyond = vec4(grid_value[at], grid_value[at + 1], grid_value[at + row], grid_value[at + row + 1]);
}
#endif
// Trilinear at local coordinates: sample coordinates plus 2. Nothing outside the array is read, whatever comes.
float grid_density(int k, vec3 p) {
  ivec3 i = clamp(ivec3(p), ivec3(0), layers[k].size - 2);
  vec3 f = p - vec3(i);
  vec4 near, beyond;
  grid_corners(k, i, near, beyond);
  vec4 v = near + f.z * (beyond - near);
  vec2 w = v.xy + f.y * (v.zw - v.xy);
  return w.x + f.x * (w.y - w.x);
}
// How far one may go from there and still be where the density is zero [cells, Chebyshev].
float free_at(int k, vec3 p) {
  ivec3 i = clamp(ivec3(p) >> 2, ivec3(0), layers[k].bricks - 1);
  return free_distance[layers[k].first_brick + i.x + layers[k].bricks.x * (i.y + layers[k].bricks.y * i.z)];
}
#endif

#if GAUSSIANS
float gaussian_density(int k, vec3 p) {
  float sum = 0;
  work += uint(layers[k].count);
  for (int i = layers[k].first; i < layers[k].first + layers[k].count; ++i) {
    Gaussian g = gaussian_at(i);
    vec3 q = g.inverse_width * (p - g.center);
    float d2 = dot(q, q);
    if (d2 <= g.limit) sum += g.amplitude * exp(-d2);
  }
  return layers[k].negative != 0 ? max(sum, -layers[k].constant) : sum;
}
#endif

#if OTHER_FIELDS
const int map_rows = 6, profile_none = 0, profile_layers = 1, profile_exponential = 2;

// The factor of the height, by the knots of the map's profile: scene/media/height_profile.h.
float height_factor(int k, float y) {
  int at = layers[k].first + map_rows, profile = layers[k].bricks.y;
  if (profile == profile_none) return 1;
  if (profile != profile_layers) return y <= field_value[at] ? 1 : exp((field_value[at] - y) / field_value[at + 1]);
  if (y < field_value[at]) return field_value[at + 1];
  for (int i = 1; i < layers[k].size.z; ++i, at += 2) {
    float low = field_value[at], high = field_value[at + 2];
    if (y < high) return mix(field_value[at + 1], field_value[at + 3], (y - low) / (high - low));
  }
  return field_value[at + 1];
}

// Values of B-splines in a cell: cell_basis of scene/math/bspline.h.
vec4 cell_basis(int degree, float u) {
  float w = 1 - u;
  if (degree == 0) return vec4(1, 0, 0, 0);
  if (degree == 1) return vec4(u, w, 0, 0);
  if (degree == 2) return vec4(0.5 * u * u, 0.5 + u * w, 0.5 * w * w, 0);
  return vec4(u * u * u, 1 + 3 * u * (1 + u * w), 1 + 3 * w * (1 + u * w), w * w * w) / 6;
}

// A fogmap (scene/media/fogmap.h). First come two rows that lead from local coordinates to cells, then the knots, then the
// coefficients with a border of zeros.
vec2 place_on_map(int k, vec3 p) {
  int at = layers[k].first;
  vec3 ground = vec3(p.xz, 1);
  return vec2(dot(vec3(field_value[at], field_value[at + 1], field_value[at + 2]), ground),
              dot(vec3(field_value[at + 3], field_value[at + 4], field_value[at + 5]), ground));
}
float map_density(int k, vec3 p) {
  int at = layers[k].first, degree = layers[k].bricks.x, columns = layers[k].size.x;
  vec2 uv = place_on_map(k, p);
  vec2 cell = floor(uv), last = vec2(layers[k].size.xy - degree);
  work += 8u;
  if (any(lessThan(uv, vec2(0))) || any(greaterThanEqual(uv, last))) return 0;
  vec4 across = cell_basis(degree, uv.x - cell.x), down = cell_basis(degree, uv.y - cell.y);
  int place = at + map_rows + 2 * layers[k].size.z + (int(cell.y) + degree) * columns + int(cell.x) + degree;
  float sum = 0;
  for (int j = 0; j <= degree; ++j)
    for (int i = 0; i <= degree; ++i) sum += down[j] * across[i] * field_value[place - j * columns - i];
  return sum > 0 ? sum * height_factor(k, p.y) : 0;
}

// A Legendre box (scene/media/legendre_box.h). First come factors from local coordinates to [-1, 1], then the coefficients of
// Legendre polynomials that are 1 at the end, z fastest. Sums by Clenshaw's recurrence along each axis.
vec3 series_scale(int k) {
  int at = layers[k].first;
  return vec3(field_value[at], field_value[at + 1], field_value[at + 2]);
}
float series_value(int k, vec3 u) {  // of [-1, 1]^3, negative ones too
  int at = layers[k].first;
  ivec3 n = layers[k].size;
  work += uint(n.x * n.y * n.z);
  vec2 sum = vec2(0);  // of the order in hand and the one above it
  for (int x = n.x - 1; x >= 0; --x) {
    vec2 plane = vec2(0);
    for (int y = n.y - 1; y >= 0; --y) {
      vec2 row = vec2(0);
      int first = at + 3 + (x * n.y + y) * n.z;
      for (int z = n.z - 1; z >= 0; --z) {
        float m = float(z);
        row = vec2(field_value[first + z] + (2 * m + 1) / (m + 1) * u.z * row.x - (m + 1) / (m + 2) * row.y, row.x);
      }
      float m = float(y);
      plane = vec2(row.x + (2 * m + 1) / (m + 1) * u.y * plane.x - (m + 1) / (m + 2) * plane.y, plane.x);
    }
    float m = float(x);
    sum = vec2(plane.x + (2 * m + 1) / (m + 1) * u.x * sum.x - (m + 1) / (m + 2) * sum.y, sum.x);
  }
  return sum.x;
}
float series_density(int k, vec3 p) {
  vec3 u = p * series_scale(k);
  if (any(greaterThan(abs(u), vec3(1)))) return 0;
  return max(series_value(k, u), 0);
}
#endif

// Density without the constant [-], at local and at world coordinates.
float local_density(int k, vec3 p) {
#if GRIDS
  if (layers[k].field == field_grid) return grid_density(k, p);
#endif
#if GAUSSIANS
  if (layers[k].field == field_gaussians) return gaussian_density(k, p);
#endif
#if OTHER_FIELDS
  if (layers[k].field == field_map) return map_density(k, p);
  if (layers[k].field == field_series) return series_density(k, p);
#endif
  return 0;
}
float varied_density(int k, vec3 x) { return layers[k].field == field_none ? 0 : local_density(k, to_local(layers[k].field_frame, x)); }
