// Reflectance times visibility, both in harmonics in the world's axes: products mix all bands, so all of them are held.
layout(std430, binding = AT_TRANSFER) readonly buffer Transfer { float transfer[]; };  // SH_SIZE for every vertex
uniform int reflected_at;  // where what other surfaces reflect begins, SH_SIZE for every channel of every vertex; -1: it is left out
uniform int product_at;  // for every coefficient the first of its (i, j, integral of three), SH_SIZE + 1 of them, then these

vec3 functions[2 * SH_SIZE];  // two of them
float seen_share[SH_SIZE];    // V_p

// Into the first function; that is where `low` points to.
void turn_reflectance(inout Reflected r) {
  if (r.lambert) {
    for (ShPair y = first_pair(r.z); y.m < sh_order; next_pair(y, r.z)) {
      int i = y.l * (y.l + 1);
      vec3 factor = r.diffuse * (zonal_factor(y.l) * tables[cosine_at + y.l]);
      functions[i + y.m] = factor * y.plus;
      if (y.m > 0) functions[i - y.m] = factor * y.minus;
    }
  }
#if TURNED
  else {
    for (int l = 0; l < sh_order; ++l) {
      for (int i = 0; i <= 2 * l; ++i) set_row(i, own_coefficient(r, l * l + i));
      turn_band(l, r.x, r.z);
      for (int i = 0; i <= 2 * l; ++i) functions[l * l + i] = row_at(i);
    }
  }
#endif
  r.low = 0;
}

// Times V_p of a mesh, and with what others reflect onto it, into the second function; its inner side has neither.
void shadow_reflectance(inout Reflected r, vec3 diffuse, ivec4 corners, dvec3 point, dvec3 normal) {
  dvec3 p = mesh_vertex(corners.x) - point, q = mesh_vertex(corners.y) - point, s = mesh_vertex(corners.z) - point;
  dvec3 face = cross(q - p, s - p);
  if (!(dot(face, normal) > 0)) return;
  dvec3 areas = dvec3(dot(cross(q, s), face), dot(cross(s, p), face), dot(cross(p, q), face));
  vec3 weight = vec3(max(areas / dot(face, face), 0.0LF));
  weight /= weight.x + weight.y + weight.z;
  for (int i = 0; i < sh_order * sh_order; ++i)
    seen_share[i] = weight.x * transfer[corners.x * SH_SIZE + i] + weight.y * transfer[corners.y * SH_SIZE + i] +
                    weight.z * transfer[corners.z * SH_SIZE + i];
  int terms_at = product_at + SH_SIZE + 1, k = 0;
  for (int n = 0; n < sh_order * sh_order; ++n) {
    vec3 sum = vec3(0);
    for (int end = int(tables[product_at + n + 1]); k < end; ++k) {
      int i = int(tables[terms_at + 3 * k]), j = int(tables[terms_at + 3 * k + 1]);
      vec3 both = seen_share[i] * functions[j];
      if (i != j) both += seen_share[j] * functions[i];
      sum += tables[terms_at + 3 * k + 2] * both;
    }
    for (int c = 0; c < 3 && reflected_at >= 0; ++c) {
      ivec3 at = reflected_at + (3 * corners.xyz + c) * SH_SIZE + n;
      sum[c] += diffuse[c] / pi * dot(weight, vec3(transfer[at.x], transfer[at.y], transfer[at.z]));
    }
    functions[SH_SIZE + n] = sum;
  }
  r.low = SH_SIZE;
}
