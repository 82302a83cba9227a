// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <string>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// One event of a DSA recording.
struct DsaEvent {
  enum class Kind { matrix, frame, temperatures, end };
  Kind kind = Kind::end;
  FrameShape shape;     ///< matrix: its cells.
  std::string time_ms;  ///< frame, temperatures: a whole number.
  std::string text;     ///< frame: its code in hexadecimal digits; temperatures: numbers with commas between.
  bool is_cut = false;  ///< end: the file ends before its last element.
};

/// Reads the XML of a DSA recording, compressed by bzip2 or not, event by event. Memory: an event of at most 64 MiB.
/// Document types are refused, so no entity can grow. Tags of more than 1 MiB and names of more than 64 KiB
/// in all are refused, too, and more than 32 nested elements. No recording has them. Not thread-safe.
class DsaEvents {
 public:
  /// `in` must be able to seek.
  DsaEvents(std::unique_ptr<std::istream> in, std::string name);
  DsaEvents(const DsaEvents&) = delete;
  DsaEvents& operator=(const DsaEvents&) = delete;
  ~DsaEvents();

  /// The next event, `end` again and again at the end. Errors name the line of the XML.
  [[nodiscard]] Status next(DsaEvent& event);
  /// To the first event again; of a stream that can seek.
  [[nodiscard]] Status rewind();

  [[nodiscard]] const std::string& name() const noexcept;
  [[nodiscard]] std::string place() const;
  [[nodiscard]] Error error(const std::string& message) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace dermis::bytes::formats
