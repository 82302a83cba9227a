// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace dermis::browser {

/// The end of a guided calibration for the page, whose second worker has a copy of the module and does the fit there.
class FitLink {
 public:
  FitLink() = default;
  virtual ~FitLink() = default;
  FitLink(const FitLink&) = delete;
  FitLink& operator=(const FitLink&) = delete;

  /// In the copy: does the fit that was begun last. Its outcome, as bytes.
  [[nodiscard]] virtual std::string run() = 0;
  /// Takes the outcome that run() gave in the copy.
  virtual void accept(std::string_view outcome) = 0;
  virtual void accept_share(double share) = 0;
  /// The copy has ended without an outcome.
  virtual void fail(std::string_view why) = 0;
};

/// That of the calibration that goes on; null: there is none.
[[nodiscard]] FitLink* fit_link() noexcept;

}  // namespace dermis::browser
