// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Protocols that layouts describe (docs/layouts.md).
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "bytes/devices/protocols.hpp"
#include "bytes/devices/wire_values.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::devices {
namespace {

using layouts::Layout;
using layouts::PacketField;
using layouts::Role;

struct DescribedProtocol {
  std::string_view name;
  std::vector<FrameShape> shapes;  ///< The arrays that are built. Their sizes differ, so that packets tell them.
  std::vector<std::string_view>
      keys;  ///< Keys of [layout], but for rows and cols: one text for each form of its packets.
};

const std::vector<DescribedProtocol>& described_protocols() {
  static const std::vector<DescribedProtocol> kProtocols = {
      // PyFlexiTac, flexitac/protocol.py. AA 55 among the readings is not escaped.
      {"flexitac", {{16, 32}, {12, 32}, {16, 16}, {32, 32}}, {R"(packet = ["AA 55", "values u8"])"}},
      // A mat of mail-order shops. Publications on it leave open whether its packet of 516 bytes counts the header; the
      // last bytes have no known meaning.
      {"m1616",
       {{16, 16}},
       {R"(packet = ["AA AB AC", "values u16be", "skip 4"])", R"(packet = ["AA AB AC", "values u16be", "skip 1"])"}},
      // willowec/pressure-mat, GUI/modules/communicator.py, mat_handler.py; board_code/src/board_v2/main.c.
      {"pressure-mat", {{56, 28}}, {R"(packet = ["values u8", "FF FE FE FF"]
start = "start_reading\n")"}},
  };
  return kProtocols;
}

using Layouts = std::vector<std::shared_ptr<const Layout>>;

/// Those of an array of this shape, or of all that are built.
Layouts layouts_of(const std::string& name, const std::optional<FrameShape>& given) {
  const auto is_it = [&](const DescribedProtocol& protocol) { return protocol.name == name; };
  const DescribedProtocol& protocol = *std::ranges::find_if(described_protocols(), is_it);
  Layouts layouts;
  for (const FrameShape& shape : given ? std::vector{*given} : protocol.shapes) {
    for (const std::string_view keys : protocol.keys) {
      const std::string text = "[layout]\nrows = " + std::to_string(shape.rows) +
                               "\ncols = " + std::to_string(shape.cols) + "\n" + std::string(keys);
      layouts.push_back(std::make_shared<const Layout>(layouts::layout_from_toml(text, name).value()));
    }
  }
  return layouts;
}

/// Sends packets of marks, readings without a sign, and zeros.
class PacketEncoder final : public Encoder {
 public:
  explicit PacketEncoder(std::shared_ptr<const Layout> layout) : layout_(std::move(layout)) {}

  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    for (const PacketField& field : std::get<layouts::PacketLayout>(layout_->form).packet) {
      if (field.role == Role::literal) bytes.insert(bytes.end(), field.literal.begin(), field.literal.end());
      if (field.role == Role::skip) bytes.insert(bytes.end(), field.count, 0);
      if (field.role == Role::values) append(frame.counts, field.type.bits, bytes);
    }
    is_sending_ = true;
  }

  [[nodiscard]] std::string_view request() const noexcept override { return layout_->request_after(is_sending_); }

 private:
  static void append(const std::vector<float>& counts, unsigned bits, std::vector<std::uint8_t>& bytes) {
    for (const float count : counts) {
      const std::int64_t value = to_wire(count, 0, (std::int64_t{1} << bits) - 1);
      if (bits == 8) bytes.push_back(static_cast<std::uint8_t>(value));
      if (bits == 16) append_big_16(static_cast<std::uint16_t>(value), bytes);
    }
  }

  std::shared_ptr<const Layout> layout_;
  bool is_sending_ = false;
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_described_decoder(const ProtocolOptions& options) {
  return layouts::make_decoder(layouts_of(options.name, options.shape));
}

Result<std::unique_ptr<Encoder>> make_described_encoder(const ProtocolOptions& options) {
  return std::unique_ptr<Encoder>(std::make_unique<PacketEncoder>(layouts_of(options.name, options.shape).front()));
}

}  // namespace dermis::bytes::devices
