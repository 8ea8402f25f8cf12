// Real spherical harmonics of SH_ORDER bands for a unit direction, as scene/math/spherical_harmonics.h: orthonormal,
// Condon-Shortley, index l(l+1)+m, polar axis z. The same recurrence upwards in l.
//
// Loops run to a uniform: with a constant, Mesa unrolls all of them, and order 12 takes a minute and a half to compile.
uniform int sh_order;  // SH_ORDER
float sh[SH_ORDER * SH_ORDER];  // not an argument, which calls would copy
void evaluate_sh(vec3 direction) {
  float c = 1, s = 0;                          // of (x + iy)^m
  float diagonal = 0.25 / acos(-1.0);          // 1 / (4 pi)
  for (int m = 0; m < sh_order; ++m) {
    if (m > 0) diagonal *= (2.0 * m + 1) / (2.0 * m);
    float before = 0, q = (m % 2 != 0 ? -1 : 1) * sqrt((m > 0 ? 2 : 1) * diagonal);
    for (int l = m; l < sh_order; ++l) {
      if (l > m) {
        float span = float(l - m) * float(l + m);
        float next = sqrt((2.0 * l - 1) * (2.0 * l + 1) / span) * direction.z * q;
        if (l > m + 1)
          next -= sqrt((2.0 * l + 1) * (l - 1.0 - m) * (l - 1.0 + m) / ((2.0 * l - 3) * span)) * before;
        before = q;
        q = next;
      }
      sh[l * (l + 1) + m] = q * c;
      if (m > 0) sh[l * (l + 1) - m] = q * s;
    }
    float turned = c * direction.x - s * direction.y;
    s = c * direction.y + s * direction.x;
    c = turned;
  }
}
