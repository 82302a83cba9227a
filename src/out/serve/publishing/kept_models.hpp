// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "dermis/live/fleet/model_manifest.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::out::serve {

/// The models that an array has got from its fleet, in a folder on the robot. Not thread-safe.
class KeptModels {
 public:
  static constexpr std::size_t kMost = 10;

  /// The folder need not be there.
  KeptModels(std::filesystem::path folder, ArrayDescription array);

  /// The manifest whose current model was used last; empty where there is none.
  [[nodiscard]] Result<std::optional<live::fleet::ModelManifest>> manifest() const;

  /// Writes the bytes of a model, whole or not at all.
  [[nodiscard]] Status write(const live::fleet::PushedModel& model, std::string_view bytes) const;
  /// Fails on a file that is not there or not whole, and on a model that does not fit the array.
  [[nodiscard]] Result<std::shared_ptr<const touch::pipeline::Model>> read(const live::fleet::PushedModel& model) const;
  void remove(const live::fleet::PushedModel& model) const;

  /// The current model is the one in use, also after a restart. Those after the ten that were used last are removed.
  [[nodiscard]] Status use(const live::fleet::ModelManifest& manifest) const;

 private:
  [[nodiscard]] std::filesystem::path manifest_path() const;
  [[nodiscard]] std::filesystem::path path_of(const live::fleet::PushedModel& model) const;
  void remove_old() const;

  const std::filesystem::path folder_;
  const ArrayDescription array_;
};

}  // namespace dermis::out::serve
