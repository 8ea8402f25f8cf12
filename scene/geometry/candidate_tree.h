// Which primitives may a ray meet? A bounding volume hierarchy by Embree over the boxes of primitives.
//
// Embree traverses in float. So that this never decides anything, boxes and rays are moved to the unit cube in double
// first (recentred, scaled by a power of two, the ray started where it enters the cube), and every box is widened by
// more than the rounding of that ray: each primitive that the exact ray meets is a candidate, and the caller tests
// candidates in double. Answers are then the same for every instruction set, thread and build of the tree, and scale
// bit by bit with a scene that is scaled by a power of two.
#pragma once
#include <memory>
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

class CandidateVisitor {
 public:
  // Called for candidate `index`. Returns the t beyond which nothing is of interest any more (at most what it was
  // before); a negative value ends the visit.
  virtual double visit(unsigned index) = 0;

 protected:
  ~CandidateVisitor() = default;
};

class CandidateTree {
 public:
  explicit CandidateTree(const std::vector<Box>& boxes);  // finite; at least one
  ~CandidateTree();

  // Visits at least every box that the ray meets in 0 < t < tmax, each at most once, in no order. Thread safe.
  void visit(const Ray&, double tmax, CandidateVisitor&) const;
  // Any-hit traversal: visits nodes in no particular order and stops at the first hit. Only negative
  // answers of the visitor count.
  void visit_until(const Ray&, double tmax, CandidateVisitor&) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace airlight::scene
