// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "dermis/learn/recognition/examples.hpp"
#include "dermis/learn/recognition/learning.hpp"
#include "dermis/live/suits/live_suit.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/suit/service_arrays.hpp"
#include "out/serve/teaching/touch_collector.hpp"

namespace dermis::out::serve {

/// An example as a person is shown it.
struct ShownExample {
  std::uint32_t id = 0;
  std::string class_name;
  std::string session;
  std::vector<std::uint8_t> picture{};  ///< The mean of each taxel, the brightest as 255; empty where it is known.
};

/// How far the lesson of an array is.
struct LessonState {
  std::string listening{};  ///< The class whose touches are collected; empty: none is.
  bool is_touched = false;
  std::vector<ShownExample> examples{};
};

struct LearnedLesson {
  std::string name;  ///< Name of the files beside the model of the array, without their endings.
  learn::recognition::Learned learned;
};

/// A person names touches while they happen, and classes are learned from them. One array listens at a time; each has
/// its examples. Thread-safe; learn() for one thread at a time.
class Lesson {
 public:
  explicit Lesson(ServiceArrays arrays);

  [[nodiscard]] const ServiceArrays& arrays() const noexcept { return arrays_; }

  /// Every frame of every array; costs next to nothing while nobody teaches.
  void feed(const live::suits::ArrayResult& result);

  /// From now on each touch of the array is an example of the class; an empty class ends it.
  void listen(std::size_t array, std::string class_name, std::string session);
  /// Examples above the id `known` have their picture.
  [[nodiscard]] LessonState state(std::size_t array, std::uint64_t known) const;
  [[nodiscard]] Status discard(std::size_t array, std::uint64_t id);

  /// Names of files beside the model that learn() saved another day, whose touches are not among the examples.
  [[nodiscard]] std::vector<std::string> saved_files(std::size_t array) const;
  /// Adds the touches of such a file to the examples and says how many. No name leads out of the folder of the model.
  [[nodiscard]] Result<std::size_t> load(std::size_t array, const std::string& name);

  /// Learns classes of the examples, and saves both beside the model.
  [[nodiscard]] Result<LearnedLesson> learn(std::size_t array);

 private:
  struct Example {
    std::uint32_t id = 0;
    std::string class_name;
    std::string session;
    CollectedTouch touch;
  };
  struct Taught {
    TouchCollector collector;
    std::vector<Example> examples{};
    std::vector<std::string> files{};  ///< Whose examples are among these.
  };
  static constexpr std::size_t kNone = ~std::size_t{0};

  [[nodiscard]] learn::recognition::LabelledFrames data_of(std::size_t array) const;

  const ServiceArrays arrays_;
  std::atomic<std::size_t> listening_{kNone};
  mutable std::mutex mutex_;    ///< Of what follows.
  std::vector<Taught> taught_;  ///< Of each array.
  std::string class_name_;
  std::string session_;
  std::uint32_t last_id_ = 0;
};

}  // namespace dermis::out::serve
