// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/out/websocket/server.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// The call of a service by a client: a JSON object of at most 4 KiB by default.
class JsonRequest {
 public:
  static constexpr std::size_t kMostBytes = 4096;
  static constexpr std::size_t kMostNameBytes = 60;

  [[nodiscard]] static Result<JsonRequest> parse(std::string_view text, std::size_t most_bytes = kMostBytes);

  /// A text without control characters, commas and quotes; empty where there is no such field.
  [[nodiscard]] Result<std::string> text(const char* field, std::size_t most_bytes = kMostNameBytes) const;
  /// A name for a file: letters, digits, '_' and '-', at least one.
  [[nodiscard]] Result<std::string> file_name(const char* field) const;
  /// A whole number from 0 on; empty where there is no such field. `wanted`: what the field must be, for the error.
  [[nodiscard]] Result<std::optional<std::uint64_t>> number(const char* field, const char* wanted) const;
  /// True or false; false where there is no such field.
  [[nodiscard]] Result<bool> flag(const char* field) const;
  /// A list of texts of any content.
  [[nodiscard]] Result<std::vector<std::string>> texts(const char* field) const;
  /// A list of finite numbers.
  [[nodiscard]] Result<std::vector<double>> numbers(const char* field) const;
  /// A list of `count` numbers; null is NaN.
  [[nodiscard]] Result<std::vector<double>> numbers_or_null(const char* field, std::size_t count) const;

 private:
  explicit JsonRequest(nlohmann::json object);

  nlohmann::json object_;
};

/// On one line. Bytes that are not UTF-8 are replaced.
template <typename Json>
[[nodiscard]] std::string json_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// A service that a member answers. `owner` must outlive it.
template <typename Owner>
[[nodiscard]] websocket::Service service(const char* name, Owner& owner,
                                         Result<std::string> (Owner::*answer)(const JsonRequest&),
                                         std::size_t most_bytes = JsonRequest::kMostBytes) {
  return {name, [&owner, answer, most_bytes](std::string_view text) -> Result<std::string> {
            const Result<JsonRequest> request = JsonRequest::parse(text, most_bytes);
            if (!request) return request.error();
            return (owner.*answer)(*request);
          }};
}

}  // namespace dermis::out::serve
