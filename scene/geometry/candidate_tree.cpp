#include "scene/geometry/candidate_tree.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cmath>

#include "scene/base/error.h"

namespace airlight::scene {
namespace {

// In units of the cube [-1, 1]^3. The float ray errs by at most 2^-24 in its origin and 2^-25 * 2 sqrt(3) in its
// direction times its length: 1.7e-7 together.
constexpr double widening = 1e-6;

// State of one traversal, for the callbacks.
struct Traversal : RTCIntersectContext {
  CandidateVisitor* visitor;
  double start;  // t where the float ray begins
  double scale;  // 1/m

  // t as the float ray counts it, rounded up beyond its error.
  float limit(double t) const {
    const double length = (t - start) * scale;
    return length < 16 ? float(length * (1 + 1e-6) + 2 * widening) : 16.0f;
  }
};

void candidate(const RTCIntersectFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto* traversal = static_cast<Traversal*>(args->context);
  RTCRay& ray = reinterpret_cast<RTCRayHit*>(args->rayhit)->ray;
  const double tmax = traversal->visitor->visit(args->primID);
  // Below tnear: Embree finds every remaining box too far.
  ray.tfar = tmax < 0 ? -1.0f : std::min(ray.tfar, traversal->limit(tmax));
}

void candidate_until(const RTCOccludedFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto* traversal = static_cast<Traversal*>(args->context);
  if (traversal->visitor->visit(args->primID) < 0) reinterpret_cast<RTCRay*>(args->ray)->tfar = -infinity;
}

void require(RTCDevice device, bool good) {
  if (!good) throw Error(fmt::format("Embree failed with code {}", int(rtcGetDeviceError(device))), 3);
}

}  // namespace

struct CandidateTree::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Point3 center;
  double scale;                 // a power of two
  Box bounds;                   // of all boxes, widened twice [m]
  std::vector<RTCBounds> unit;  // of each box, widened

  explicit Impl(const std::vector<Box>& boxes) {
    Box all;
    for (const Box& box : boxes) all = unite(all, box);
    center = all.center();
    int exponent = 0;
    std::frexp(std::max(0.5 * all.size().maxCoeff(), std::numeric_limits<double>::min()), &exponent);
    scale = std::ldexp(1.0, -exponent);
    bounds = {all.lo.array() - 2 * widening / scale, all.hi.array() + 2 * widening / scale};
    unit.reserve(boxes.size());
    for (const Box& box : boxes) {
      const Vec3 lo = ((box.lo - center) * scale).array() - widening;
      const Vec3 hi = ((box.hi - center) * scale).array() + widening;
      unit.push_back({float(lo[0]), float(lo[1]), float(lo[2]), 0, float(hi[0]), float(hi[1]), float(hi[2]), 0});
    }
    try {
      build();
    } catch (...) {
      release();
      throw;
    }
    unit = {};
  }
  ~Impl() { release(); }

  void build() {
    // One instruction set for everybody, as for all float code here; the answers do not depend on it.
    device = rtcNewDevice("isa=avx2");
    require(device, device != nullptr);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    require(device, geometry != nullptr);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(unit.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(
        geometry,
        [](const RTCBoundsFunctionArguments* args) {
          *args->bounds_o = static_cast<const Impl*>(args->geometryUserPtr)->unit[args->primID];
        },
        nullptr);
    rtcSetGeometryIntersectFunction(geometry, candidate);
    rtcSetGeometryOccludedFunction(geometry, candidate_until);
    rtcCommitGeometry(geometry);
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    require(device, rtcGetDeviceError(device) == RTC_ERROR_NONE);
  }

  void release() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  // The part of (0, tmax) inside the bounds.
  Interval clip(const Ray& ray, double tmax) const {
    Interval range{0, tmax};
    for (int axis = 0; axis < 3; ++axis) {
      const double o = ray.origin[axis], d = ray.direction[axis];
      if (d == 0) {
        if (!(o >= bounds.lo[axis] && o <= bounds.hi[axis])) return {};
        continue;
      }
      const double a = (bounds.lo[axis] - o) / d, b = (bounds.hi[axis] - o) / d;
      range = intersect(range, Interval{std::min(a, b), std::max(a, b)});
    }
    return range;
  }

  bool begin(const Ray&, double tmax, CandidateVisitor&, Traversal&, RTCRay&) const;
};

CandidateTree::CandidateTree(const std::vector<Box>& boxes) : impl_(std::make_unique<Impl>(boxes)) {}
CandidateTree::~CandidateTree() = default;

// The ray as the tree counts, its traversal made ready with it; false where it misses everything.
bool CandidateTree::Impl::begin(const Ray& ray, double tmax, CandidateVisitor& visitor, Traversal& traversal,
                                RTCRay& query) const {
  const Interval range = clip(ray, tmax);
  if (range.empty()) return false;  // also for a ray that is not finite
  rtcInitIntersectContext(&traversal);
  traversal.visitor = &visitor;
  traversal.start = range.lo;
  traversal.scale = scale;

  const Point3 start = (ray.at(range.lo) - center) * scale;
  query.org_x = float(start[0]);
  query.org_y = float(start[1]);
  query.org_z = float(start[2]);
  query.dir_x = float(ray.direction[0]);
  query.dir_y = float(ray.direction[1]);
  query.dir_z = float(ray.direction[2]);
  query.tnear = 0;
  query.tfar = traversal.limit(range.hi);
  query.time = 0;
  query.mask = ~0u;
  query.id = 0;
  query.flags = 0;
  return true;
}

// In both, floats that flush to zero would change nothing (the coordinates are of order one), so the caller's mode
// stays.
void CandidateTree::visit(const Ray& ray, double tmax, CandidateVisitor& visitor) const {
  Traversal traversal;
  RTCRayHit query;
  if (!impl_->begin(ray, tmax, visitor, traversal, query.ray)) return;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &traversal, &query);
}

void CandidateTree::visit_until(const Ray& ray, double tmax, CandidateVisitor& visitor) const {
  Traversal traversal;
  RTCRay query;
  if (impl_->begin(ray, tmax, visitor, traversal, query)) rtcOccluded1(impl_->scene, &traversal, &query);
}

}  // namespace airlight::scene
