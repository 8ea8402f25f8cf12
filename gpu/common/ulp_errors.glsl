// Errors of ULP_ERRORS units in the last place in what a driver may compute with such errors, up or down by the bits of the
// result: put in front of every shader where AIRLIGHT_GPU_ULPS is set, to see that no test passes by the grace of one
// driver's exp. 0 stays 0, and what is as good as infinite stays what it is.
float ulps_off(float v) {
  int bits = floatBitsToInt(v), side = ((bits * 747796405) >> 30) & 1;
  return v == 0 || !(abs(v) < 1e37) ? v : intBitsToFloat(bits + (2 * side - 1) * ULP_ERRORS);
}
vec2 ulps_off(vec2 v) { return vec2(ulps_off(v.x), ulps_off(v.y)); }
vec3 ulps_off(vec3 v) { return vec3(ulps_off(v.xy), ulps_off(v.z)); }
vec4 ulps_off(vec4 v) { return vec4(ulps_off(v.xy), ulps_off(v.zw)); }

#define WITH_ERRORS(name, exact)                          \
  float name(float x) { return ulps_off(exact(x)); }      \
  vec2 name(vec2 x) { return ulps_off(exact(x)); }        \
  vec3 name(vec3 x) { return ulps_off(exact(x)); }        \
  vec4 name(vec4 x) { return ulps_off(exact(x)); }
WITH_ERRORS(exp_off, exp)
WITH_ERRORS(log_off, log)
WITH_ERRORS(sqrt_off, sqrt)
WITH_ERRORS(sin_off, sin)
WITH_ERRORS(cos_off, cos)
double sqrt_off(double x) { return sqrt(x); }
#define exp exp_off
#define log log_off
#define sqrt sqrt_off
#define sin sin_off
#define cos cos_off
