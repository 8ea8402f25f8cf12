// The marched film: blocks of film pixels, one ray each (reference/half_resolution_march/low_film.h).

// A ray's march, in parts: a dispatch leaves here where it was.
struct Block {
  vec2 film;               // where its ray is on the film [pixels]
  float depth;             // of what ends it, along the camera's axis [m]; far_away: nothing does
  float t_end;             // distance of that [m]
  vec3 airlight;           // of the frames that are done, summed up [W/m^2/sr]
  int frame;               // under way
  vec3 transmittance;      // of those frames
  int step_;               // of the frame, under way
  vec3 frame_airlight;     // of the frame so far
  float weighted;          // distances times the airlight from there
  vec3 frame_transmittance;
  int light;               // of the step, the next to be done
  float distance_;         // that the airlight of the last frame comes from in the mean [m]; < 0: the ray meets no media
  uint points, look_ups, occlusion_rays;
};
layout(std430, binding = AT_BLOCKS) buffer Blocks {
  uint longest_bits;  // of a float: the longest way of a marched ray through media [m]
  uint history_used, history_rejected, history_clamped;
  Block blocks[];
};

// A block of the film that is left when the march is done.
struct LowPixel {
  vec3 airlight;
  float depth;
  vec3 transmittance;
  float unused;
};

uniform int divide;                   // film pixels per block and axis
uniform int block_columns, block_rows;
uniform float edge_share;             // difference of depth that counts as an edge, in longest ways

float edge_length() { return edge_share * uintBitsToFloat(longest_bits); }

// 0 between two rays that nothing ends; infinite, as far as a float goes, between one and another.
float depth_difference(float a, float b) {
  bool endless = max(a, b) >= far_away;
  return endless ? (a == b ? 0 : far_away) : abs(a - b);
}

// The last blocks may have fewer pixels. `pixels`: of the film's side.
float block_center(int block, int pixels) {
  return 0.5 * float(block * divide + min(pixels, (block + 1) * divide));
}

// Two neighbours of a film position along one side, and the share of the second: filter.h.
struct Neighbours {
  int first, second;
  float share;
};
Neighbours neighbours_at(float x, int pixels, int blocks_) {
  int block = min(int(clamp(x, 0.0, float(pixels))) / divide, blocks_ - 1);
  int first = x < block_center(block, pixels) ? block - 1 : block;
  if (first < 0) return Neighbours(0, 0, 0);
  if (first + 1 >= blocks_) return Neighbours(first, first, 0);
  float center = block_center(first, pixels);
  return Neighbours(first, first + 1, (x - center) / (block_center(first + 1, pixels) - center));
}
