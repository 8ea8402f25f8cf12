// Columns of the medium in hand from any place to the sun: SunMap::column of methods/wavelet_fog/sun_map.cpp.
uniform double sun_x, sun_y, sun_z;  // towards the sun, unit
const double least_way = LEAST_WAY;  // [cells] over the ground up to which the walk is as short as a lookup

// From a to b with these slopes at the ends.
float hermite(float t, float a, float slope_a, float b, float slope_b) {
  float w = 1 - t;
  return w * w * ((1 + 2 * t) * a + t * slope_a) + t * t * ((1 + 2 * w) * b - w * slope_b);
}

// p: from the first entry [cells].
vec3 on_row(int row, double p) {
  int columns = sun_columns[medium], first = sun_first[medium] + clamp(row, 0, sun_rows[medium] - 1) * columns;
  double place = p / sun_step;
  if (!(place > 0)) return sun_map[first].xyz;
  if (!(place < columns - 1)) return vec3(0);
  int c = int(place);
  vec4 a = sun_map[first + c], b = sun_map[first + c + 1];
  float t = float(place - c), s = float(sun_step), k = float(sun_climb[medium]);
  vec3 sum = vec3(hermite(t, a.x, -s * a.w, b.x, -s * b.w), 0, 0);
  if (PROFILE == PROFILE_LAYERS) sum.y = hermite(t, a.y, -s * a.x, b.y, -s * b.x);
  if (PROFILE == PROFILE_EXPONENTIAL) sum.z = hermite(t, a.z, s * (k * a.z - a.w), b.z, s * (k * b.z - b.w));
  return sum;
}
vec3 sums_at(double p, double q) {
  double place = (q - sun_lo_q[medium]) / sun_step;
  if (!(place > -1 && place < sun_rows[medium])) return vec3(0);
  int row = int(floor(place));
  float t = float(place - row);
  vec3 a = on_row(row - 1, p), b = on_row(row, p), c = on_row(row + 1, p), d = on_row(row + 2, p);
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

float sun_column(dvec3 x) {
  dvec3 to_sun = dvec3(sun_x, sun_y, sun_z);
  Line line = line_over(x, to_sun);
  dvec2 way = clip_to_support(grids[fog.map], line, clip_to_region(x, to_sun, dvec2(0, 1e37)));
  if (!(way.y > way.x)) return 0;
  double across = length(line.along);
  if (!(across * (way.y - way.x) > least_way)) return integral_of(grids[fog.map], line, way, 1e37);
  double u = sun_along_u[medium], v = sun_along_v[medium];
  double p = line.start.x * u + line.start.y * v - sun_lo_p[medium], q = line.start.y * u - line.start.x * v;
  vec3 from = sums_at(p + way.x * across, q);
  float sum = 0;
  for (int k = 0; k < pieces_of(line); ++k) {
    COUNT_LOOP
    int below;
    dvec2 piece = between_knots(line, way, k, below);
    if (!(piece.y > piece.x)) continue;
    vec3 to = sums_at(p + piece.y * across, q);
    Factor factor = factor_between(line, below);
    if (PROFILE == PROFILE_EXPONENTIAL && factor.falls) {
      vec2 heights = vec2((line.height + piece * line.rise - FALL_BASE) / FALL_SCALE);
      sum += exp(-heights.x) * from.z - exp(-heights.y) * to.z;
    } else {
      sum += float(factor.value + factor.slope * piece.x) * (from.x - to.x) +
             float(factor.slope / across) * (from.y - to.y - float((piece.y - piece.x) * across) * to.x);
    }
    from = to;
  }
  return max(sum, 0) / float(across);
}
