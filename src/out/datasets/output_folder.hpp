// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "dermis/bytes/files/unfinished_file.hpp"
#include "dermis/out/datasets/episode_sink.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::datasets {

/// A folder that appears complete or not at all: it grows beside its place under another name. Without commit(), all is
/// removed. Not thread-safe.
class OutputFolder {
 public:
  /// Fails where the folder exists and is not empty, or another process writes it.
  [[nodiscard]] static Result<std::unique_ptr<OutputFolder>> create(const std::string& folder);

  /// Where the file of this relative name is until then; its folder is made.
  [[nodiscard]] std::string place(const std::string& name) const;
  [[nodiscard]] Status write(const std::string& name, std::string_view bytes) const;
  [[nodiscard]] Status commit();
  /// The same with summary.html, and tactile.json in the folder `notes` ("meta/", or "").
  [[nodiscard]] Status commit(const EpisodeTally& tally, const std::string& notes);

 private:
  OutputFolder(std::string target, bytes::files::UnfinishedFile unfinished)
      : target_(std::move(target)), unfinished_(std::move(unfinished)) {}

  std::string target_;
  bytes::files::UnfinishedFile unfinished_;
};

}  // namespace dermis::out::datasets
