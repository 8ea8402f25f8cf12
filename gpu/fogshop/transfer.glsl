// Reflectance times visibility, both in harmonics in the world's axes: products mix all bands, so all of them are held.
layout(std430, binding = AT_TRANSFER) readonly buffer Transfer { float transfer[]; };  // SH_SIZE for every vertex
uniform int reflected_at;  // where what other surfaces reflect begins, SH_SIZE for every channel of every vertex; -1: it is left out
uniform int product_at;  // for every coefficient the first of its (i, j, integral of three), SH_SIZE + 1 of them, then these

// V_p and the reflectance, a lane beside the other: products read each of their numbers dozens of times. Where all is Lambert's, the
// reflectance is one number times `diffuse`.
#if TABULATED
#define COLOURS 3
#define COLOUR vec3
#else
#define COLOURS 1
#define COLOUR float
#endif
shared float seen_rows[SH_SIZE * lane_count], turned_rows[COLOURS * SH_SIZE * lane_count];

int row_of(int i) { return i * lane_count + int(gl_LocalInvocationIndex); }
float seen_at(int i) { return seen_rows[row_of(i)]; }
#if TABULATED
vec3 turned_at(int i) {
  int k = row_of(3 * i);
  return vec3(turned_rows[k], turned_rows[k + lane_count], turned_rows[k + 2 * lane_count]);
}
void set_turned(int i, vec3 value) {
  for (int c = 0; c < 3; ++c) turned_rows[row_of(3 * i + c)] = value[c];
}
#else
float turned_at(int i) { return turned_rows[row_of(i)]; }
void set_turned(int i, float value) { turned_rows[row_of(i)] = value; }
#endif
vec3 functions[SH_SIZE];  // reflectance times visibility, and what others reflect

void turn_reflectance(Reflected r) {
  if (TABULATED == 0 || r.lambert) {
    for (ShPair y = first_pair(r.z); y.m < sh_order; next_pair(y, r.z)) {
      int i = y.l * (y.l + 1);
#if TABULATED
      vec3 factor = r.diffuse * (zonal_factor(y.l) * tables[cosine_at + y.l]);
#else
      float factor = zonal_factor(y.l) * tables[cosine_at + y.l];
#endif
      set_turned(i + y.m, factor * y.plus);
      if (y.m > 0) set_turned(i - y.m, factor * y.minus);
    }
  }
#if TURNED
  else {
    for (int l = 0; l < sh_order; ++l) {
      for (int i = 0; i <= 2 * l; ++i) set_row(i, own_coefficient(r, l * l + i));
      turn_band(l, r.x, r.z);
      for (int i = 0; i <= 2 * l; ++i) set_turned(l * l + i, row_at(i));
    }
  }
#endif
}

vec3 turned_scale(Reflected r) { return TABULATED != 0 ? vec3(1) : r.diffuse; }

// Where no visibility is known, the reflectance alone.
void keep_reflectance(Reflected r) {
  for (int i = 0; i < sh_order * sh_order; ++i) functions[i] = turned_scale(r) * turned_at(i);
}

// Times V_p of a mesh, and with what others reflect onto it. False on its inner side, which has neither.
bool shadow_reflectance(Reflected r, vec3 diffuse, ivec4 corners, dvec3 point, dvec3 normal) {
  dvec3 p = mesh_vertex(corners.x) - point, q = mesh_vertex(corners.y) - point, s = mesh_vertex(corners.z) - point;
  dvec3 face = cross(q - p, s - p);
  if (!(dot(face, normal) > 0)) return false;
  dvec3 areas = dvec3(dot(cross(q, s), face), dot(cross(s, p), face), dot(cross(p, q), face));
  vec3 weight = vec3(max(areas / dot(face, face), 0.0LF));
  weight /= weight.x + weight.y + weight.z;
  for (int i = 0; i < sh_order * sh_order; ++i)
    seen_rows[row_of(i)] = weight.x * transfer[corners.x * SH_SIZE + i] + weight.y * transfer[corners.y * SH_SIZE + i] +
                           weight.z * transfer[corners.z * SH_SIZE + i];
  int terms_at = product_at + SH_SIZE + 1, k = 0;
  for (int n = 0; n < sh_order * sh_order; ++n) {
    COLOUR sum = COLOUR(0);
    for (int end = int(tables[product_at + n + 1]); k < end; ++k) {
      int i = int(tables[terms_at + 3 * k]), j = int(tables[terms_at + 3 * k + 1]);
      COLOUR both = seen_at(i) * turned_at(j);
      if (i != j) both += seen_at(j) * turned_at(i);
      sum += tables[terms_at + 3 * k + 2] * both;
    }
    vec3 value = turned_scale(r) * sum;
    for (int c = 0; c < 3 && reflected_at >= 0; ++c) {
      ivec3 at = reflected_at + (3 * corners.xyz + c) * SH_SIZE + n;
      value[c] += diffuse[c] / pi * dot(weight, vec3(transfer[at.x], transfer[at.y], transfer[at.z]));
    }
    functions[n] = value;
  }
  return true;
}
