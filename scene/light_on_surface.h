// Lights that lie exactly on a surface: one rule for every renderer.
//
// A point or spot light that is closer to a surface than `on_surface` of the scene's size counts as lying on it, and
// lights the side that the surface's normal faces: outwards from spheres and closed shapes, where `normal` of a plane
// points, where the corners of a triangle run counter-clockwise. On an edge, a vertex, or several surfaces at once it
// lies in front of all faces that meet there. So it is moved off them, by `beside` of the size, before anything else
// sees it: far enough to be told apart in single precision too.
//
// The size is the diagonal of the box around all finite surfaces or the distance from the light to the camera,
// whichever is less, and at least 1e-9 of the former.
#pragma once
#include "scene/scene.h"

namespace airlight::scene {

constexpr double on_surface = 1e-6, beside = 4e-6;

// Moves the lights. Throws Error where no place is in front of all faces (two surfaces touch back to back, a sheet
// without thickness) or only one so far away that the light would be another: the steepest face under 0.05 rad.
void move_lights_off_surfaces(Scene&);

}  // namespace airlight::scene
