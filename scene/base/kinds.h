// Closed sets of kinds (std::variant: fields, regions, lights, ...), used so that a new kind does not compile where it is
// not thought of, and is refused by name where it is not known.
#pragma once
#include <fmt/ranges.h>

#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace airlight::scene {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

// Calls, of several functions, the one for the kind that the value is of: std::visit with one function for each kind.
// None of them may take `auto`, which would swallow new kinds.
template <class Variant, class... F>
decltype(auto) match(Variant&& value, F&&... functions) {
  return std::visit(Overloaded<std::decay_t<F>...>{std::forward<F>(functions)...}, std::forward<Variant>(value));
}

// One of each kind, as it is by default, in the variant's order.
template <class Variant>
struct Kinds;
template <class... Kind>
struct Kinds<std::variant<Kind...>> {
  static std::vector<std::variant<Kind...>> all() { return {std::variant<Kind...>(Kind{})...}; }
};

// The reason of a renderer that supports only these kinds: "grid, expected homogeneous or gaussians". Empty if it
// supports this one. `name` names a kind.
template <class... Known, class Variant>
std::string unknown_kind(const Variant& value, std::string (*name)(const Variant&)) {
  if ((std::holds_alternative<Known>(value) || ...)) return "";
  return fmt::format("{}, expected {}", name(value),
                     fmt::join(std::vector<std::string>{name(Variant(Known{}))...}, " or "));
}

}  // namespace airlight::scene
