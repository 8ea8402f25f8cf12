// Suggestions for a mistyped word.
#pragma once
#include <string>
#include <vector>

namespace airlight::scene {

// " (nearest: width)": a candidate that begins with the word, else the one with the smallest edit distance. Empty where
// no candidate is near: one letter or at most half of the longer word changed, or one begins with the other.
std::string nearest_hint(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace airlight::scene
