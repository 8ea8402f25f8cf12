#include "gpu/wavelet_fog/grids.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scene/base/error.h"

namespace airlight::gpu::wavelet_fog {
namespace {

using scene::IndexRange;

constexpr int filter_tile = 8, row_group = 64;

}  // namespace

int Grids::place(const IndexRange& range, int rim, bool scratch) {
  const std::size_t stride = std::size_t(range.size[0]) + 2 * rim,
                    size = stride * (std::size_t(range.size[1]) + 2 * rim);
  std::size_t& used = scratch ? scratch_used_ : kept_;
  if (used + size > std::size_t(std::numeric_limits<int>::max()))
    throw Unavailable(fmt::format("gpu: a map with its coarser grids of more than {} values", used));
  data_.push_back(
      {{range.lo[0], range.lo[1]}, {range.size[0], range.size[1]}, int(used + rim * stride + rim), int(stride)});
  ranges_.push_back(range);
  in_scratch_.push_back(scratch);
  used += size;
  scratch_ = std::max(scratch_, scratch_used_);
  return int(data_.size()) - 1;
}

int Grids::add(const IndexRange& range, int rim) { return place(range, rim, false); }
int Grids::scratch(const IndexRange& range) { return place(range, 0, true); }

void Grids::pass(Program& program, std::function<void(Program&)> set, const IndexRange& invocations) {
  passes_.push_back({&program, std::move(set), invocations.size[0], invocations.size[1]});
}

void Grids::filter(bool up, int from, int axis, const Taps& taps, int to, int added, double sign) {
  Program& p = program(context_, "filter", filter_tile, filter_tile,
                       {{"UP", up ? "1" : "0"},
                        {"AXIS", std::to_string(axis)},
                        {"TAPS", std::to_string(taps.values.size())},
                        {"FIRST_TAP", fmt::format("({})", taps.first)},
                        {"TAP_VALUES", listed(taps.values)}});
  pass(
      p,
      [=](Program& filter) {
        filter.set("from", from);
        filter.set("to", to);
        filter.set("added", added);
        filter.set("sign_", sign);
      },
      ranges_[to]);
}

void Grids::down(int from, const Taps& along_u, const Taps& along_v, int to) {
  IndexRange between = ranges_[from];
  between.lo[0] = ranges_[to].lo[0];
  between.size[0] = ranges_[to].size[0];
  const int half = scratch(between);
  filter(false, from, 0, along_u, half, -1, 1);
  filter(false, half, 1, along_v, to, -1, 1);
}

void Grids::up(int from, const Taps& along_u, const Taps& along_v, int to, int added, double sign) {
  IndexRange between = ranges_[from];
  between.lo[0] = ranges_[to].lo[0];
  between.size[0] = ranges_[to].size[0];
  const int half = scratch(between);
  filter(true, from, 0, along_u, half, -1, 1);
  filter(true, half, 1, along_v, to, added, sign);
}

void Grids::clamp(int from, int to) {
  const IndexRange range = ranges_[from];
  const int sums = scratch({{0, 0}, {2, range.size[1]}});
  const auto set = [=](Program& p) {
    p.set("from", from);
    p.set("to", to);
    p.set("sums", sums);
  };
  // A group a row; one for all rows; an invocation a value.
  pass(program(context_, "clamp", row_group, 1, {{"STAGE", "0"}}), set, {{0, 0}, {row_group * range.size[1], 1}});
  pass(program(context_, "clamp", row_group, 1, {{"STAGE", "1"}}), set, {{0, 0}, {row_group, 1}});
  pass(program(context_, "clamp", row_group, 1, {{"STAGE", "2"}}), set, range);
}

void Grids::allocate() {
  for (std::size_t i = 0; i < data_.size(); ++i)
    if (in_scratch_[i]) data_[i].offset += int(kept_);
  table_ = std::make_unique<Buffer>(context_, "grids of a map", data_);
  values_ = std::make_unique<Buffer>(context_, "values of grids", 4 * (kept_ + scratch_));
}

void Grids::upload(const std::vector<double>& values) {
  const GridData& g = data_[0];
  const int rows = g.offset / g.stride;  // of the rim
  std::vector<float> padded(std::size_t(g.stride) * (std::size_t(g.size[1]) + 2 * rows));
  for (int j = 0; j < g.size[1]; ++j)
    std::transform(values.begin() + std::ptrdiff_t(j) * g.size[0], values.begin() + std::ptrdiff_t(j + 1) * g.size[0],
                   padded.begin() + g.offset + std::ptrdiff_t(j) * g.stride, [](double value) { return float(value); });
  values_->upload(padded);
}

void Grids::run() const {
  bind();
  for (const Pass& pass : passes_) {
    pass.set(*pass.program);
    pass.program->dispatch(pass.columns, pass.rows);
  }
}

void Grids::bind() const {
  table_->bind(at::grids);
  values_->bind(at::values);
}

std::vector<double> Grids::download(int grid) const {
  const std::vector<float> all = values_->download<float>();
  const GridData& g = data_[grid];
  std::vector<double> values;
  for (int j = 0; j < g.size[1]; ++j)
    values.insert(values.end(), all.begin() + g.offset + std::ptrdiff_t(j) * g.stride,
                  all.begin() + g.offset + std::ptrdiff_t(j) * g.stride + g.size[0]);
  return values;
}

}  // namespace airlight::gpu::wavelet_fog
