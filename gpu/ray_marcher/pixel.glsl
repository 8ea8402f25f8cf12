// State of a pixel on the device. A dispatch does a limited amount of work for each pixel and stores here where to continue.
struct Pixel {
  vec3 airlight;
  uint steps;  // density evaluations on the camera ray
  vec3 transmittance;  // while a march is under way: its optical depth so far
  uint shadow_rays;
  uint shadow_steps;
  uint occlusion_rays;
  int march;  // that is under way; balls + 1: finished
  int part;
  float step_;
  int light;  // of the step; then of the surface behind the media
  float from, width_;  // of what is under way of a step, in shares of it
};
layout(std430, binding = AT_PIXELS) buffer Pixels { Pixel pixels[]; };
