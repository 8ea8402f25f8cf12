// A point light as a ray sees it, its map of depths, and the airlight of a homogeneous medium around it.
struct Light {
  vec3 position;  // [m]
  float map_near; // distances between which the Gaussians lie [m]
  vec3 intensity; // [W/sr]
  float map_far;
  vec3 axis_x;  // of the map's view
  float map_tangent;  // half its width at distance 1; 0: octahedral
  vec3 axis_y;
  int map_offset;  // of its first value in the maps
  vec3 axis_z;
  float unused;
};

layout(std140, binding = AT_LIGHTS) uniform Lights { Light lights[MOST_LIGHTS]; };
uniform int light_count;
uniform float source_radius;  // [m]

// Layout like methods/fogshop/light_map.h: a border of one texel, distances by edges.
uniform int map_directions, map_edges;

float map_distance(Light light, int edge) {
  float s = float(edge) / float(map_edges);
  return light.map_near + (light.map_far - light.map_near) * (light.map_near > 0 ? s : s * s);
}

const float least_h = 1e-9;  // [m] distance of a light from a ray

// A point light seen from a ray: it passes it at distance h [m], at the ray parameter `along` [m].
struct LightFromRay {
  float along, h;
};
LightFromRay light_from_ray(Light light, vec3 origin, vec3 direction) {
  vec3 offset = light.position - origin;
  float along = dot(offset, direction);
  return LightFromRay(along, length(offset - along * direction));
}
