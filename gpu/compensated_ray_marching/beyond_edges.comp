// Beyond hard edges logarithms go on as they do within: BeyondEdges::go_on.
layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = AT_EDGES) readonly buffer Edges { ivec2 edges[]; };         // cell; end of its entries
layout(std430, binding = AT_EDGE_NODES) readonly buffer EdgeNodes { int from[]; };   // cells within
layout(std430, binding = AT_EDGE_WEIGHTS) readonly buffer EdgeWeights { float edge_weights[]; };
layout(std430, binding = AT_LOGARITHMS) buffer Logarithms { vec4 logarithms[]; };
uniform int edge_count;

void main() {
  int n = int(gl_GlobalInvocationID.x);
  if (n >= edge_count) return;
  vec4 sum = vec4(0), most = vec4(-1e37);
  // Read before the loop: in its head llvmpipe (Mesa 22.3) also overwrites the cell of those invocations that have left the loop.
  int cell = edges[n].x, first = n > 0 ? edges[n - 1].y : 0, last = edges[n].y;
  for (int i = first; i < last; ++i) {
    sum += edge_weights[i] * logarithms[from[i]];
    most = max(most, logarithms[from[i]]);
  }
  logarithms[cell] = min(sum, most + 3);  // node_grid.cpp: steepest
}
