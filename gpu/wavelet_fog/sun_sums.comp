// Sums along the rows of a map of columns, from the sun's side, a row per invocation.
layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = AT_TABLE) buffer SunMap { vec4 sun_map[]; };
uniform int sun_columns, sun_rows, sun_first;  // first: entry
uniform float sun_step, fallen;  // [cells]; what is left of an exponential over a step

void main() {
  int row = int(gl_GlobalInvocationID.x);
  if (row >= sun_rows) return;
  vec3 sum = vec3(0);
  for (int c = sun_columns - 1; c >= 0; --c) {
    vec4 entry = sun_map[sun_first + row * sun_columns + c];
    sum = vec3(sum.x, sum.y + sun_step * sum.x, sum.z * fallen) + entry.xyz;
    sun_map[sun_first + row * sun_columns + c] = vec4(sum, entry.w);
  }
}
