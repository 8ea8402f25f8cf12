// Products of functions in harmonics, cut to as many: scene/math/sh_product.h, what each coefficient sums in a row.
struct Term {
  int i, j;      // of the factors; the first BANDS entries say where the terms of a coefficient begin and end
  double value;
};
layout(std430, binding = AT_TERMS) readonly buffer Terms { Term terms[]; };
