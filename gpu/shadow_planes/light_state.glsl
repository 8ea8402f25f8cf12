// State of one light that only the device knows, so that the host never waits for it. Shaders that only read it do so
// through a uniform block.
#if FINDS_LIGHT_STATE
layout(std430, binding = AT_LIGHT_STATE) buffer LightState {
  int edge_count;
  int count_at_camera;   // m there
  uint edge_groups[3];   // of indirect dispatches: an invocation per silhouette edge
  uint plane_groups[3];  // of indirect dispatches by rows of vertices of an edge's plane
};
#else
layout(std140, binding = AT_LIGHT_STATE) uniform LightState { int edge_count, count_at_camera; };
#endif
