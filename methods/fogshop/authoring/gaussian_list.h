// The fog under the author's hands: an ordered list of Gaussians with names that are never used twice, and its undo.
//
// Zhou et al. 2007, section 6. Every operation is one step: what it added, changed and removed is kept, and undoing it
// restores list and order exactly. Ids are not taken back by an undo.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scene/math/types.h"

namespace airlight::fogshop::authoring {

using Id = std::int64_t;

// c exp(-a^2 |x - b|^2), scattering scaled by a colour: the paper's letters.
struct Gaussian {
  Id id = 0;
  double a = 1;                  // [1/m], > 0: one over the width
  double c = 1;                  // [1/m], > 0: extinction at the centre
  Point3 b = Point3::Zero();     // [m]
  Rgb color = Rgb::Ones();       // [-], in [0, 1]: scales scattering, not extinction
  std::string tag{};             // the author's name for a group; may be empty
  Vec3 velocity = Vec3::Zero();  // [m/s]: of airbrush particles that are not frozen
  bool operator==(const Gaussian& o) const {
    return id == o.id && a == o.a && c == o.c && b == o.b && (color == o.color).all() && tag == o.tag &&
           velocity == o.velocity;
  }
};

class GaussianList {
 public:
  // More than any scene needs: above it memory and the n^2 sums of the renderer are the trouble.
  static constexpr std::size_t greatest = 1'000'000;

  const std::vector<Gaussian>& all() const { return list_; }
  int steps() const { return int(history_.size()); }  // that can be undone

  // One operation's work; everything between two begins is one step. Positions are those in all().
  void begin();
  Id add(Gaussian);                             // its id is given here; throws Error above `greatest`
  void change(std::size_t position, Gaussian);  // keeps its id
  void remove(std::vector<std::size_t> positions);

  // Takes back the last step that is still there; false if there is none.
  bool undo();

 private:
  struct Kept {
    std::size_t position;
    Gaussian gaussian;
  };
  // The inverse of one change; undone from the last to the first.
  struct Edit {
    std::size_t added = 0;      // at the end of the list
    std::vector<Kept> changed;  // as they were
    std::vector<Kept> removed;  // positions before the removal, ascending
  };
  std::vector<Gaussian> list_;
  std::vector<std::vector<Edit>> history_;
  Id next_ = 1;
};

}  // namespace airlight::fogshop::authoring
