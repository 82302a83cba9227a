// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"

namespace dermis::touch::compensation {

/// Two inversions of one circuit: the frames that the quick one does not solve are left to the thorough one.
class BackedInversion final : public CrosstalkInversion {
 public:
  BackedInversion(std::unique_ptr<CrosstalkInversion> quick, std::unique_ptr<CrosstalkInversion> thorough,
                  std::size_t taxels)
      : quick_(std::move(quick)), thorough_(std::move(thorough)), solver_(quick_.get()), kept_(taxels) {}

  [[nodiscard]] InversionResult invert(std::span<const double> ratio, std::span<double> siemens) noexcept override {
    std::copy(siemens.begin(), siemens.end(), kept_.begin());
    solver_ = quick_.get();
    const InversionResult result = quick_->invert(ratio, siemens);
    if (result.solved) return result;
    solver_ = thorough_.get();
    std::copy(kept_.begin(), kept_.end(), siemens.begin());
    return thorough_->invert(ratio, siemens);
  }
  bool start_frame(Nanos time) noexcept override {
    const bool is_quick = quick_->start_frame(time);
    return thorough_->start_frame(time) && is_quick;
  }
  void start_attempt(double share) noexcept override {
    quick_->start_attempt(share);
    thorough_->start_attempt(share);
  }
  void hold_film(const FilmConductances& film) noexcept override {
    quick_->hold_film(film);
    thorough_->hold_film(film);
  }
  void forget() noexcept override {
    quick_->forget();
    thorough_->forget();
  }
  void propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept override {
    solver_->propagate_noise(sigma_ratio, sigma_siemens);
  }
  [[nodiscard]] double siemens_per_ratio() const noexcept override { return quick_->siemens_per_ratio(); }

 private:
  std::unique_ptr<CrosstalkInversion> quick_;
  std::unique_ptr<CrosstalkInversion> thorough_;
  CrosstalkInversion* solver_;  // of the last frame
  std::vector<double> kept_;    // conductances of taxels without a reading, before the frame
};

}  // namespace dermis::touch::compensation
