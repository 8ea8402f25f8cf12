// The last picture's volume, looked up at a point: reference/froxel_fog/history.cpp.
layout(std430, binding = AT_HISTORY_LIGHT) readonly buffer HistoryLight { vec4 history_light[]; };
layout(std430, binding = AT_HISTORY_MEDIA) readonly buffer HistoryMedia { vec4 history_media[]; };
uniform int history_perspective, history_columns, history_rows;
uniform vec3 history_position;  // [m] from the media's middle
uniform vec3 history_forward, history_right, history_up;  // right and up over half the film's size, at distance 1 or [m]
uniform float history_film_width, history_film_height;  // in cells

// False where the point was outside the frustum or the slices.
bool history_at(vec3 x, out vec3 light, out vec3 media) {
  light = media = vec3(0);
  vec2 range = vec2(slice_values[3], slice_values[4]);
  vec3 from = x - history_position;
  float z = dot(from, history_forward);
  vec2 film = vec2(dot(from, history_right), dot(from, history_up)) / (history_perspective != 0 ? z : 1);
  bool known = z >= range.x && z <= range.y && abs(film.x) <= 1 && abs(film.y) <= 1;
  if (known) {
    vec2 at = 0.5 * vec2(1 + film.x, 1 - film.y) * vec2(history_film_width, history_film_height) - 0.5;
    Between across = between(at.x, history_columns), down = between(at.y, history_rows),
            deep = between(encode_depth(z, range) * float(slices) - 0.5, slices);
    vec3 shares = vec3(across.share, down.share, deep.share);
    for (int corner = 0; corner < 8; ++corner) {
      ivec3 up = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      vec3 share = mix(1 - shares, shares, equal(up, ivec3(1)));
      float w = share.x * share.y * share.z;
      if (w == 0) continue;  // there may be no such neighbour
      int place = ((deep.low + up.z) * history_rows + down.low + up.y) * history_columns + across.low + up.x;
      light += w * history_light[place].rgb;
      media += w * history_media[place].rgb;
    }
  }
  return known;
}
