// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "dermis/learn/recognition/classes.hpp"
#include "dermis/learn/recognition/segment.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::recognition {

enum class Verdict {
  known,            ///< The likeliest class is the answer.
  unlike_examples,  ///< Unknown: further from every class than its examples are.
  between_classes,  ///< Unknown: several classes are about as likely.
};
[[nodiscard]] const char* to_string(Verdict verdict);

struct Answer {
  std::span<const double> probabilities;  ///< [classes], sum 1; valid until the next answer.
  std::size_t likeliest = 0;              ///< The class that it is, if it is one of those learned.
  std::size_t second = 0;                 ///< The second likeliest.
  double unknown_score = 0.0;             ///< Rises with the distance from the examples and with the doubt.
  Verdict verdict = Verdict::known;
};

/// Names the class of segments. Allocates only when made. Not thread-safe: one for each thread.
class Recogniser {
 public:
  /// `source`: of the frames to come; its arrays are those of the examples in their order. Where both pitches are
  /// known, the arrays may have other sizes. Where both rates are known, the rate may differ, at most by a factor of
  /// 1000. Fails where the classes cannot read the frames. The end of segments longer than `most_frames` (at least 1)
  /// counts.
  [[nodiscard]] static Result<Recogniser> create(Classes classes, const Layout& source, std::size_t most_frames);
  Recogniser(Recogniser&&) noexcept;
  Recogniser& operator=(Recogniser&&) noexcept;
  ~Recogniser();

  /// `segment`: at least one frame, laid out as `source`. Readings that are no number count as no load,
  /// further readings as those of the mean example.
  [[nodiscard]] Answer recognise(const Segment& segment);

  [[nodiscard]] const Classes& classes() const noexcept;

 private:
  struct State;
  explicit Recogniser(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace dermis::learn::recognition
