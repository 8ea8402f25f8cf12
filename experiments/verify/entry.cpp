#include "experiments/verify/entry.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "experiments/application/json_value.h"
#include "scene/base/error.h"

namespace airlight::experiments::verification {
namespace {

// The value found, short enough for one line.
std::string shown(const nlohmann::json& json) {
  std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return fmt::format("{} {}", json.type_name(), text);
}

// The number that a JSON number or a whole decimal string holds, or NaN.
double parsed(const nlohmann::json& json) {
  if (json.is_number()) return json.get<double>();
  if (!json.is_string()) return std::nan("");
  const std::string& text = json.get_ref<const std::string&>();
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  // A number below the smallest double is written out in full in some files: it counts as 0.
  if (code == std::errc::result_out_of_range && text.find("e-") != std::string::npos) return 0;
  return code == std::errc() && end == text.data() + text.size() ? value : std::nan("");
}

}  // namespace

void Value::complain(const std::string& expected) const {
  throw Error(fmt::format("{}: found {}, expected {}", where_, shown(*json_), expected));
}

bool Value::has(const std::string& field) const { return json_->is_object() && json_->contains(field); }

Value Value::operator[](const std::string& field) const {
  if (!json_->is_object()) complain("an object with '" + field + "'");
  const auto found = json_->find(field);
  if (found == json_->end()) throw Error(fmt::format("{}: missing field '{}'", where_, field));
  return {*found, where_ + "." + field};
}

Value Value::operator[](std::size_t index) const {
  if (!json_->is_array()) complain("an array");
  if (index >= json_->size()) complain(fmt::format("an array of more than {} elements", index));
  return {(*json_)[index], fmt::format("{}[{}]", where_, index)};
}

std::size_t Value::size() const {
  if (!json_->is_array()) complain("an array");
  return json_->size();
}

std::vector<std::string> Value::fields() const {
  if (!json_->is_object()) complain("an object");
  std::vector<std::string> names;
  for (const auto& item : json_->items()) names.push_back(item.key());
  return names;
}

double Value::number() const {
  const double value = parsed(*json_);
  if (!std::isfinite(value)) complain("a finite number");
  return value;
}

double Value::number_or_infinite() const {
  if (json_->is_string() && json_->get_ref<const std::string&>() == "inf") return infinity;
  const double value = parsed(*json_);
  if (!std::isfinite(value)) complain("a finite number or \"inf\"");
  return value;
}

double Value::number_in(double least, double greatest) const {
  const double value = parsed(*json_);
  if (!(value >= least && value <= greatest)) complain(fmt::format("a number from {} to {}", least, greatest));
  return value;
}

int Value::integer_in(int least, int greatest) const {
  const double value = parsed(*json_);
  if (!(value >= least && value <= greatest && value == std::floor(value)))
    complain(fmt::format("an integer from {} to {}", least, greatest));
  return int(value);
}

int Value::integer() const {
  if (!json_->is_number_integer()) complain("an integer");
  const auto value = json_->get<long long>();
  if (value < -2147483647 || value > 2147483647) complain("an integer of 32 bits");
  return int(value);
}

const std::string& Value::text() const {
  if (!json_->is_string()) complain("a string");
  return json_->get_ref<const std::string&>();
}

Vec3 Value::vector() const {
  if (size() != 3) complain("three numbers");
  return {(*this)[0].number(), (*this)[1].number(), (*this)[2].number()};
}

std::vector<double> Value::numbers() const {
  std::vector<double> result(size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (*this)[i].number();
  return result;
}

bool Value::is_array() const { return json_->is_array(); }

}  // namespace airlight::experiments::verification
