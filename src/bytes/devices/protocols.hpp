// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>

#include "dermis/bytes/devices/encoder.hpp"
#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/layouts/decoder.hpp"
#include "dermis/touch/frames/result.hpp"

/// One pair of factories a protocol, listed in protocol.cpp; each in the file of its name, or in
/// described_protocols.cpp. Shapes that are given are valid and those of the protocol where it has but one; encoders
/// are given one.
namespace dermis::bytes::devices {

struct ProtocolEntry {
  const char* name = nullptr;
  std::optional<FrameShape> only_shape{};  ///< Empty where devices of the protocol differ.
  Result<std::unique_ptr<Decoder>> (*make_decoder)(const ProtocolOptions&) = nullptr;
  Result<std::unique_ptr<Encoder>> (*make_encoder)(const ProtocolOptions&) = nullptr;
};

Result<std::unique_ptr<Decoder>> make_dermis_decoder(const ProtocolOptions& options);
Result<std::unique_ptr<Encoder>> make_dermis_encoder(const ProtocolOptions& options);
Result<std::unique_ptr<Decoder>> make_described_decoder(const ProtocolOptions& options);
Result<std::unique_ptr<Encoder>> make_described_encoder(const ProtocolOptions& options);
Result<std::unique_ptr<Decoder>> make_wuji_decoder(const ProtocolOptions& options);
Result<std::unique_ptr<Encoder>> make_wuji_encoder(const ProtocolOptions& options);

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
