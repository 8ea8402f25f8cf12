// What lights leave in the pixels of a picture.
struct LitPixel {
  vec4 airlight, reflected;  // rgb
};
layout(std430, binding = 6) buffer LitPixels { LitPixel lit_pixels[]; };
