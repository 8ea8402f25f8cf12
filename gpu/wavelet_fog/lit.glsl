// Radiance that a pixel shows behind the fog, as lights in turn add to it.
struct Lit {
  vec4 reflected;  // of the light in hand, towards the camera; w: integral of a medium on the way to it, so far
  vec4 sum;        // of those before it, and what shines by itself
  double t;        // along the camera's ray to what it ends on [m]
  double unused;
};
layout(std430, binding = AT_LIT) buffer LitPixels { Lit lit[]; };
