// Densities on lines as polynomials on [-1, 1], by their series of P, and where they are positive: scene/media/legendre_line.h, by a scan
// that also looks where a dip begins and ends between two of its places. Includers define `rule` (gpu/line_series.h), SERIES_FOURS and
// density_at().
#define PIECES (4 * SERIES)

// Along middle + z slope, exactly.
void series_of(int medium, vec3 middle, vec3 slope, out vec4 c[SERIES_FOURS]) {
  for (int b = 0; b < SERIES_FOURS; ++b) c[b] = vec4(0);
  for (int q = 0; q < SERIES; ++q) {
    float density = density_at(medium, middle + rule[RULE_NODES + q / 4][q % 4] * slope);
    for (int b = 0; b < SERIES_FOURS; ++b) c[b] += rule[RULE_ANALYSIS + q * SERIES_FOURS + b] * density;
  }
}

// Value, slope, and integral from -1, of the polynomial at z.
vec3 of_series(vec4 c[SERIES_FOURS], float z) {
  float before = 0, p = 1, slope_before = 0, slope = 0;
  vec3 sum = vec3(0);
  for (int k = 0; k < SERIES; ++k) {
    float next = (float(2 * k + 1) * z * p - float(k) * before) / float(k + 1), next_slope = slope_before + float(2 * k + 1) * p;
    sum += c[k / 4][k % 4] * vec3(p, slope, k == 0 ? z + 1 : (next - before) / float(2 * k + 1));
    before = p, p = next;
    slope_before = slope, slope = next_slope;
  }
  return sum;
}

// -1 or 1: its sign everywhere; 0: nobody knows.
int sign_of(vec4 c[SERIES_FOURS]) {
  float others = -abs(c[0].x);
  for (int b = 0; b < SERIES_FOURS; ++b) others += dot(abs(c[b]), vec4(1));
  return c[0].x >= others ? 1 : c[0].x <= -others ? -1 : 0;
}

float scan_place(int piece) {
  float t = float(2 * piece) / float(PIECES) - 1;
  return t * (1.5 - 0.5 * t * t);  // denser at the ends
}

// Between two places of different signs.
float root_between(vec4 c[SERIES_FOURS], float low, float value_low, float high) {
  for (int step_ = 0; step_ < 20; ++step_) {
    float middle = 0.5 * (low + high), value = of_series(c, middle).x;
    if ((value < 0) == (value_low < 0))
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

// Where a dip or a bump may be between two places of one sign; `low` where none is.
float turn_between(float low, vec3 at_low, float high, vec3 at_high) {
  bool turns = at_low.x < 0 ? at_low.y > 0 && at_high.y < 0 : at_low.y < 0 && at_high.y > 0;
  return turns ? mix(low, high, at_low.y / (at_low.y - at_high.y)) : low;
}

float positive_between(vec4 c[SERIES_FOURS], float low, vec3 at_low, float high, vec3 at_high) {
  if (at_low.x >= 0 && at_high.x >= 0) return at_high.z - at_low.z;
  if (at_low.x <= 0 && at_high.x <= 0) return 0;
  float there = of_series(c, root_between(c, low, at_low.x, high)).z;
  return at_low.x > 0 ? there - at_low.z : at_high.z - there;
}

// The integral of what is positive.
float positive_part(vec4 c[SERIES_FOURS]) {
  int sign_ = sign_of(c);
  if (sign_ != 0) return sign_ > 0 ? 2 * c[0].x : 0;
  float low = -1, sum = 0;
  vec3 at_low = of_series(c, low);
  for (int piece = 1; piece <= PIECES; ++piece) {
    float high = scan_place(piece);
    vec3 at_high = of_series(c, high);
    float turn = (at_low.x < 0) == (at_high.x < 0) ? turn_between(low, at_low, high, at_high) : low;
    if (turn > low) {
      vec3 at_turn = of_series(c, turn);
      sum += positive_between(c, low, at_low, turn, at_turn);
      low = turn, at_low = at_turn;
    }
    sum += positive_between(c, low, at_low, high, at_high);
    low = high, at_low = at_high;
  }
  return max(sum, 0);
}

// The last place where the sign is beyond doubt, on the way of first_change().
struct Known {
  float at, value;
};

// Has the sign changed from there to here: beyond -1 + `margin` the place, otherwise 2.
float change_at(vec4 c[SERIES_FOURS], float here, float value, float noise, float margin, inout Known known) {
  if (abs(value) <= noise) return 2;
  float root = 2;
  if (known.value != 0 && (known.value < 0) != (value < 0)) root = root_between(c, known.at, known.value, here);
  known = Known(here, value);
  return root > margin - 1 ? root : 2;
}

// The first place beyond -1 + `margin` where the sign changes, 2 where none does. Values up to `noise` have none: where rounding alone
// decides, each stretch would begin at another change.
float first_change(vec4 c[SERIES_FOURS], float margin, float noise) {
  if (sign_of(c) != 0) return 2;
  float low = -1, found = 2;
  vec3 at_low = of_series(c, low);
  Known known = Known(low, 0);
  found = change_at(c, low, at_low.x, noise, margin, known);
  for (int piece = 1; piece <= PIECES && found > 1; ++piece) {
    float high = scan_place(piece);
    vec3 at_high = of_series(c, high);
    float turn = (at_low.x < 0) == (at_high.x < 0) ? turn_between(low, at_low, high, at_high) : low;
    if (turn > low && turn < high) found = change_at(c, turn, of_series(c, turn).x, noise, margin, known);
    if (found > 1) found = change_at(c, high, at_high.x, noise, margin, known);
    low = high, at_low = at_high;
  }
  return found;
}
