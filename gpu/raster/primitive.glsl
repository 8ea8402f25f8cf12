// The primitive that a pixel shows, intersected again with its ray in double precision: by the numbers that raster
// passes leave, triangles first.
#include "raster/triangles.glsl"
#include "raster/solids.glsl"

uniform int triangle_count;

// Distance along the ray [m]; `normal` has either side; `surface` -2: a light's ball.
double meet_primitive(int primitive, dvec3 origin, dvec3 direction, dvec3 forward, out dvec3 normal, out int surface) {
  if (primitive < triangle_count) {
    surface = triangles[primitive].w;
    return meet_triangle_plane(triangles[primitive], origin, direction, forward, normal);
  }
  Solid s = solids[primitive - triangle_count];
  surface = s.surface;
  return meet_solid(s, origin, direction, normal);
}
