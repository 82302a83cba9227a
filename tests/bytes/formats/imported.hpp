// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <cerrno>
#include <ios>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/formats/import_options.hpp"
#include "support/mutations.hpp"
#include "support/random_frames.hpp"

namespace dermis::bytes::formats {

/// Bytes of a file that cannot be read to its end, or that is a pipe.
class BadFile final : public std::stringbuf {
 public:
  enum class Fault { read, seek };
  BadFile(const std::string& bytes, Fault fault) : std::stringbuf(bytes, std::ios::in), fault_(fault) {}

 private:
  int_type underflow() override {
    const int_type next = std::stringbuf::underflow();
    if (fault_ == Fault::read && next == traits_type::eof()) {
      errno = EIO;
      throw std::ios_base::failure("as std::filebuf does");
    }
    return next;
  }
  std::streamsize xsgetn(char* into, std::streamsize size) override {
    const std::streamsize read = std::stringbuf::xsgetn(into, size);
    if (read < size) underflow();
    return read;
  }
  pos_type seekoff(off_type by, std::ios::seekdir from, std::ios::openmode mode) override {
    return fault_ == Fault::seek ? pos_type(off_type(-1)) : std::stringbuf::seekoff(by, from, mode);
  }
  pos_type seekpos(pos_type to, std::ios::openmode mode) override {
    return fault_ == Fault::seek ? pos_type(off_type(-1)) : std::stringbuf::seekpos(to, mode);
  }

  Fault fault_;
};

/// One of the importers on bytes in memory.
class Importer {
 public:
  using Open = Result<std::unique_ptr<FrameSource>> (*)(std::unique_ptr<std::istream>, const std::string&,
                                                        const ImportOptions&);
  explicit Importer(Open open, ImportOptions options = {}) : open_(open), options_(std::move(options)) {
    options_.notice = [this](const std::string& line) { notices_.push_back(line); };
    options_.loss = [this](const std::string& line) { losses_.push_back(line); };
  }
  Importer(const Importer&) = delete;
  Importer& operator=(const Importer&) = delete;

  Result<std::vector<RawFrame>> read(const std::string& bytes, const std::string& name = "f") {
    notices_.clear();
    losses_.clear();
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

  /// On a file with this fault.
  Error fault(const std::string& bytes, BadFile::Fault fault) {
    BadFile file(bytes, fault);
    const auto source = open_(std::make_unique<std::istream>(&file), "f", options_);
    if (!source) return source.error();
    const auto frames = support::read_all(**source);
    if (!frames) return frames.error();
    return failed("no error");
  }

  void expect_value_or_one_line_error(const std::string& bytes, std::uint64_t mutations) {
    support::expect_value_or_one_line_error(bytes, mutations,
                                            [this](const std::string& text) { return read(text, "mutated"); });
  }

  [[nodiscard]] std::optional<FrameShape> shape() const { return shape_; }
  [[nodiscard]] const std::vector<std::string>& notices() const { return notices_; }
  [[nodiscard]] const std::vector<std::string>& losses() const { return losses_; }

 private:
  Open open_;
  ImportOptions options_;
  std::optional<FrameShape> shape_;
  std::vector<std::string> notices_;
  std::vector<std::string> losses_;
};

using Frames = std::vector<std::vector<float>>;

}  // namespace dermis::bytes::formats
