// Lights and cameras that lie exactly on a surface: one rule for every renderer.
//
// A point or spot light that is closer to a surface than `on_surface` of the scene's size counts as lying on it, and
// lights the side that the surface's normal faces: outwards from spheres and closed shapes, where `normal` of a plane
// points, where the corners of a triangle run counter-clockwise. On an edge, a vertex, or several surfaces at once it
// lies in front of all faces that meet there. So it is moved off them, by `beside` of the size, before anything else
// sees it: far enough to be told apart in single precision too.
//
// A perspective camera counts as lying on a surface where single precision, in which meshes are traced, cannot tell:
// closer than `eye_on_surface` of the size. Half of its rays would begin behind the face and see its back. It is moved
// to the same side, by the same distance, before the lights.
//
// The size for a light is the diagonal of the box around all finite surfaces or the distance from the light to the
// camera, whichever is less, and at least 1e-9 of the former. For the camera it is the diagonal, or else the distance
// to the nearest light or, without one, to the origin.
#pragma once
#include "scene/scene.h"

namespace airlight::scene {

constexpr double on_surface = 1e-6, eye_on_surface = 0x1p-23, beside = 4e-6;

// Moves the camera, the lights. Throw Error where no place is in front of all faces (two surfaces touch back to back, a
// sheet without thickness) or only one so far away that the light would be another: the steepest face under 0.05 rad.
void move_camera_off_surfaces(Scene&);
void move_lights_off_surfaces(Scene&);

}  // namespace airlight::scene
