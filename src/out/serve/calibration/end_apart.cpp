// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/calibration/end_apart.hpp"

#include <future>
#include <utility>

namespace dermis::out::serve {

std::shared_ptr<void> end_apart(std::shared_ptr<learn::calibration::GuidedCalibration> calibration) {
  auto end = [ending = std::move(calibration)]() mutable { ending.reset(); };
  return std::make_shared<std::future<void>>(std::async(std::launch::async, std::move(end)));
}

}  // namespace dermis::out::serve
