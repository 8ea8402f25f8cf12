#include "gpu/legendre_fluids/lit_media.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu/line_series.h"
#include "scene/math/gauss_legendre.h"

namespace airlight::gpu::legendre_fluids {
namespace {

using airlight::legendre_fluids::LitMedia;
using airlight::legendre_fluids::LitMedium;
using scene::TensorShape;

int fours(int n) { return (n + 3) / 4; }

// The smallest shape that holds every medium's shape.
TensorShape shape_of(const LitMedia& media) {
  TensorShape shape{1, 1, 1};
  for (const LitMedium& m : media.media)
    for (std::size_t a = 0; a < 3; ++a) shape[a] = std::max(shape[a], m.field->shape()[a]);
  return shape;
}

bool any_negative(const LitMedia& media) {
  return std::any_of(media.media.begin(), media.media.end(), [](const LitMedium& m) { return m.field->negative(); });
}

std::vector<float> coefficients_of(const LitMedia& media) {
  const TensorShape all = shape_of(media);
  const int row = 4 * fours(all[2]);
  std::vector<float> values(std::max<std::size_t>(4, media.media.size() * std::size_t(all[0] * all[1] * row)));
  for (std::size_t m = 0; m < media.media.size(); ++m) {
    const scene::LegendreBox& box = *media.media[m].field;
    Eigen::Index from = 0;
    for (int i = 0; i < box.shape()[0]; ++i)
      for (int j = 0; j < box.shape()[1]; ++j)
        for (int k = 0; k < box.shape()[2]; ++k)
          values[((m * std::size_t(all[0]) + std::size_t(i)) * std::size_t(all[1]) + std::size_t(j)) *
                     std::size_t(row) +
                 std::size_t(k)] = float(box.coefficients()[from++] * std::sqrt((i + 0.5) * (j + 0.5) * (k + 0.5)));
  }
  return values;
}

// Integration rule along rays, by vectors of four.
class Rule {
 public:
  Rule(const LitMedia& media, const airlight::legendre_fluids::RayOptions& options, Definitions& definitions)
      : definitions_(definitions) {
    LineSeries line = line_series(media.coefficients);
    values = std::move(line.values);
    definitions_.merge(line.definitions);
    begin("WAY");
    const TensorShape shape = shape_of(media);
    const scene::GaussLegendre way = scene::gauss_legendre((shape[0] + shape[1] + shape[2] - 3) / 2 + 1);
    for (std::size_t i = 0; i < way.node.size(); ++i)
      add(Eigen::Vector4d(0.5 + 0.5 * way.node[i], 0.5 * way.weight[i], 0, 0));
    begin("PANEL");
    const scene::GaussLegendre panel = scene::gauss_legendre(options.points);
    for (std::size_t b = 0; b < panel.node.size(); b += 4) {
      Eigen::Vector4d node = Eigen::Vector4d::Zero(), weight = node;
      for (std::size_t c = b; c < std::min(b + 4, panel.node.size()); ++c)
        node[Eigen::Index(c - b)] = panel.node[c], weight[Eigen::Index(c - b)] = panel.weight[c];
      add(node), add(weight);
    }
    definitions_["WAY_POINTS"] = std::to_string(way.node.size());
    definitions_["PANEL_FOURS"] = std::to_string(fours(options.points));
    definitions_["RULE"] = std::to_string(values.size() / 4);
  }
  std::vector<float> values;

 private:
  void begin(const std::string& name) { definitions_["RULE_" + name] = std::to_string(values.size() / 4); }
  void add(const Eigen::VectorXd& list) {
    for (Eigen::Index i = 0; i < 4 * fours(int(list.size())); ++i)
      values.push_back(i < list.size() ? float(list[i]) : 0);
  }
  Definitions& definitions_;
};

}  // namespace

std::vector<std::string> unsupported(const LitMedia& media) {
  std::vector<std::string> reasons;
  const TensorShape shape = shape_of(media);
  if (const std::size_t count = media.media.size() * std::size_t(shape[0] * shape[1] * 4 * fours(shape[2]));
      count > std::size_t(most_densities))
    reasons.push_back(fmt::format("{} coefficients of densities: shaders have room for {}", count, most_densities));
  return reasons;
}

LightMediaOnDevice::LightMediaOnDevice(Context& context, const LitMedia& media,
                                       const airlight::legendre_fluids::RayOptions& options)
    : context_(context),
      media_(media),
      densities_(context, "coefficients of densities", coefficients_of(media)),
      rule_(context, "points along rays", Rule(media, options, definitions_).values) {
  const TensorShape shape = shape_of(media);
  definitions_["NEGATIVE"] = std::to_string(int(negative()));
  definitions_["MEDIA"] = std::to_string(media.media.size());
  definitions_["NX"] = std::to_string(shape[0]);
  definitions_["NY"] = std::to_string(shape[1]);
  definitions_["FOURS_Z"] = std::to_string(fours(shape[2]));
}

bool LightMediaOnDevice::become(const LitMedia& before) {
  if (before.media.size() != media_.media.size() || before.coefficients != media_.coefficients ||
      shape_of(before) != shape_of(media_) || any_negative(before) != negative())
    return false;
  const auto same = [](const LitMedium& a, const LitMedium& b) { return a.field == b.field; };
  if (flows_ || !std::equal(before.media.begin(), before.media.end(), media_.media.begin(), same))
    densities_.upload(coefficients_of(media_));
  flows_ = false;
  return true;
}

bool LightMediaOnDevice::negative() const { return any_negative(media_); }

// One medium has two ends and three planes where light changes its face; of several each has twelve, and all count in each.
int LightMediaOnDevice::stretches() const { return count() == 1 ? 4 : 14 * count(); }

void LightMediaOnDevice::bind(Program& p, const Vec3& to_light) const {
  densities_.bind_as(GL_UNIFORM_BUFFER, at::densities);
  rule_.bind_as(GL_UNIFORM_BUFFER, at::rule);
  p.set_double("to_light", to_light);
  for (std::size_t m = 0; m < media_.media.size(); ++m) {
    const Box& box = media_.media[m].field->box();
    const scene::Medium& medium = *media_.media[m].medium;
    p.set_double(at_index("box_middle", m), Vec3(0.5 * (box.lo + box.hi)));
    p.set_double(at_index("per_half", m), Vec3(2 * box.size().cwiseInverse()));
    p.set(at_index("sigma_t", m), medium.sigma_t);
    p.set(at_index("scattering", m), Rgb(medium.albedo * medium.sigma_t));
  }
}

bool LightMediaOnDevice::take(std::size_t medium, const Buffer& state, std::size_t field, int n, const Box& box) {
  if (medium >= media_.media.size()) return false;
  const scene::LegendreBox& held = *media_.media[medium].field;
  if (held.shape() != TensorShape{n, n, n} || held.box().lo != box.lo || held.box().hi != box.hi) return false;
  if (!taking_) {
    taking_ = &program(context_, "light_density", 64, 1, definitions_);
    least_ = std::make_unique<Buffer>(context_, "least density", 4);
  }
  Program& p = *taking_;
  bind(p, Vec3::Zero());
  state.bind(at::state);
  densities_.bind(at::targets);
  least_->bind(at::status);
  p.set("medium", int(medium));
  p.set("field", int(field));
  p.set("n", n);
  for (int part = 0; part < 3; ++part) {
    p.set("part", part);
    p.dispatch(part == 1 ? 8 * n * n * n : n * n * n);
  }
  flows_ = true;
  return true;
}

}  // namespace airlight::gpu::legendre_fluids
