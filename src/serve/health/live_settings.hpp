// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/live/live_suit.hpp"
#include "serve/parts/part.hpp"

namespace dermis::serve {

/// How contacts are found and zeros are followed, as clients set it.
class LiveSettingsPart final : public Part {
 public:
  /// `live` must outlive it.
  explicit LiveSettingsPart(live::LiveSuit& live) : live_(live) {}

  [[nodiscard]] std::vector<LiveParameter> parameters() override;

 private:
  [[nodiscard]] LiveParameter contact_option(const std::string& name, double contacts::ContactOptions::*option);
  [[nodiscard]] Status change(const std::function<void(live::LiveSettings&)>& change);

  live::LiveSuit& live_;
};

}  // namespace dermis::serve
