// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/learn/recognition/classes.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/parts/part.hpp"
#include "out/serve/requests/json_request.hpp"
#include "out/serve/teaching/lesson.hpp"

namespace dermis::out::serve {

/// The services /recognition/... of docs/stream.md: the lesson of the arrays for clients. Services are
/// called by one thread, as websocket::Server promises; the rest by any.
class TeachingServices final : public Part {
 public:
  /// Takes new classes into use for an array that is at work.
  using UseClasses = std::function<Status(std::size_t array, learn::recognition::Classes)>;

  TeachingServices(ServiceArrays arrays, UseClasses use_classes);

  /// "/recognition/listen", ... Errors: a request that is wrong or comes at the wrong time.
  [[nodiscard]] std::vector<websocket::Service> services() override;
  /// Costs next to nothing while nobody teaches.
  void hear(const live::suits::ArrayResult& result) override { lesson_.feed(result); }

 private:
  using Answer = Result<std::string> (TeachingServices::*)(std::size_t array, const JsonRequest& request);

  [[nodiscard]] websocket::Service of_array(const char* name, Answer answer);
  [[nodiscard]] Result<std::string> listen(std::size_t array, const JsonRequest& request);
  [[nodiscard]] Result<std::string> examples(std::size_t array, const JsonRequest& request);
  [[nodiscard]] Result<std::string> throw_away(std::size_t array, const JsonRequest& request);
  [[nodiscard]] Result<std::string> saved(std::size_t array, const JsonRequest& request);
  [[nodiscard]] Result<std::string> load(std::size_t array, const JsonRequest& request);
  [[nodiscard]] Result<std::string> train(std::size_t array, const JsonRequest& request);

  const UseClasses use_classes_;
  Lesson lesson_;
};

}  // namespace dermis::out::serve
