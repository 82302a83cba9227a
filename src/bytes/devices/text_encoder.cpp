// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/text_encoder.hpp"

#include <string>

#include "bytes/devices/wire_values.hpp"

namespace dermis::bytes::devices {
namespace {

class TextEncoder final : public Encoder {
 public:
  TextEncoder(const TextForm& form, FrameShape shape) : form_(form), shape_(shape) {}

  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    std::string text(form_.frame_begin);
    for (std::size_t row = 0; row < shape_.rows; ++row) {
      text.append(row > 0 ? form_.between_rows : "").append(form_.row_begin);
      for (std::size_t col = 0; col < shape_.cols; ++col) {
        const float count = frame.counts[row * shape_.cols + col];
        text.append(col > 0 ? form_.between : "").append(std::to_string(to_wire(count, 0, form_.most)));
      }
      text.append(form_.row_end);
    }
    text.append(form_.frame_end);
    bytes.insert(bytes.end(), text.begin(), text.end());
  }

 private:
  TextForm form_;
  FrameShape shape_;
};

}  // namespace

std::unique_ptr<Encoder> make_text_encoder(const TextForm& form, const ProtocolOptions& options) {
  return std::make_unique<TextEncoder>(form, *options.shape);
}

}  // namespace dermis::bytes::devices
