// Light of all lamps in the pixels of a picture.
struct LitPixel {
  vec4 airlight, reflected;  // rgb
};
layout(std430, binding = AT_PIXELS) buffer LitPixels { LitPixel lit_pixels[]; };
