// The camera in double precision: pixels look along the same rays as on the processor, at any place in the world.
uniform int view_perspective;    // 0: orthographic
uniform dvec3 view_position;     // [m]
uniform dvec3 view_forward;      // unit
uniform dvec3 view_right, view_up;        // times half the film's size: at distance 1, or [m]
uniform dvec3 view_across, view_upwards;  // unit over the same
uniform int view_width, view_height;      // pixels
uniform double view_extent;      // [m] everything finite lies within it of the camera

// Through a place on the film in pixels, (0, 0) its top left corner: scene/camera.h.
void view_ray(dvec2 film, out dvec3 origin, out dvec3 direction) {
  double sx = 2 * film.x / double(view_width) - 1, sy = 1 - 2 * film.y / double(view_height);
  dvec3 offset = sx * view_right + sy * view_up;
  origin = view_perspective != 0 ? view_position : view_position + offset;
  direction = view_perspective != 0 ? normalize(view_forward + offset) : view_forward;
}
