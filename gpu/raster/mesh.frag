// The pixel's own ray meets the plane of its triangle, in double precision: interpolated positions would carry the rounding
// of corners far outside the image.
#include "raster/view.glsl"
#include "raster/triangles.glsl"
#include "raster/hit.glsl"

flat in int triangle;

void main() {
  dvec3 origin, direction, normal;
  view_ray(block * dvec2(gl_FragCoord.xy), origin, direction);
  ivec4 corners = triangles[triangle];
  double t = meet_triangle_plane(corners, origin, direction, view_forward, normal);
  keep_hit(t, triangle);
}
