// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "dermis/bytes/devices/encoder.hpp"
#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/layouts/decoder.hpp"
#include "dermis/touch/frames/result.hpp"

/// One pair of factories a protocol that no layout describes, listed in protocol.cpp; each in the file of its name.
/// Shapes that are given are valid and those of the protocol where it has but one; encoders
/// are given one.
namespace dermis::bytes::devices {

constexpr unsigned kUsualBaud = 115'200;

/// Strictness of a checksum, of text, and of binary forms; that of others is the size of their mark.
constexpr int kHasChecksum = 100;
constexpr int kIsText = 50;
constexpr int kIsBinary = 20;

struct ProtocolEntry {
  std::string_view name{};
  std::optional<FrameShape> only_shape{};  ///< Empty where devices of the protocol differ.
  Result<std::unique_ptr<Decoder>> (*make_decoder)(const ProtocolOptions&) = nullptr;
  Result<std::unique_ptr<Encoder>> (*make_encoder)(const ProtocolOptions&) = nullptr;
  /// Where several decode the same bytes, the strictest is right. Without one, "auto" does not try it as it is.
  std::optional<int> strictness{};
  unsigned baud = kUsualBaud;
};

/// Those that layouts describe: a file of layouts/shipped each.
[[nodiscard]] const std::vector<ProtocolEntry>& described_protocols();
/// All, by name, and "auto" at the end.
[[nodiscard]] const std::vector<ProtocolEntry>& protocol_entries();
[[nodiscard]] const ProtocolEntry* find_protocol(std::string_view name);

Result<std::unique_ptr<Decoder>> make_dermis_decoder(const ProtocolOptions& options);
Result<std::unique_ptr<Encoder>> make_dermis_encoder(const ProtocolOptions& options);
Result<std::unique_ptr<Decoder>> make_3dvitac_decoder(const ProtocolOptions& options);
Result<std::unique_ptr<Encoder>> make_3dvitac_encoder(const ProtocolOptions& options);
/// `any_size` takes lines of any number of values for frames, as one row each: to detect them.
std::unique_ptr<Decoder> make_csv_decoder(const ProtocolOptions& options, bool any_size);
Result<std::unique_ptr<Encoder>> make_csv_encoder(const ProtocolOptions& options);
std::unique_ptr<Decoder> make_json_decoder(const ProtocolOptions& options, bool any_size);
Result<std::unique_ptr<Encoder>> make_json_encoder(const ProtocolOptions& options);
Result<std::unique_ptr<Decoder>> make_stag_decoder(const ProtocolOptions& options);
Result<std::unique_ptr<Encoder>> make_stag_encoder(const ProtocolOptions& options);
Result<std::unique_ptr<Decoder>> make_tactileglove_decoder(const ProtocolOptions& options);
Result<std::unique_ptr<Encoder>> make_tactileglove_encoder(const ProtocolOptions& options);
Result<std::unique_ptr<Decoder>> make_wiresens_decoder(const ProtocolOptions& options);
Result<std::unique_ptr<Encoder>> make_wiresens_encoder(const ProtocolOptions& options);

Result<std::unique_ptr<Decoder>> make_auto_decoder(const ProtocolOptions& options);

}  // namespace dermis::bytes::devices
