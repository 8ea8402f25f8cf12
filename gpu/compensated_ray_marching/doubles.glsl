// exp in double precision, which GLSL has not, to 2e-16 of the value; nothing below exp(-700), and exp(700) above it.
double power_of_two(int k) { return packDouble2x32(uvec2(0u, uint(k + 1023) << 20)); }  // k from -1022 to 1023
// 2^exponent_of(x) <= x < 2^(exponent_of(x) + 1), for what is above 0 and normal.
int exponent_of(double x) { return int(unpackDouble2x32(x).y >> 20 & 2047u) - 1023; }

double exp_double(double x) {
  double within = clamp(x, -700.0LF, 700.0LF);
  int k = int(floor(1.4426950408889634LF * within + 0.5LF));
  // The logarithm of 2 in two parts, of which the first has room for k.
  double r = (within - double(k) * 0.693147180369123816490LF) - double(k) * 1.90821492927058770002e-10LF;
  double sum = 1.6059043836821613e-10LF;  // 1 / 13!, and so on: r is at most half of that logarithm
  sum = 2.08767569878681e-09LF + r * sum;
  sum = 2.505210838544172e-08LF + r * sum;
  sum = 2.755731922398589e-07LF + r * sum;
  sum = 2.7557319223985893e-06LF + r * sum;
  sum = 2.48015873015873e-05LF + r * sum;
  sum = 0.0001984126984126984LF + r * sum;
  sum = 0.001388888888888889LF + r * sum;
  sum = 0.008333333333333333LF + r * sum;
  sum = 0.041666666666666664LF + r * sum;
  sum = 0.16666666666666666LF + r * sum;
  sum = 0.5LF + r * sum;
  sum = 1 + r * (1 + r * sum);
  return x < -700 ? 0 : sum * power_of_two(k);
}
