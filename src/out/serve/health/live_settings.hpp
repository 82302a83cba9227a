// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/live/suits/live_suit.hpp"
#include "out/serve/parts/part.hpp"

namespace dermis::out::serve {

/// How contacts are found and zeros are followed, as clients set it.
class LiveSettingsPart final : public Part {
 public:
  /// `live` must outlive it.
  explicit LiveSettingsPart(live::suits::LiveSuit& live) : live_(live) {}

  [[nodiscard]] std::vector<LiveParameter> parameters() override;

 private:
  [[nodiscard]] LiveParameter contact_option(const std::string& name, double touch::contacts::ContactOptions::*option);
  [[nodiscard]] Status change(const std::function<void(live::suits::LiveSettings&)>& change);

  live::suits::LiveSuit& live_;
};

}  // namespace dermis::out::serve
