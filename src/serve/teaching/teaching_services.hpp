// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/core/result.hpp"
#include "dermis/recognition/classes.hpp"
#include "serve/requests/json_request.hpp"
#include "serve/teaching/lesson.hpp"

namespace dermis::serve {

/// The services /recognition/... of docs/stream.md: the lesson of the arrays for clients. Thread-safe.
class TeachingServices {
 public:
  /// Takes new classes into use for an array that is at work.
  using UseClasses = std::function<Status(std::size_t array, recognition::Classes)>;

  TeachingServices(ServiceArrays arrays, UseClasses use_classes);

  /// "/recognition/listen", ...
  [[nodiscard]] static const std::vector<std::string>& names();

  /// Every frame of every array; costs next to nothing while nobody teaches.
  void feed(const live::ArrayResult& result) { lesson_.feed(result); }

  /// JSON in, JSON out. Errors: an unknown service, a request that is wrong or comes at the wrong time.
  [[nodiscard]] Result<std::string> call(std::string_view service, std::string_view request);

 private:
  [[nodiscard]] Result<std::string> listen(std::size_t array, const JsonRequest& request);
  [[nodiscard]] Result<std::string> examples(std::size_t array, const JsonRequest& request) const;
  [[nodiscard]] Result<std::string> throw_away(std::size_t array, const JsonRequest& request);
  [[nodiscard]] Result<std::string> load(std::size_t array, const JsonRequest& request);
  [[nodiscard]] Result<std::string> train(std::size_t array);

  const UseClasses use_classes_;
  std::mutex calls_mutex_;  ///< One call at a time.
  Lesson lesson_;
};

}  // namespace dermis::serve
