// Stretches of a ray between two cuts: where it meets boxes, and the planes where light comes in by another face.
const double least_share = 1e-14LF;

// The next cut after `last`; `nowhere` where there is none.
double next_cut(dvec3 origin, dvec3 direction, double end, double last) {
  double next = nowhere, after = last + least_share * last;
  for (int m = 0; m < MEDIA; ++m) {
    Local ray = local_ray(m, origin, direction);
    dvec2 part = chord(ray, end);
    bool meets = part.x < part.y;
    if (meets && part.x > after) next = min(next, part.x);
    if (meets && part.y > after) next = min(next, part.y);
    dvec3 rate = to_light * per_half[m];
    for (int a = 0; a < 3; ++a) {
      int b = (a + 1) % 3;
      double turn = ray.slope[a] * rate[b] - ray.slope[b] * rate[a];
      if (turn == 0) continue;
      double side_a = rate[a] > 0 ? 1 : -1, side_b = rate[b] > 0 ? 1 : -1;
      for (int edge = MEDIA > 1 ? 0 : 3; edge < 4; ++edge) {
        double at_a = (edge & 1) != 0 ? side_a : -side_a, at_b = (edge & 2) != 0 ? side_b : -side_b;
        double t = ((at_a - ray.origin[a]) * rate[b] - (at_b - ray.origin[b]) * rate[a]) / turn;
        if (t > after && t < (MEDIA > 1 ? end : part.y) && (MEDIA > 1 || t > part.x)) next = min(next, t);
      }
    }
  }
  return next;
}

bool inside(int medium, dvec3 at) { return all(lessThanEqual(abs((at - box_middle[medium]) * per_half[medium]), dvec3(1))); }

// From `last` on, moved to where it begins, to its end; false where there is none.
bool next_stretch(dvec3 origin, dvec3 direction, double end, inout double last, out double next) {
  for (;;) {
    next = next_cut(origin, direction, end, last);
    if (next >= nowhere) return false;
    dvec3 middle = origin + 0.5LF * (last + next) * direction;
    for (int m = 0; m < MEDIA; ++m)
      if (inside(m, middle)) return true;
    last = next;
  }
}
