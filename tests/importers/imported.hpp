// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "dermis/importers/import_options.hpp"
#include "support/mutations.hpp"
#include "support/random_frames.hpp"

namespace dermis::importers {

/// One of the importers on bytes in memory.
class Importer {
 public:
  using Open = Result<std::unique_ptr<FrameSource>> (*)(std::unique_ptr<std::istream>, const std::string&,
                                                        const ImportOptions&);
  explicit Importer(Open open, ImportOptions options = {}) : open_(open), options_(std::move(options)) {
    options_.notice = [this](const std::string& line) { notices_.push_back(line); };
  }
  Importer(const Importer&) = delete;
  Importer& operator=(const Importer&) = delete;

  Result<std::vector<RawFrame>> read(const std::string& bytes, const std::string& name = "f") {
    notices_.clear();
    const auto source = open_(std::make_unique<std::istringstream>(bytes), name, options_);
    if (!source) return source.error();
    shape_ = (*source)->shape();
    return support::read_all(**source);
  }

  /// Counts of all frames; a failure of the test where there is an error.
  std::vector<std::vector<float>> counts(const std::string& bytes) {
    const auto frames = read(bytes);
    if (!frames) ADD_FAILURE() << frames.error().message;
    std::vector<std::vector<float>> all;
    if (frames) {
      for (const RawFrame& frame : *frames) all.push_back(frame.counts);
    }
    return all;
  }

  std::vector<double> seconds(const std::string& bytes) {
    const auto frames = read(bytes);
    std::vector<double> all;
    if (frames) {
      for (const RawFrame& frame : *frames) all.push_back(std::chrono::duration<double>(frame.time).count());
    }
    return all;
  }

  std::string error(const std::string& bytes) {
    const auto frames = read(bytes);
    if (frames) return "no error";
    EXPECT_EQ(frames.error().kind, ErrorKind::bad_input);
    return frames.error().message;
  }

  void expect_value_or_one_line_error(const std::string& bytes, std::uint64_t mutations) {
    support::expect_value_or_one_line_error(bytes, mutations,
                                            [this](const std::string& text) { return read(text, "mutated"); });
  }

  [[nodiscard]] std::optional<FrameShape> shape() const { return shape_; }
  [[nodiscard]] const std::vector<std::string>& notices() const { return notices_; }

 private:
  Open open_;
  ImportOptions options_;
  std::optional<FrameShape> shape_;
  std::vector<std::string> notices_;
};

using Frames = std::vector<std::vector<float>>;

}  // namespace dermis::importers
