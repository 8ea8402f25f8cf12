// Corners of triangles, fetched by number. Clip coordinates have z = 0: the view is the whole pyramid before the camera, its
// sides are the only planes that clip, and nothing is lost at a near one.
#include "raster/view.glsl"
#include "raster/triangles.glsl"

uniform int first_triangle;
uniform double share_x, share_y;  // of the film in what the rays cover
flat out int triangle;

void main() {
  triangle = first_triangle + gl_VertexID / 3;
  dvec3 v = (mesh_vertex(triangles[triangle][gl_VertexID % 3]) - view_position) / view_extent;
  double w = view_perspective != 0 ? dot(v, view_forward) : 1 / view_extent;
  double x = (dot(v, view_across) + w) * share_x - w, y = (w - dot(v, view_upwards)) * share_y - w;
  gl_Position = vec4(dvec4(x, y, 0, w));  // row 0 of the image is its top
}
