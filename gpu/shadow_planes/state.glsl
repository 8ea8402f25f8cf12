// Where a pixel was left that has more crossings than one gathering holds: the next dispatch goes on there. So no dispatch
// lasts, and no driver's limit on loops is met by the number of gatherings.
struct State {
  double last_key, from;
  vec4 sum;         // rgb
  int last_origin;
  int m;            // or the stencil
  int unfinished;   // 0: done
  int unused;
};
layout(std430, binding = 7) buffer States { State states[]; };
uniform int resume;  // 0: the first dispatch of a light

// Of pixel `place`: what is before the first crossing, or what was left.
State begin_state(int place, int m) {
  if (resume != 0) return states[place];
  return State(-1e300LF, 0, vec4(0), -1, m, 0, 0);
}
