#pragma once

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>

#include "base/safetensors.hpp"
#include "mcdbn/device/parameters.hpp"

namespace mcdbn {

/// Everything that training changes, by name: saved to a checkpoint or restored from it. A class
/// with such state names all of it in one function, visit_state(TrainingState&), which serves both
/// ways. What follows from it, or is made anew in each mini-batch, is no part of it.
class TrainingState {
 public:
  /// The numbers and matrices of one stage, as a checkpoint keeps them.
  struct Content {
    nlohmann::json numbers = nlohmann::json::object();
    std::map<std::string, Safetensors::Tensor> matrices;
    std::string file = {};  ///< that they were read from
  };

  /// Fills `content`. Reading matrices waits for the queue.
  static TrainingState saving(Content& content) { return {content, false}; }
  /// Gives what is in `content` to those who visit.
  static TrainingState restoring(Content& content) { return {content, true}; }

  /// Whether what is visited is being brought back: what follows from it has to be made anew.
  bool restores() const { return restores_; }

  /// This state with `prefix` before every name, for parts of which there are several.
  TrainingState under(const std::string& prefix) const {
    TrainingState state(content_, restores_);
    state.prefix_ = prefix_ + prefix;
    return state;
  }

  /// Finite numbers, whole ones from 0 on, and booleans.
  /// @throws InputError if there is none of that name and kind
  template <typename Number>
  void number(const std::string& name, Number& value) {
    if (restores_)
      value = at(name, holds<Number>).template get<Number>();
    else
      content_.numbers[prefix_ + name] = value;
  }
  /// A matrix, of the shape that it had when it was saved. @throws InputError if there is none
  void matrix(const std::string& name, Matrix& value);
  /// A matrix that is made when it is first needed: restored as empty if it was saved so.
  /// @param make a matrix of its shape
  template <typename Make>
  void matrix_if_any(const std::string& name, Matrix& value, const Make& make) {
    bool any = !value.empty();
    number(name + "?", any);
    if (any && value.empty()) value = make();
    if (any) matrix(name, value);
  }
  /// All parameters, as one matrix.
  void parameters(const std::string& name, const Parameters& value) {
    Matrix all = value.all();  // shares the buffer
    matrix(name, all);
  }

 private:
  TrainingState(Content& content, bool restores) : content_(content), restores_(restores) {}

  /// Whether it can be such a number: what reads another kind as one may do anything.
  template <typename Number>
  static bool holds(const nlohmann::json& value) {
    if constexpr (std::is_same_v<Number, bool>)
      return value.is_boolean();
    else if constexpr (std::is_integral_v<Number>)
      return value.is_number_integer() && value.get<double>() >= 0 &&
             value.get<double>() <= static_cast<double>(std::numeric_limits<Number>::max());
    else
      return value.is_number();
  }
  const nlohmann::json& at(const std::string& name, bool (*holds_it)(const nlohmann::json&)) const;

  Content& content_;
  bool restores_;
  std::string prefix_;
};

}  // namespace mcdbn
