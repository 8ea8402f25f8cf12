// A rectangle of the image around each solid.
layout(std430, binding = 13) readonly buffer Rectangles { vec4 rectangles[]; };  // -1 to 1, y downwards: x, y, x, y
uniform int first_solid;
flat out int solid;

void main() {
  solid = first_solid + gl_InstanceID;
  vec4 r = rectangles[solid];
  const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));
  ivec2 corner = corners[gl_VertexID];
  gl_Position = vec4(corner.x == 0 ? r.x : r.z, corner.y == 0 ? r.y : r.w, 0, 1);
}
