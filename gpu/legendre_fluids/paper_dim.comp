// Dims the light that surfaces reflect of a sun by E_d where it leaves the medium on its way there: a shadowgram on what lies behind.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "wavelet_fog/lit.glsl"
layout(std430, binding = AT_DIRECT) readonly buffer Direct { double direct[]; };
uniform dvec3 to_light, box_low, box_high;  // unit; [m]
uniform int first[3];                        // where E_d of each channel begins

// The series at a place of [-1, 1]^3.
float direct_at(int from, vec3 at) {
  float pz[N.z], before = 0, p = 1, sum = 0;
  for (int k = 0; k < N.z; ++k) {
    pz[k] = sqrt(float(k) + 0.5) * p;
    float next = (float(2 * k + 1) * at.z * p - float(k) * before) / float(k + 1);
    before = p, p = next;
  }
  float x = 1, before_x = 0;
  for (int i = 0; i < N.x; ++i) {
    float plane = 0, y = 1, before_y = 0;
    for (int j = 0; j < N.y; ++j) {
      float line = 0;
      for (int k = 0; k < N.z; ++k) line += float(direct[from + (i * N.y + j) * N.z + k]) * pz[k];
      plane += sqrt(float(j) + 0.5) * y * line;
      float next = (float(2 * j + 1) * at.y * y - float(j) * before_y) / float(j + 1);
      before_y = y, y = next;
    }
    sum += sqrt(float(i) + 0.5) * x * plane;
    float next = (float(2 * i + 1) * at.x * x - float(i) * before_x) / float(i + 1);
    before_x = x, x = next;
  }
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int place = pixel.y * view_width + pixel.x;
  if (lit[place].reflected.rgb == vec3(0)) return;
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  dvec3 point = origin + lit[place].t * direction;
  double enters = 0, leaves = 1e300LF;
  for (int a = 0; a < 3; ++a) {
    if (to_light[a] == 0) {
      if (point[a] < box_low[a] || point[a] > box_high[a]) return;
      continue;
    }
    double s = (box_low[a] - point[a]) / to_light[a], t = (box_high[a] - point[a]) / to_light[a];
    enters = max(enters, min(s, t));
    leaves = min(leaves, max(s, t));
  }
  if (enters >= leaves) return;
  vec3 at = vec3((2 * (point + enters * to_light) - box_low - box_high) / (box_high - box_low)), left;
  for (int c = 0; c < 3; ++c) left[c] = c > 0 && first[c] == first[0] ? left[0] : max(direct_at(first[c], at), 0);
  lit[place].reflected.rgb *= left;
}
