#include "methods/fogshop/authoring/gaussian_list.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/base/error.h"

namespace airlight::fogshop::authoring {

void GaussianList::begin() { history_.emplace_back(); }

Id GaussianList::add(Gaussian gaussian) {
  if (list_.size() >= greatest) throw Error(fmt::format("more than {} Gaussians", greatest));
  auto& edits = history_.back();
  const bool goes_on = !edits.empty() && edits.back().changed.empty() && edits.back().removed.empty();
  if (!goes_on) edits.emplace_back();
  ++edits.back().added;
  gaussian.id = next_++;
  list_.push_back(std::move(gaussian));
  return list_.back().id;
}

void GaussianList::change(std::size_t position, Gaussian gaussian) {
  auto& edits = history_.back();
  const bool goes_on = !edits.empty() && edits.back().added == 0 && edits.back().removed.empty();
  if (!goes_on) edits.emplace_back();
  Gaussian& here = list_.at(position);
  edits.back().changed.push_back({position, here});
  gaussian.id = here.id;
  here = std::move(gaussian);
}

void GaussianList::remove(std::vector<std::size_t> positions) {
  std::sort(positions.begin(), positions.end());
  Edit edit;
  for (const std::size_t position : positions) edit.removed.push_back({position, list_.at(position)});
  std::size_t next = 0, to = 0;
  for (std::size_t from = 0; from < list_.size(); ++from) {
    if (next < positions.size() && positions[next] == from) {
      ++next;
      continue;
    }
    if (to != from) list_[to] = std::move(list_[from]);
    ++to;
  }
  list_.resize(to);
  history_.back().push_back(std::move(edit));
}

bool GaussianList::undo() {
  if (history_.empty()) return false;
  auto& edits = history_.back();
  for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
    list_.resize(list_.size() - edit->added);
    for (auto kept = edit->changed.rbegin(); kept != edit->changed.rend(); ++kept)
      list_[kept->position] = kept->gaussian;
    if (edit->removed.empty()) continue;
    std::vector<Gaussian> before;
    before.reserve(list_.size() + edit->removed.size());
    auto left = list_.begin();
    for (const Kept& kept : edit->removed) {
      while (before.size() < kept.position) before.push_back(std::move(*left++));
      before.push_back(kept.gaussian);
    }
    before.insert(before.end(), left, list_.end());
    list_ = std::move(before);
  }
  history_.pop_back();
  return true;
}

}  // namespace airlight::fogshop::authoring
