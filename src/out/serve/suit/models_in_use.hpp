// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::out::serve {

/// The models of the arrays at work: a calibration replaces them. Thread-safe.
class ModelsInUse {
 public:
  explicit ModelsInUse(const ServedSuit& suit);

  [[nodiscard]] std::shared_ptr<const touch::pipeline::Model> of(std::size_t array) const;
  /// True where it is not the one that the suit began with.
  [[nodiscard]] bool is_new(std::size_t array) const;
  void replace(std::size_t array, std::shared_ptr<const touch::pipeline::Model> model);

 private:
  struct Used {
    std::shared_ptr<const touch::pipeline::Model> model;
    bool is_new = false;
  };

  mutable std::mutex mutex_;
  std::vector<Used> used_;
};

}  // namespace dermis::out::serve
