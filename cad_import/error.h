// The root of every exception that Catoptra throws.
#pragma once

#include <stdexcept>
#include <string>

namespace catoptra {

/// Bad input or a failed operation, told as one line: "FILE: ENTITY: REASON (HINT)". Empty parts are left out.
/// Third-party exceptions are turned into this (or a type below it) in the folder that owns the library.
class Error : public std::runtime_error {
 public:
  /// `file`: the file at fault, as the user named it. `entity`: what in it (a key, a face, "line 12").
  /// `reason`: what is wrong. `hint`: what the user can do about it.
  Error(std::string file, std::string entity, std::string reason, std::string hint = {});

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::string& entity() const { return entity_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] const std::string& hint() const { return hint_; }

 private:
  std::string file_, entity_, reason_, hint_;
};

/// The user (or a caller's flag) asked to stop.
class Cancelled : public Error {
 public:
  using Error::Error;
};

}  // namespace catoptra

namespace catoptra::cad_import {

/// A CAD or mesh file that cannot be read, or does not hold what was asked for.
class ImportError : public Error {
 public:
  using Error::Error;
};

}  // namespace catoptra::cad_import
