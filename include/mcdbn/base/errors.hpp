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
  using Error::Error;
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
