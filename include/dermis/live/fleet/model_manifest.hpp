// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::fleet {

/// A model file that was pushed to an array of a robot.
struct PushedModel {
  std::uint64_t number = 0;  ///< Pushes to the array are numbered from 1 on.
  std::string name;          ///< Of the file.
  std::string sha256;        ///< The SHA-256 of its bytes: 64 small hexadecimal digits.
  std::uint64_t bytes = 0;
  std::uint64_t pieces = 0;  ///< Messages that hold the bytes.
  Nanos time{};              ///< It was pushed then, by UTC.

  bool operator==(const PushedModel&) const = default;
};

/// The last models that were pushed to an array, and which of them its robot uses.
struct ModelManifest {
  static constexpr std::size_t kMostModels = 10;
  static constexpr std::uint64_t kMostBytes = 256U << 20U;  ///< Of a model.
  static constexpr std::uint64_t kMostPieces = 4096;        ///< The same.

  std::string robot;
  std::string array;
  std::uint64_t current = 0;          ///< Number of the model in use, which is one of `models`.
  std::vector<PushedModel> models{};  ///< By their numbers. At least one, once there was a push.

  bool operator==(const ModelManifest&) const = default;

  [[nodiscard]] const PushedModel& current_model() const;
  /// Uses another model, under the number that follows. The oldest of more than kMostModels is left out.
  void add(PushedModel model);
  /// Uses the model before the current one. Fails where it is the oldest.
  [[nodiscard]] Status roll_back();
};

[[nodiscard]] std::string manifest_to_json(const ModelManifest& manifest);
/// Accepts any text. All that it returns is within the bounds above and consistent.
[[nodiscard]] Result<ModelManifest> manifest_from_json(std::string_view text);

}  // namespace dermis::live::fleet
