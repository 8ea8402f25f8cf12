#include "gpu/compensated_ray_marching/residual_store.h"

#include <cstring>

#include "gpu/interface.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

const std::vector<Binding> residual_bindings = {{"RESIDUAL_INDEX", at::residual_index},
                                                {"RESIDUAL_VALUES", at::residual_values},
                                                {"RESIDUAL_MEMBERS", at::residual_members},
                                                {"RESIDUAL_POINTS", at::residual_points},
                                                {"RESIDUAL_RESULT", at::residual_result}};

// Four levels a word.
std::vector<std::uint32_t> packed(const std::vector<std::int8_t>& levels) {
  std::vector<std::uint32_t> words((levels.size() + 3) / 4, 0);
  if (!levels.empty()) std::memcpy(words.data(), levels.data(), levels.size());
  return words;
}

std::unique_ptr<Buffer> buffer(Context& context, const char* name, const std::vector<std::uint32_t>& words) {
  return std::make_unique<Buffer>(context, name, words);
}

// Exact up to 2^24.
void set(Program& program, const std::string& name, const Eigen::Vector3i& v) {
  program.set(name, Vec3(v.cast<double>()));
}

}  // namespace

ResidualOnDevice::ResidualOnDevice(Context& context, const Eigen::Vector3i& size,
                                   const std::vector<std::int8_t>& levels)
    : kind_(Kind::grid), size_(size), values_(buffer(context, "levels of a residual", packed(levels))) {}

ResidualOnDevice::ResidualOnDevice(Context& context, const Eigen::Vector3i& size, const scene::ApronBricks& bricks)
    : kind_(Kind::bricks),
      size_(size),
      index_(buffer(context, "index of bricks", bricks.index)),
      values_(buffer(context, "bricks of a residual", packed(bricks.values))) {}

ResidualOnDevice::ResidualOnDevice(Context& context, const Eigen::Vector3i& size, const scene::PerfectHash& hash,
                                   Membership membership, const Eigen::Vector3i& tile)
    : size_(size),
      domain_(hash.extent),
      tile_(tile),
      m_(hash.m),
      r_(hash.r),
      index_(buffer(context, "offsets of a hash", hash.offsets)) {
  const std::size_t positions = std::size_t(domain_[0]) * domain_[1] * domain_[2];
  if (membership == Membership::domain) {
    kind_ = Kind::domain;
    std::vector<std::uint32_t> bits(2 * hash.domain.size());
    if (!bits.empty()) std::memcpy(bits.data(), hash.domain.data(), 4 * bits.size());
    members_ = buffer(context, "domain of a hash", bits);
    values_ = buffer(context, "slots of a hash", packed(hash.values));
  } else if (positions <= std::size_t(1) << 24) {
    kind_ = Kind::tagged;
    std::vector<std::uint32_t> words(hash.values.size());
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = hash.tags[i] << 8 | std::uint8_t(hash.values[i]);
    values_ = buffer(context, "slots of a hash", words);
  } else {
    kind_ = Kind::tagged_wide;
    members_ = buffer(context, "tags of a hash", hash.tags);
    values_ = buffer(context, "slots of a hash", packed(hash.values));
  }
}

std::map<std::string, std::string> ResidualOnDevice::definitions() const {
  const auto number = [](Kind kind) { return std::to_string(int(kind)); };
  std::map<std::string, std::string> all = {{"RESIDUAL_KIND", number(kind_)},
                                            {"RESIDUAL_GRID", number(Kind::grid)},
                                            {"RESIDUAL_BRICKS", number(Kind::bricks)},
                                            {"RESIDUAL_TAGGED", number(Kind::tagged)},
                                            {"RESIDUAL_TAGGED_WIDE", number(Kind::tagged_wide)},
                                            {"RESIDUAL_DOMAIN", number(Kind::domain)}};
  define(residual_bindings, all);
  return all;
}

void ResidualOnDevice::bind(Program& program) const {
  if (index_) index_->bind(at::residual_index);
  values_->bind(at::residual_values);
  if (members_) members_->bind(at::residual_members);
  set(program, "residual_samples", size_);
  if (kind_ == Kind::grid || kind_ == Kind::bricks) return;
  program.set("residual_m", m_);
  program.set("residual_r", r_);
  set(program, "residual_domain_size", domain_);
  set(program, "residual_tile", tile_);
}

std::size_t ResidualOnDevice::bytes() const {
  return (index_ ? index_->bytes() : 0) + values_->bytes() + (members_ ? members_->bytes() : 0);
}

namespace {

Program& decoder(Context& context, const ResidualOnDevice& residual, bool between) {
  auto definitions = residual.definitions();
  definitions.insert({{"LOCAL_SIZE_X", "64"}, {"BETWEEN", between ? "1" : "0"}});
  return context.program("compensated_ray_marching/residual_levels.comp", definitions);
}

}  // namespace

std::vector<int> levels_on_device(Context& context, const ResidualOnDevice& residual, const Eigen::Vector3i& first,
                                  const Eigen::Vector3i& box) {
  const std::size_t count = std::size_t(box[0]) * box[1] * box[2];
  if (count == 0) return {};
  Program& program = decoder(context, residual, false);
  const Buffer result(context, "levels", 4 * count);
  result.bind(at::residual_result);
  residual.bind(program);
  set(program, "first", first);
  set(program, "box", box);
  program.set("count", int(count));
  program.dispatch(int(count));
  return result.download<int>();
}

std::vector<float> levels_between_on_device(Context& context, const ResidualOnDevice& residual,
                                            const std::vector<Eigen::Vector4f>& points) {
  if (points.empty()) return {};
  Program& program = decoder(context, residual, true);
  std::vector<float> flat;
  flat.reserve(4 * points.size());
  for (const Eigen::Vector4f& p : points) flat.insert(flat.end(), p.begin(), p.end());
  const Buffer at_points(context, "points", flat), result(context, "levels", 4 * points.size());
  at_points.bind(at::residual_points);
  result.bind(at::residual_result);
  residual.bind(program);
  program.set("count", int(points.size()));
  program.dispatch(int(points.size()));
  return result.download<float>();
}

}  // namespace airlight::gpu::compensated_ray_marching
