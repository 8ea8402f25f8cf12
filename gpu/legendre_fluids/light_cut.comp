// Where the next stretch of each ray ends, where densities may be below 0: at a cut, where a density changes its sign, or after as much as
// the light's kinks leave.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "legendre_fluids/light_media.glsl"
#include "legendre_fluids/light_stretch.glsl"
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // along the rays [m]
layout(std430, binding = AT_REACHED) buffer Reached { double reached[]; };                // how far a ray is done [m]
layout(std430, binding = AT_COLUMNS) writeonly buffer Columns { float columns[]; };
layout(std430, binding = AT_AIRLIGHT_LAYER) writeonly buffer Airlight { float airlight[]; };
layout(std430, binding = AT_STRETCHES) buffer Stretches { dvec2 stretches[]; };  // end (-1: the ray waits), longest next one [m]
uniform int has_distances, begins, first_light;
#if SHADOWED
#include "legendre_fluids/light_shade.glsl"
uniform int has_shadow;  // may surfaces stand before the light
#endif
const float margin = 1e-4;  // of a stretch, from a change of sign that it begins at

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int place = pixel.y * view_width + pixel.x;
  double last = begins != 0 ? 0 : reached[place], next = nowhere, longest = begins != 0 ? nowhere : stretches[place].y;
  for (int m = 0; m < MEDIA && begins != 0; ++m) columns[place * MEDIA + m] = 0;
  for (int c = 0; c < 3 && begins != 0 && first_light != 0; ++c) airlight[3 * place + c] = 0;
  bool waits = false;  // for the edge of a shadow
#if SHADOWED
  waits = has_shadow != 0 && last < nowhere && (shades[place].flags & shade_waits) != 0;
#endif
  if (last < nowhere && !waits) {
    bool any = false;
    dvec3 origin, direction;
    view_ray(dvec2(pixel) + 0.5LF, origin, direction);
    double end = has_distances != 0 ? double(distances[place]) : nowhere;
    if (next_stretch(origin, direction, end, last, next)) {
      any = true;
#if SHADOWED
      if (has_shadow != 0) waits = !cut_by_shade(place, last, next);
#endif
      // A half that is left over at the end of a stretch is no stretch of its own.
      if (next - last > longest * (1 + 1e-9LF)) next = last + longest;
      float first = 2;
      for (int m = 0; m < MEDIA; ++m) {
        dvec3 middle = origin + 0.5LF * (last + next) * direction;
        if (!inside(m, middle)) continue;
        vec4 c[SERIES_FOURS];
        series_of(m, vec3((middle - box_middle[m]) * per_half[m]), vec3(0.5LF * (next - last) * direction * per_half[m]), c);
        first = min(first, first_change(c, margin, density_noise(m)));
      }
      if (first < 1 - margin) next = last + 0.5LF * (1 + double(first)) * (next - last);
    }
    if (!any) last = nowhere;
  }
  reached[place] = last;
  stretches[place] = dvec2(waits ? -1.0LF : next, longest);
}
