// What the device knows of one light: the host never waits for it. The groups are those of indirect dispatches.
layout(std430, binding = AT_LIGHT_STATE) buffer LightState {
  uint edge_groups[3];   // an invocation per silhouette edge
  uint plane_groups[3];  // the same, by rows of vertices of its plane
  int edge_count;
  int count_at_camera;  // m there
  int left_out[];       // by edge: its plane cannot cut the medium in question (left_out.comp)
};
