// The one error hierarchy of the project. Every failure that a user can meet is one of these, and prints as one line:
// what, where, the value and the limit, and what to try.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <exception>
#include <optional>
#include <string>
#include <string_view>

namespace scan2fea {

// The parts of an error message. All but `what` may be empty.
struct ErrorParts {
  std::string what;             // "vertex index out of range"
  std::string where;            // "part.obj:12", "face 17"
  std::string value;            // what was found
  std::string limit;            // what was allowed
  std::string advice;           // what to try
  std::optional<Vec3> at = {};  // shown after `where`: "(1.5, 0, 2)"
};

// Base of all errors. `what()` is the one-line message; `exit_code()` is the command's exit status.
class Error : public std::exception {
 public:
  explicit Error(ErrorParts parts);
  const char* what() const noexcept override { return line_.c_str(); }
  const ErrorParts& parts() const { return parts_; }
  virtual int exit_code() const = 0;

  // For those whom it passes, who know more than where it was thrown.
  void amend(ErrorParts parts);

 private:
  ErrorParts parts_;
  std::string line_;
};

// Options contradict one another or the input (exit 2).
struct WrongUsage : Error {
  using Error::Error;
  int exit_code() const override { return 2; }
};

// The input cannot be read, or what it holds is not a mesh (exit 3).
struct InvalidInput : Error {
  using Error::Error;
  int exit_code() const override { return 3; }
};

// No valid mesh can be made of the input (exit 4).
struct NotMeshable : Error {
  using Error::Error;
  int exit_code() const override { return 4; }
};

// The time that was given is over, and there is no valid mesh yet.
struct OutOfTime : NotMeshable {
  explicit OutOfTime(std::string_view stage);
};

// The tetrahedral mesher failed, crashed, or met its time or memory limit (exit 5).
struct MeshingFailed : Error {
  using Error::Error;
  int exit_code() const override { return 5; }
};

// The output cannot be written (exit 6).
struct IoError : Error {
  using Error::Error;
  int exit_code() const override { return 6; }
};

// The progress callback asked to stop (exit 130, as a shell reports an interrupt).
struct Cancelled : Error {
  Cancelled();
  int exit_code() const override { return 130; }
};

}  // namespace scan2fea
