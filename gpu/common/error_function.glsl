// erf, absolute error 1.5e-7: Abramowitz and Stegun, formula 7.1.26. Absolute is what counts, in optical depths.
float error_function(float x) {
  float size = abs(x), t = 1 / (1 + 0.3275911 * size);
  float sum = 0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)));
  float value = 1 - sum * t * exp(-size * size);
  return x < 0 ? -value : value;
}
