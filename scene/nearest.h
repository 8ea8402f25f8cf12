// What a mistyped word may have meant.
#pragma once
#include <string>
#include <vector>

namespace airlight::scene {

// " (nearest: width)": the candidate with the smallest edit distance; nothing where none is near: one letter or at most
// half of the longer word changed, or the word begins with it.
std::string nearest_hint(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace airlight::scene
