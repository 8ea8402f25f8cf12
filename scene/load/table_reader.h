// Reading a TOML table key by key, so that every mistake in a file of ours is told in the same words:
//   file:line:column: light 0: radius = -1, expected a number >= 0
//
// A reader first says which keys may stand in its table (`allow`: anything else is an error that names the nearest
// valid key), then asks for each. Integers are accepted where numbers are expected; NaN and infinity are not. All
// functions throw Error.
#pragma once
#include <toml++/toml.h>

#include <optional>
#include <string>
#include <vector>

#include "scene/load/values.h"
#include "scene/math/types.h"

namespace airlight::scene::load {

class TableReader {
 public:
  // `where` begins every message after the position: "light 0"; may be empty.
  TableReader(const toml::table&, std::string where);

  // The value of the key `type`, which decides on the other keys: may be read before they are known.
  std::string type(const std::vector<std::string>& choices, std::optional<std::string> fallback = {});

  // The only keys there may be; called again, it replaces the first list.
  void allow(std::vector<std::string> keys);

  bool has(const std::string& key) const;
  // Exactly one of these keys must be there: which.
  std::string one_of(const std::vector<std::string>& keys) const;

  double number(const std::string& key, const Range&, std::optional<double> fallback = {}) const;
  long long integer(const std::string& key, long long least, long long greatest,
                    std::optional<long long> fallback = {}) const;
  bool flag(const std::string& key, bool fallback) const;
  std::string text(const std::string& key, std::optional<std::string> fallback = {}) const;
  // A text that people read and that output files are named after: one line of 1 to 200 bytes.
  std::string name(const std::string& key, std::optional<std::string> fallback = {}) const;
  // A name that is used as a part of a file's name as it stands: it cannot lead into another folder.
  std::string file_name(const std::string& key, std::optional<std::string> fallback = {}) const;
  std::string choice(const std::string& key, const std::vector<std::string>& choices,
                     std::optional<std::string> fallback = {}) const;
  // A number for all three channels, or [r, g, b].
  Rgb color(const std::string& key, const Range&, std::optional<Rgb> fallback = {}) const;
  // [x, y, z], each a coordinate (ranges.h).
  Vec3 vector(const std::string& key, std::optional<Vec3> fallback = {}) const;
  // [x, y, z] of any length but zero, returned with length 1.
  Vec3 direction(const std::string& key, std::optional<Vec3> fallback = {}) const;
  // A list of `length` numbers, or of any number of them.
  std::vector<double> numbers(const std::string& key, const Range&, std::optional<std::size_t> length = {}) const;
  std::vector<long long> integers(const std::string& key, std::size_t length, long long least,
                                  long long greatest) const;
  std::vector<Rgb> colors(const std::string& key, const Range&) const;  // [[r, g, b], ...]

  std::optional<TableReader> table(const std::string& key) const;  // nothing if there is none
  TableReader required_table(const std::string& key) const;
  std::vector<TableReader> tables(const std::string& key) const;  // [[key]]; empty if there is none

  // "<position of key's value>: where: key = <written>, expected <expected>".
  [[noreturn]] void expected(const std::string& key, const std::string& expected) const;
  // "<position of key's value, or of the table if key is empty>: where: <message>".
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;

  const std::string& where() const { return where_; }

 private:
  const toml::node* find(const std::string& key) const;
  const toml::node& require(const std::string& key, const std::string& what) const;
  const toml::array& list(const std::string& key, const std::string& what, std::optional<std::size_t> length) const;
  [[noreturn]] void wrong(const toml::node&, const std::string& name, const std::string& expected) const;
  long long integer_in(const toml::node&, const std::string& name, long long least, long long greatest) const;
  std::string checked_name(const std::string& key, std::optional<std::string> fallback, bool of_file) const;
  double number_in(const toml::node&, const std::string& name, const Range&) const;
  Vec3 vector_in(const std::string& key, const Range&) const;

  const toml::table* table_;
  std::string where_;
  std::vector<std::string> keys_;
};

}  // namespace airlight::scene::load
