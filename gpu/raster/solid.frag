// The pixel's ray meets the solid itself.
#include "raster/view.glsl"
#include "raster/solids.glsl"
#include "raster/hit.glsl"

uniform int triangle_count;
flat in int solid;

void main() {
  dvec3 origin, direction, normal;
  view_ray(block * dvec2(gl_FragCoord.xy), origin, direction);
  double t = meet_solid(solids[solid], origin, direction, normal);
  keep_hit(t, triangle_count + solid);
}
