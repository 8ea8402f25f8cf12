// The grid of methods/fogshop/sky_volume.h: light of the environment that reaches its nodes unscattered.
layout(std430, binding = AT_SKY_VOLUME) buffer SkyVolume { float node_light[]; };  // J [W/m^2/sr], three channels, x fastest
uniform vec3 grid_corner;  // [m]
uniform float grid_cell;   // [m]
uniform vec3 grid_last;    // greatest node index per axis, >= 1

int node_place(ivec3 node) {
  ivec3 size = ivec3(grid_last) + 1;
  return 3 * (node.x + size.x * (node.y + size.y * node.z));
}
