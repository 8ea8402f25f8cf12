// Camera rays, as scene/camera.h: film position in pixels, (0, 0) the top left corner.
uniform int perspective;      // 0: orthographic
uniform vec3 camera_position; // [m]
uniform vec3 camera_forward, camera_right, camera_up;  // right and up times half the film's size: at distance 1, or [m]
uniform int width, height;

void camera_ray(vec2 film, out vec3 origin, out vec3 direction) {
  float sx = 2 * film.x / float(width) - 1, sy = 1 - 2 * film.y / float(height);
  vec3 offset = sx * camera_right + sy * camera_up;
  origin = perspective != 0 ? camera_position : camera_position + offset;
  direction = perspective != 0 ? normalize(camera_forward + offset) : camera_forward;
}
