// The room base: errors, settings, matrices, random numbers, text and files: what every other room
// needs. It uses no other room.
// Add here: a helper that knows neither devices nor motion: a pair of files in src/base, its header
// public only if another public header needs it.
#pragma once

#include <stdexcept>
#include <string>

namespace mcdbn {

/// Base of everything the library throws on purpose; cli/ maps each kind to an exit code. Texts
/// name settings in backquotes, `gaussian.rate`, which cli/ turns into flags.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file or a track cannot be used. The text reads `file:line: what, and what to do`.
class InputError : public Error {
 public:
  using Error::Error;
};

/// Matrices whose sizes do not fit together: a mistake of the calling code.
class ShapeError : public Error {
 public:
  using Error::Error;
};

/// No OpenCL device, or the device refused work.
class DeviceError : public Error {
 public:
  enum class Kind {
    no_device,  ///< there is none, or it is lost: whatever comes next fails, too
    refused,    ///< it does not do this work, for lack of memory, say; it may do other
  };
  explicit DeviceError(const std::string& what, Kind kind = Kind::no_device)
      : Error(what), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// A setting that is unknown, contradictory or out of range.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// Training stopped by the divergence guard; the text names what to lower.
class DivergenceError : public Error {
 public:
  using Error::Error;
};

/// Thrown by an observer of the work to stop it.
class Interrupted : public Error {
 public:
  using Error::Error;
};

}  // namespace mcdbn
