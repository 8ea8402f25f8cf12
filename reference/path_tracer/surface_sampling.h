// Reflection by surfaces: a direction drawn by the cosine or the mirror lobe of Phong, with its density.
#pragma once
#include "scene/geometry/surface.h"
#include "scene/math/types.h"

namespace airlight::path_tracer {

// `in` is unit and points away from the surface, back along the path; `normal` is on its side. The result may lie
// below the surface (the part of a Phong lobe that does): its reflectance is zero.
Vec3 sample_reflection(const scene::Material&, const Vec3& normal, const Vec3& in, double u_lobe, double u,
                       double turns);
// Its density over solid angle [1/sr].
double pdf_reflection(const scene::Material&, const Vec3& normal, const Vec3& in, const Vec3& out);

}  // namespace airlight::path_tracer
