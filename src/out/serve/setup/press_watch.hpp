// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "dermis/learn/arrangement/press_guide.hpp"
#include "out/serve/requests/json_request.hpp"
#include "out/serve/setup/touch_watch.hpp"

namespace dermis::out::serve {

/// Where a board is to be pressed: {"rows": 6, "cols": 9, "pitch_um": 8000}, or {"places_mm": [x, y, x, y, ...]} in no
/// grid.
[[nodiscard]] Result<learn::arrangement::Places> press_places_request(const JsonRequest& request);

/// A person presses place after place of a board. Thread-safe.
class PressWatch {
 public:
  /// `sent`: shape of the frames.
  PressWatch(const live::sources::SourceName& name, FrameShape sent, learn::arrangement::Places places,
             live::sources::SourceOptions options);

  /// {"ready", "place", "done", "pressed", "repeated", "channels", "problem"}. `place` is to be pressed now. The
  /// channel of `repeated`, or of none (null), answered again.
  [[nodiscard]] nlohmann::ordered_json progress();
  /// Nothing answers at this place; or the last place again.
  void skip();
  void back();

  /// As far as it is known; places that were not pressed did not answer.
  [[nodiscard]] Result<learn::arrangement::Arrangement> arrange(const std::string& name) const;

 private:
  const learn::arrangement::Places places_;
  mutable std::mutex mutex_;
  learn::arrangement::PressGuide guide_;
  TouchWatch watch_;  // the last: its thread uses the others
};

}  // namespace dermis::out::serve
