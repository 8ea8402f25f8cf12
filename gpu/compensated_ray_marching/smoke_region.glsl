// The region that cuts smoke off, relative to the middle of the smoke.
#define REGION_BOX 1
#define REGION_SPHERE 2
#define REGION_SLAB 3
uniform int region_kind;  // 0: none
uniform vec3 region_a;    // lowest corner; centre; normal
uniform vec3 region_b;    // highest corner; radius; lowest and highest place along the normal

// The stretch of a ray from 0 on within it [x, y]; x > y: none.
vec2 region_part(vec3 origin, vec3 direction) {
  vec2 part = vec2(0, 1e37);
  if (region_kind == REGION_SPHERE) {
    vec3 offset = region_a - origin;
    float nearest = dot(offset, direction);
    vec3 aside = offset - nearest * direction;
    float half2 = region_b.x * region_b.x - dot(aside, aside);
    return half2 > 0 ? vec2(max(nearest - sqrt(half2), 0), nearest + sqrt(half2)) : vec2(1, -1);
  }
  for (int a = 0; a < (region_kind == REGION_BOX ? 3 : region_kind == REGION_SLAB ? 1 : 0); ++a) {
    float o = region_kind == REGION_BOX ? origin[a] : dot(origin, region_a);
    float d = region_kind == REGION_BOX ? direction[a] : dot(direction, region_a);
    float lo = region_kind == REGION_BOX ? region_a[a] : region_b.x, hi = region_kind == REGION_BOX ? region_b[a] : region_b.y;
    if (abs(d) < 1e-20) {
      if (o < lo || o > hi) return vec2(1, -1);
    } else {
      float p = (lo - o) / d, q = (hi - o) / d;
      part = vec2(max(part.x, min(p, q)), min(part.y, max(p, q)));
    }
  }
  return part;
}
