// Light of the environment that Lambertian surfaces reflect past smoke and spheres, a pixel per work group: SourceRadiance::irradiance.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "raster/view.glsl"
#include "raster/primitive.glsl"
#include "wavelet_fog/lit.glsl"
#include "compensated_ray_marching/passed.glsl"
layout(std430, binding = AT_PRIMITIVES) readonly buffer Primitives { int primitive_of[]; };  // by pixel; -1: none
layout(std430, binding = AT_LIGHT_BANDS) readonly buffer LightBands { double light[]; };     // [channel][band], lookup directions
uniform double extinction[3];      // [1/m], of each channel
uniform double cosine[SH_ORDER];   // of the angle to a normal, where it is above 0: zonal, times sqrt(4 pi / (2l+1))

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
  clear_rows();
  for (int l = 0; l < SH_ORDER; ++l) band[l] = bits_of(cosine[l]);
  if (lane == 0) add_about(normal, 1);
  sum_rows(LOBE);
  dvec3 point = origin + t * direction;
  find_hidden(point, surface);
  find_depth(point);
  vec3 reflected = vec3(0);
  for (int c = 0; c < 3; ++c) {
    if (c == 0 || extinction[c] != extinction[c - 1]) pass(extinction[c]);
    double mine = 0;
    if (lane < BANDS) {
      for (int k = terms[lane].i; k < terms[lane].j; ++k)
        mine += terms[k].value * light[c * BANDS + terms[k].i] * vectors[RESULT + terms[k].j];
      rows[lane] = mine * vectors[LOBE + lane];
    }
    barrier();
    double sum = 0;
    for (int b = 0; b < BANDS; ++b) sum += rows[b];
    reflected[c] = float(max(sum, 0.0LF) * spheres[5 * sphere_count + 3 * surface + c]);
    barrier();
  }
  if (lane == 0) lit[place] = Lit(vec4(reflected, 0), vec4(0), t, 0);
}
