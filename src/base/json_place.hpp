#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/base/settings.hpp"

namespace mcdbn {

/// A value in a JSON file, with its path in the file: errors read `file: key's path: what`. It
/// refers to the value and does not own it.
class JsonPlace {
 public:
  JsonPlace(const nlohmann::json& value, std::string file)
      : value_(&value), file_(std::make_shared<const std::string>(std::move(file))) {}

  [[noreturn]] void fail(const std::string& what) const;

  std::string where() const;  ///< "file: key's path"
  const nlohmann::json& value() const { return *value_; }
  bool is_list() const { return value_->is_array(); }
  bool is_object() const { return value_->is_object(); }
  bool has(const char* key) const { return is_object() && value_->contains(key); }
  std::size_t size() const { return value_->size(); }

  /// @throws InputError if this is no object, or has no such key
  JsonPlace operator[](const std::string& key) const;
  /// @throws InputError if this is no list, or shorter
  JsonPlace at(std::size_t index) const;
  /// All values of a list. @throws InputError if this is none
  std::vector<JsonPlace> list() const;
  /// The names of an object's values. @throws InputError if this is none
  std::vector<std::string> keys() const;

  double number() const;  ///< null is NaN
  long long whole_number() const;
  std::string text() const;
  std::vector<double> numbers() const;  ///< of a list; null is NaN

  bool truth() const;
  /// @throws InputError also if it is not in the range; null is in none
  double number(const Range& range) const;
  std::size_t count(const Range& range) const;
  std::vector<double> finite_numbers() const;  ///< of a list, none beyond kLargest
  std::vector<std::string> texts() const;

 private:
  JsonPlace(const nlohmann::json& value, const JsonPlace& from, const std::string& step);

  const nlohmann::json* value_;
  std::shared_ptr<const std::string> file_;
  std::string path_;  ///< its end where it is longer than messages show
};

}  // namespace mcdbn
