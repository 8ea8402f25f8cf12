// The pixel's own ray meets the plane of its triangle, in double precision: interpolated positions would carry the rounding
// of corners far outside the image.
#include "raster/view.glsl"
#include "raster/triangles.glsl"
#include "raster/hit.glsl"

flat in int triangle;

void main() {
  dvec3 origin, direction;
  view_ray(dvec2(gl_FragCoord.xy), origin, direction);
  ivec4 corners = triangles[triangle];
  dvec3 a = mesh_vertex(corners.x), ab = mesh_vertex(corners.y) - a, ac = mesh_vertex(corners.z) - a;
  dvec3 normal = cross(ab, ac);
  double scale = length(normal);
  if (!(scale > 0)) discard;
  normal /= scale;
  a -= origin;
  // Coverage is decided to a fraction of a pixel only: on a triangle seen from its edge the plane may be met far outside.
  double za = dot(a, view_forward), zb = za + dot(ab, view_forward), zc = za + dot(ac, view_forward);
  double nearest = max(min(za, min(zb, zc)), 0.0LF), farthest = max(za, max(zb, zc));
  double cosine = dot(direction, view_forward), speed = dot(normal, direction);
  double t = speed != 0 ? dot(normal, a) / speed : nearest / cosine;
  keep_hit(clamp(t, nearest / cosine, farthest / cosine), normal, direction, corners.w, triangle);
}
