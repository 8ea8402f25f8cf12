// One line of a script: a JSON object, read key by key, so that every mistake is told in the same words:
//   SCRIPT:LINE: paint: a = -1, expected a number > 0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/application/json_value.h"
#include "scene/load/values.h"
#include "scene/math/types.h"

namespace airlight::experiments::authoring {

class Operation {
 public:
  // Parses the line; `where` is "SCRIPT:LINE". Throws Error if it is no JSON object, or has a key twice.
  Operation(const std::string& line, std::string where);

  // The value of "op", one of the choices.
  std::string name(const std::vector<std::string>& choices);
  // The only keys there may be beside "op".
  void allow(std::vector<std::string> keys) const;

  bool has(const std::string& key) const { return json_.contains(key); }
  std::string one_of(const std::vector<std::string>& keys) const;  // exactly one of them must be there: which
  double number(const std::string& key, const scene::load::Range&, std::optional<double> fallback = {}) const;
  long long integer(const std::string& key, long long least, long long greatest,
                    std::optional<long long> fallback = {}) const;
  std::string text(const std::string& key, std::optional<std::string> fallback = {}) const;
  std::string choice(const std::string& key, const std::vector<std::string>& choices,
                     std::optional<std::string> fallback = {}) const;
  Vec3 vector(const std::string& key, std::optional<Vec3> fallback = {}) const;
  Vec3 direction(const std::string& key, std::optional<Vec3> fallback = {}) const;  // unit
  Rgb color(const std::string& key) const;  // in [0, 1], a number or three; white if not there
  // A list of lists of `length` numbers; at least one and at most 100000.
  std::vector<std::vector<double>> points(const std::string& key, std::size_t length) const;
  std::vector<double> numbers(const std::string& key, std::size_t length) const;
  std::vector<long long> integers(const std::string& key) const;
  // An object under the key, read in the same way; nothing if there is none.
  std::optional<Operation> table(const std::string& key) const;

  // "WHERE: OP: key = <found>, expected <expected>".
  [[noreturn]] void expected(const std::string& key, const std::string& expected) const;
  [[noreturn]] void fail(const std::string& message) const;  // "WHERE: OP: message"
  const std::string& where() const { return where_; }

 private:
  Operation(nlohmann::json json, std::string where, int) : json_(std::move(json)), where_(std::move(where)) {}
  const nlohmann::json& require(const std::string& key, const std::string& what) const;
  double finite(const nlohmann::json&, const std::string& key, const std::string& what) const;

  nlohmann::json json_;
  std::string where_;
};

// Calls body(operation, line) for every operation of a script, in order, until it returns false; empty lines and lines that
// begin with # are passed over. `check` is called before each and may throw to stop.
void for_each_operation(const std::string& path, const std::function<void()>& check,
                        const std::function<bool(Operation, int line)>& body);

// Calls body; puts `where` ("SCRIPT:LINE") in front of an Error that does not begin with it.
void at_operation(const std::string& where, const std::function<void()>& body);

}  // namespace airlight::experiments::authoring
