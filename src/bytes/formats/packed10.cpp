// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <utility>
#include <vector>

#include "bytes/formats/imported_frame.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::size_t kReadingBits = 10;
constexpr std::size_t kByteBits = 8;

/// The highest bit first. `bytes` hold all of `counts`.
void unpack(const std::vector<char>& bytes, std::vector<float>& counts) {
  unsigned bits = 0;
  std::size_t bit_count = 0;
  auto next = bytes.begin();
  for (float& count : counts) {
    for (; bit_count < kReadingBits; bit_count += kByteBits)
      bits = bits << kByteBits | static_cast<unsigned char>(*next++);
    bit_count -= kReadingBits;
    count = static_cast<float>(bits >> bit_count & ((1U << kReadingBits) - 1U));
  }
}

class Packed10 final : public FrameSource {
 public:
  Packed10(std::unique_ptr<std::istream> in, std::string name, const ImportOptions& options)
      : in_(std::move(in)),
        name_(std::move(name)),
        options_(options),
        bytes_((options.shape->taxel_count() * kReadingBits + kByteBits - 1) / kByteBits) {}

  Result<bool> next(RawFrame& frame) override {
    in_->read(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
    if (in_->bad()) return files::read_failure(name_);
    if (in_->gcount() == 0) return false;
    if (static_cast<std::size_t>(in_->gcount()) < bytes_.size()) {
      tell_cut(options_, name_, frames_);
      return false;
    }
    const Result<Nanos> time = time_of_frame(name_, frames_, *options_.rate_hz);
    if (!time) return time.error();
    begin_frame(frame, *time);
    frame.counts.resize(options_.shape->taxel_count());
    unpack(bytes_, frame.counts);
    ++frames_;
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return options_.shape; }

 private:
  std::unique_ptr<std::istream> in_;
  std::string name_;
  ImportOptions options_;
  std::vector<char> bytes_;
  std::size_t frames_ = 0;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> open_packed10(std::unique_ptr<std::istream> in, const std::string& name,
                                                   const ImportOptions& options) {
  if (!options.shape) return bad_input(name + ": packed readings do not tell their shape: say how many rows and cols");
  if (const Status valid = check_shape(name, *options.shape, std::nullopt); !valid) return valid.error();
  return std::unique_ptr<FrameSource>(std::make_unique<Packed10>(std::move(in), name, options));
}

}  // namespace dermis::bytes::formats
