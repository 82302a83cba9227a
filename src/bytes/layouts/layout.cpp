// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/layout.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "bytes/layouts/constant_packets.hpp"
#include "bytes/layouts/frames_in_order.hpp"
#include "bytes/layouts/has_role.hpp"
#include "bytes/layouts/packet_decoder.hpp"
#include "bytes/layouts/raw_frames.hpp"
#include "bytes/layouts/text_decoder.hpp"

namespace dermis::bytes::layouts {

bool Layout::has_times() const {
  const auto* const text = std::get_if<TextLayout>(&form);
  return text != nullptr ? has_time(text->lines) : has_time(std::get<PacketLayout>(form).packets);
}

bool Layout::has_numbers() const {
  const auto* const text = std::get_if<TextLayout>(&form);
  return text != nullptr ? has_role(text->lines, Role::frame)
                         : has_role(std::get<PacketLayout>(form).packets, Role::frame);
}

std::string_view Layout::request_after(bool is_sending) const noexcept {
  if (!request.empty()) return request;
  return is_sending ? std::string_view{} : std::string_view(start);
}

Result<std::size_t> Layout::find_array(const std::string& name) const {
  if (name.empty() && arrays.size() == 1) return std::size_t{0};
  const auto found =
      std::find_if(arrays.begin(), arrays.end(), [&](const LayoutArray& array) { return array.name == name; });
  if (!name.empty() && found != arrays.end()) return static_cast<std::size_t>(found - arrays.begin());
  std::string names;
  for (const LayoutArray& array : arrays) names += (names.empty() ? "" : ", ") + array.name;
  if (name.empty()) return bad_input("the layout has several arrays; name one: " + names);
  return bad_input("the layout has no array '" + name + "'" + (names.empty() ? "" : "; it has " + names));
}

std::string hexadecimal(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    std::array<char, 4> digits{};
    std::snprintf(digits.data(), digits.size(), "%02X", unsigned{byte});
    text += (text.empty() ? "" : " ") + std::string(digits.data());
  }
  return text;
}

std::unique_ptr<Decoder> make_decoder(const std::vector<std::shared_ptr<const Layout>>& layouts) {
  if (!has_constant_sizes(*layouts.front())) return make_decoder(layouts.front(), 0, false);
  return std::make_unique<ConstantPackets>(layouts, 0, ConstantPackets::FirstMark::may_be_readings);
}

std::unique_ptr<Decoder> make_decoder(std::shared_ptr<const Layout> layout, std::size_t array, bool is_whole_file) {
  const bool has_times = layout->has_times();
  const bool is_ordered = has_times || layout->has_numbers();
  std::unique_ptr<Decoder> decoder;
  if (std::holds_alternative<TextLayout>(layout->form)) {
    decoder = std::make_unique<TextDecoder>(std::move(layout), array, is_whole_file);
  } else if (has_constant_sizes(*layout)) {
    decoder = std::make_unique<ConstantPackets>(std::vector{std::move(layout)}, array,
                                                ConstantPackets::FirstMark::begins_frame);
  } else if (is_one_frame(*layout)) {
    decoder = std::make_unique<RawFrames>(std::move(layout), array);
  } else {
    decoder = std::make_unique<PacketDecoder>(std::move(layout), array);
  }
  if (!is_ordered) return decoder;
  const bool waits = is_whole_file && has_times;
  return std::make_unique<FramesInOrder>(std::move(decoder),
                                         waits ? FramesInOrder::Late::wait_for : FramesInOrder::Late::drop);
}

}  // namespace dermis::bytes::layouts
