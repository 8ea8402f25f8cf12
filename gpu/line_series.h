// The rule that common/sign_changes.glsl reads: points on [-1, 1], and the matrix that makes a series of Legendre polynomials P from values
// at these points.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace airlight::gpu {

struct LineSeries {
  std::vector<float> values;                       // vectors of four: the points, then the matrix's columns
  std::map<std::string, std::string> definitions;  // SERIES, RULE_NODES and RULE_ANALYSIS
};
LineSeries line_series(int points);  // for polynomials of degree below `points`, 1 to 255

}  // namespace airlight::gpu
