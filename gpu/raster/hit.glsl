// Output of a fragment, and the order of fragments.
layout(location = 0) out float out_distance;  // along the ray [m]
layout(location = 1) out uint out_primitive;  // triangles in their order, then solids
uniform int block;                            // pixels to the side of what a fragment stands for

// Float depths in (0, 1] keep their relative precision over 126 powers of two; t over a power of two that is 2^40 extents
// keeps that of t itself from 2^-86 extents on. So there is no near plane to choose, and no far one: what lies beyond counts
// as hit, after everything nearer.
uniform double depth_scale;  // a power of two [1/m]

void keep_hit(double t, int primitive) {
  if (!(t > 0)) discard;
  out_distance = float(min(t, 1e37LF));
  out_primitive = uint(primitive);
  gl_FragDepth = min(float(t * depth_scale), 0.99999994);
}
