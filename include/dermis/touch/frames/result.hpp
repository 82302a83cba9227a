// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace dermis {

/// Who has to act on an error: the command line exits with 2 for `bad_input` and 1 for `failed`.
enum class ErrorKind {
  bad_input,  ///< A file, an option or a device holds something that cannot be used.
  failed,     ///< The work itself could not be done (disk full, solver gave up).
};

/// One clear line that names the place and the remedy.
struct Error {
  ErrorKind kind = ErrorKind::failed;
  std::string message;
  std::string
      field{};  ///< The message begins with the field that is wrong, and ": "; empty: it is about something else.
};

/// An error whose message stays on one line: control characters of file names or files become '?'.
[[nodiscard]] Error bad_input(std::string message);
/// bad_input() about a field of options, as "rate: must be 0.001 to 1e6". Callers know the field by a name of their
/// own.
[[nodiscard]] Error bad_field(const std::string& field, const std::string& message);
[[nodiscard]] Error failed(std::string message);

/// A value or an Error. Reading the wrong one is a programmer error (assert).
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT(google-explicit-constructor): reads as a return value
  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool has_value() const noexcept { return std::holds_alternative<T>(state_); }
  explicit operator bool() const noexcept { return has_value(); }

  [[nodiscard]] T& value() & {
    assert(has_value());
    return *std::get_if<T>(&state_);
  }
  [[nodiscard]] const T& value() const& {
    assert(has_value());
    return *std::get_if<T>(&state_);
  }
  [[nodiscard]] T&& value() && {
    assert(has_value());
    return std::move(*std::get_if<T>(&state_));
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  [[nodiscard]] const Error& error() const {
    assert(!has_value());
    return *std::get_if<Error>(&state_);
  }

 private:
  std::variant<T, Error> state_;
};

/// Success without a value.
struct Done {};
using Status = Result<Done>;

}  // namespace dermis
