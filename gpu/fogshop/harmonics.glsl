// Light and reflectance in harmonics: Zhou et al. 2007, Eqs. 20 to 27 (methods/fogshop/surface_lighting.h). Needs `tables`. Sums
// over coefficients run along with the harmonics; only a band is held where it must be turned, all of them only for TRANSFER.
// TABULATED: there are reflectances other than Lambert's; TURNED: which must be turned.
#include "common/spherical_harmonics.glsl"
#define LANE_ROWS ((TURNED != 0 ? 2 * (2 * SH_ORDER - 1) : 0) + SH_ORDER)
#include "common/lane_rows.glsl"
#if TURNED
#include "common/turn_band.glsl"
#endif

const int SH_SIZE = SH_ORDER * SH_ORDER;
const int weights_from = LANE_ROWS - SH_ORDER;         // rows: of each band, per channel
uniform int cosine_at;                                 // bands of the clamped cosine
uniform int point_bands_at, point_depths;              // g_l of a point light's PSF, [depth][l]; one depth: for all
uniform int environment_bands_at, environment_depths;  // of an environment's
uniform int environment_at;                            // its radiance L_lm, rgb
uniform int environment_lambert_at;                    // times sqrt(4 pi/(2l+1)) and the band of the clamped cosine
uniform float least_depth, greatest_depth;             // of the bands, even in log T
vec3 weight_of(int l) { return row_at(weights_from + l); }

// Turns g_l of a function about z into the factor of Y_lm of its axis: Eqs. 21 and 23.
float zonal_factor(int l) { return sqrt(4 * pi / float(2 * l + 1)); }

// B_pv: that of Lambert is zonal about the normal; others lie in a table by the angle of view, in axes whose z is the normal and
// whose x points to the viewer.
struct Reflected {
  bool lambert;
  vec3 diffuse;  // over pi
  vec3 x, z;
  int low;      // place of the entry below
  float share;  // of the one above
};
Reflected reflectance_of(Material m, vec3 normal, vec3 to_view) {
  float cosine = dot(normal, to_view);
  if (TABULATED == 0 || m.diffuse.w == 0 || !(cosine > 0))
    return Reflected(true, cosine > 0 ? m.diffuse.rgb / pi : vec3(0), vec3(0), normal, 0, 0);
  vec3 aside = to_view - cosine * normal, other = abs(normal.x) < 0.5 ? vec3(1, 0, 0) : vec3(0, 1, 0);
  float sine = length(aside), place = min(angle_of(sine, cosine) / (0.5 * pi), 1.0) * float(m.places.y - 1);
  int entry = min(m.places.y - 2, int(place));
  // At the pole nothing depends on the azimuth.
  vec3 x = sine > 1e-6 ? aside / sine : normalize(cross(normal, other));
  return Reflected(false, vec3(0), x, normal, m.places.x + 3 * SH_SIZE * entry, place - float(entry));
}
// Coefficient of a tabulated reflectance, in the table's own axes.
vec3 own_coefficient(Reflected r, int i) { return mix(rgb_at(r.low + 3 * i), rgb_at(r.low + 3 * (SH_SIZE + i)), r.share); }

#if TRANSFER
#include "fogshop/transfer.glsl"
#endif

// Where depths lie among those of the bands.
vec3 band_place(vec3 T, int depths) {
  return clamp(log(max(T, 1e-30) / least_depth) / log(greatest_depth / least_depth), 0, 1) * float(depths - 1);
}
// Keeps the weights of all bands: g_l at each channel's depth times the zonal factor.
void keep_weights(int at, int depths, vec3 T) {
  vec3 place = band_place(T, depths);
  ivec3 k = min(ivec3(max(depths - 2, 0)), ivec3(place)), low_at = at + k * SH_ORDER;
  int step_ = depths > 1 ? SH_ORDER : 0;
  vec3 share = place - vec3(k);
  bool alike = place == place.xxx;
  for (int l = 0; l < sh_order; ++l) {
    vec3 g = vec3(mix(tables[low_at.x + l], tables[low_at.x + step_ + l], share.x));
    if (!alike) {
      g.y = mix(tables[low_at.y + l], tables[low_at.y + step_ + l], share.y);
      g.z = mix(tables[low_at.z + l], tables[low_at.z + step_ + l], share.z);
    }
    set_row(weights_from + l, zonal_factor(l) * g);
  }
}

// Reflected light that the medium at depth T from a light scatters onto the surface, per unit of I/d^2 and albedo: Eq. 25.
vec3 reflect_point(Reflected r, vec3 to_light, vec3 T) {
  vec3 sum = vec3(0);
  keep_weights(point_bands_at, point_depths, T);
#if TRANSFER
  for (ShPair y = first_pair(to_light); y.m < sh_order; next_pair(y, to_light)) {
    int i = y.l * (y.l + 1);
    sum += weight_of(y.l) * (y.plus * functions[i + y.m] + y.minus * functions[i - y.m]);
  }
#else
  if (TABULATED == 0 || r.lambert) {  // the addition theorem: Legendre polynomials of the angle to the normal
    float cosine = dot(r.z, to_light), now = 1, before = 0;
    for (int l = 0; l < sh_order; ++l) {
      sum += weight_of(l) * (tables[cosine_at + l] / zonal_factor(l) * now);
      float next = (float(2 * l + 1) * cosine * now - float(l) * before) / float(l + 1);
      before = now;
      now = next;
    }
    sum *= r.diffuse;
  } else {
    vec3 w = vec3(dot(r.x, to_light), dot(cross(r.z, r.x), to_light), dot(r.z, to_light));
    for (ShPair y = first_pair(w); y.m < sh_order; next_pair(y, w)) {
      int i = y.l * (y.l + 1);
      sum += weight_of(y.l) * (y.plus * own_coefficient(r, i + y.m) + y.minus * own_coefficient(r, i - y.m));
    }
  }
#endif
  return sum * max(T, vec3(0)) * exp(-T);
}

// L_lm and the reflectance of a band, summed.
vec3 reflect_band(Reflected r, int l) {
  vec3 sum = vec3(0);
#if TURNED && !TRANSFER
  for (int i = 0; i <= 2 * l; ++i) set_row(i, own_coefficient(r, l * l + i));
  turn_band(l, r.x, r.z);
#endif
  for (int i = 0; i <= 2 * l; ++i) {
    vec3 light = rgb_at(environment_at + 3 * (l * l + i));
#if TRANSFER
    sum += light * functions[l * l + i];
#elif TURNED
    sum += light * row_at(i);
#endif
  }
  return sum;
}

// The environment's light that arrives and is reflected, and that which the medium scattered on the way (per unit of albedo):
// Eq. 27 for the average depth T.
void reflect_environment(Reflected r, vec3 T, out vec3 direct, out vec3 scattered) {
  direct = scattered = vec3(0);
  if (has_scattered != 0) {
    keep_weights(environment_bands_at, environment_depths, T);
  } else {
    for (int l = 0; l < sh_order; ++l) set_row(weights_from + l, vec3(0));
  }
  if (TRANSFER == 0 && (TABULATED == 0 || r.lambert)) {
    // The clamped cosine has no odd bands but the first.
    int order = sh_order > 2 ? sh_order - 1 | 1 : sh_order;
    for (ShPair y = first_pair(r.z); y.m < order; next_pair(y, r.z, order)) {
      if ((y.l & 1) == 0 || y.l == 1) {
        int at = environment_lambert_at + 3 * y.l * (y.l + 1);
        vec3 value = y.plus * rgb_at(at + 3 * y.m) + y.minus * rgb_at(at - 3 * y.m);
        direct += value;
        scattered += weight_of(y.l) * value;
      }
    }
    direct *= r.diffuse;
    scattered *= r.diffuse;
  } else {
    for (int l = 0; l < sh_order; ++l) {
      vec3 value = reflect_band(r, l);
      direct += value;
      scattered += weight_of(l) * value;
    }
  }
  direct = max(direct * exp(-T), vec3(0));
  scattered = max(scattered * max(T, vec3(0)) * exp(-T), vec3(0));
}
