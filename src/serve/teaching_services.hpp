// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/recognition/classes.hpp"
#include "dermis/recognition/examples.hpp"
#include "serve/touch_collector.hpp"

namespace dermis::serve {

/// An array whose touches can be taught.
struct TaughtArray {
  std::string name;
  ArrayDescription description;
  std::string model;  ///< Path of its model: what is taught goes into that folder.
};

/// The services /recognition/... of docs/stream.md: a person names touches, and classes are learned of them.
/// Thread-safe.
class TeachingServices {
 public:
  /// Takes new classes into use for an array that is at work.
  using UseClasses = std::function<Status(std::size_t array, recognition::Classes)>;

  TeachingServices(std::vector<TaughtArray> arrays, UseClasses use_classes);

  [[nodiscard]] static const std::vector<std::string>& names();

  /// Every frame of every array; costs next to nothing while nobody teaches.
  void feed(const live::ArrayResult& result);

  /// JSON in, JSON out. Errors: an unknown service, a request that is wrong or comes at the wrong time.
  [[nodiscard]] Result<std::string> call(std::string_view service, std::string_view request);

 private:
  struct Example {
    std::uint32_t id = 0;
    std::string name;
    std::string session;
    CollectedTouch touch;
  };
  struct Lesson {
    TaughtArray array;
    TouchCollector collector;
    std::vector<Example> examples{};
    std::vector<std::string> files{};  ///< Whose examples are among these.
  };
  static constexpr std::size_t kNone = ~std::size_t{0};

  [[nodiscard]] Result<std::size_t> find_array(const nlohmann::json& request) const;
  [[nodiscard]] Result<std::string> listen(const nlohmann::json& request);
  [[nodiscard]] Result<std::string> examples(const nlohmann::json& request) const;
  [[nodiscard]] Result<std::string> throw_away(const nlohmann::json& request);
  [[nodiscard]] Result<std::string> saved(const nlohmann::json& request) const;
  [[nodiscard]] Result<std::string> load(const nlohmann::json& request);
  [[nodiscard]] Result<std::string> train(const nlohmann::json& request);
  [[nodiscard]] recognition::LabelledFrames data_of(std::size_t array) const;

  UseClasses use_classes_;
  std::atomic<std::size_t> listening_{kNone};
  mutable std::mutex mutex_;    ///< Of what follows.
  std::deque<Lesson> lessons_;  ///< Of each array.
  std::string class_name_;
  std::string session_;
  std::uint32_t last_id_ = 0;
};

}  // namespace dermis::serve
