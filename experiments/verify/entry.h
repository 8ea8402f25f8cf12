// One vector of a file, read with care: every access names file, entry and field in its complaint.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/math/types.h"

namespace airlight::experiments::verification {

// A value inside a vector, with the way to it. Numbers may be JSON numbers or decimal strings ("17 digits"); "inf"
// counts as a number only where asked. Every complaint is an Error.
class Value {
 public:
  Value(const nlohmann::json& json, std::string where) : json_(&json), where_(std::move(where)) {}

  bool has(const std::string& field) const;
  Value operator[](const std::string& field) const;  // of an object; complains if it is missing
  Value operator[](std::size_t index) const;         // of an array
  std::size_t size() const;                          // of an array
  std::vector<std::string> fields() const;           // of an object, in order

  double number() const;  // finite
  double number_or_infinite() const;
  double number_in(double least, double greatest) const;
  int integer() const;
  int integer_in(int least, int greatest) const;  // also written as a number without fraction
  const std::string& text() const;
  Vec3 vector() const;  // three numbers
  std::vector<double> numbers() const;

  bool is_array() const;
  const nlohmann::json& json() const { return *json_; }
  const std::string& where() const { return where_; }
  [[noreturn]] void complain(const std::string& expected) const;  // "WHERE: found X, expected ..."

 private:
  const nlohmann::json* json_;
  std::string where_;
};

// A field that is there or not.
inline double number_or(const Value& v, const std::string& field, double fallback) {
  return v.has(field) ? v[field].number() : fallback;
}

}  // namespace airlight::experiments::verification
