// Light of the environment that Lambertian surfaces reflect past smoke and spheres, by directions, a pixel per work group:
// SourceRadiance::irradiance of `directional`.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "raster/view.glsl"
#include "raster/primitive.glsl"
#include "wavelet_fog/lit.glsl"
#define TO_LIGHT_OF_LANE
#include "compensated_ray_marching/smoke_density.glsl"
#include "compensated_ray_marching/smoke_column.glsl"
layout(std430, binding = AT_PRIMITIVES) readonly buffer Primitives { int primitive_of[]; };     // by pixel; -1: none
layout(std430, binding = AT_LIGHT_BANDS) readonly buffer LightParts { double light[]; };        // [channel][direction], times its weight
layout(std430, binding = AT_SPHERES) readonly buffer Spheres { double spheres[]; };             // center, radius [m], surface; reflectances
layout(std430, binding = AT_TOWARDS_LIGHT) readonly buffer TowardsLight { vec4 towards_light[]; };
uniform int sphere_count, directions;
uniform float spacing;  // of directions, over which edges of shadows are spread [rad]
uniform dvec3 middle;   // of the smoke [m]
uniform vec3 sigma_t;
#define lane int(gl_LocalInvocationIndex)
shared vec3 sums[LOCAL_SIZE_X];

// visible_share of sphere_shadow.h, past all spheres but that of a surface.
float visible_share(dvec3 x, int surface) {
  float share = 1;
  for (int s = 0; s < sphere_count; ++s) {
    if (int(spheres[5 * s + 4]) == surface) continue;
    vec3 offset = vec3(dvec3(spheres[5 * s], spheres[5 * s + 1], spheres[5 * s + 2]) - x);
    float far = length(offset), radius = float(spheres[5 * s + 3]);
    float away = atan(length(cross(offset, to_light)), dot(offset, to_light)) - asin(min(radius / far, 1.0));
    share *= far > radius ? clamp(0.5 + away / spacing, 0.0, 1.0) : 0;
  }
  return share;
}

void main() {
  int place = int(gl_WorkGroupID.y) * view_width + int(gl_WorkGroupID.x), primitive = primitive_of[place];
  if (primitive < 0) {  // uniform over all lanes
    if (lane == 0) lit[place] = Lit(vec4(0), vec4(0), 0, 0);
    return;
  }
  dvec3 origin, direction, normal;
  view_ray(dvec2(gl_WorkGroupID.xy) + 0.5LF, origin, direction);
  int surface;
  double t = meet_primitive(primitive, origin, direction, view_forward, normal, surface);
  if (dot(normal, direction) > 0) normal = -normal;
  dvec3 point = origin + t * direction;
  vec3 sum = vec3(0);
  for (int k = lane; k < directions; k += LOCAL_SIZE_X) {
    to_light = towards_light[k].xyz;
    float cosine = dot(vec3(normal), to_light), share = cosine > 0 ? cosine * visible_share(point, surface) : 0;
    if (!(share > 0)) continue;
    vec3 from = vec3(light[k], light[directions + k], light[2 * directions + k]);
    sum += share * from * exp(-min(sigma_t * column_from(vec3(point - middle)), vec3(200)));
  }
  if (loops_cut()) sum = vec3(uintBitsToFloat(0x7fc00000u));  // no number, rather than a wrong one
  sums[lane] = sum;
  barrier();
  if (lane != 0) return;
  sum = vec3(0);
  for (int k = 0; k < LOCAL_SIZE_X; ++k) sum += sums[k];
  for (int c = 0; c < 3; ++c) sum[c] = max(sum[c], 0) * float(spheres[5 * sphere_count + 3 * surface + c]);
  lit[place] = Lit(vec4(sum, 0), vec4(0), t, 0);
}
