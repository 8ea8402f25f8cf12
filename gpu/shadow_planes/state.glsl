// Where a pixel was left that has more crossings than one dispatch may gather: the next goes on there. So no dispatch lasts, and no
// driver's limit on loops is met by the number of gatherings.
struct State {
  double last_key, from;
  vec4 sum;         // rgb
  int last_origin;
  int m;            // or the stencil
  int unfinished;   // 0: done
  int m_origin;     // of a parallel view: m where the ray begins (counts.comp)
};
layout(std430, binding = AT_STATES) buffer States { State states[]; };
uniform int resume;           // 0: the first dispatch of a light
uniform int most_gatherings;  // of a dispatch, > 0

// Start state of pixel `place`: the state before the first crossing, or where the last dispatch stopped.
State begin_state(int place, int m) {
  if (resume != 0) return states[place];
  return State(-1e300LF, 0, vec4(0), -1, m, 0, m);
}

// Work of a pixel: lit parts, crossings, gatherings after the first.
struct Work {
  int parts, crossings, gatherings;
};
