// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// First byte: the protocol (4 bits), whether the shape is given, whether it is a small one, the other form of wiresens
// and stag and datagrams, and whether the stream is interrupted at its half. Second byte: how the bytes are cut. The
// rest: the bytes.
// Where the environment has DERMIS_FUZZ_PROTOCOL, the protocol is that one.
#include <array>
#include <cstdint>
#include <cstdlib>

#include "decoding.hpp"
#include "dermis/bytes/devices/protocol.hpp"

namespace dermis::bytes::devices {
namespace {

ProtocolOptions options_of(std::uint8_t choice) {
  ProtocolOptions options;
  static const char* const named = std::getenv("DERMIS_FUZZ_PROTOCOL");
  options.name = named != nullptr ? named : protocol_names()[(choice & 0x0FU) % protocol_names().size()];
  if ((choice & 0x10U) != 0) options.shape = (choice & 0x20U) != 0 ? FrameShape{2, 3} : FrameShape{16, 16};
  options.nodes_per_packet = (choice & 0x20U) != 0 ? 4 : 120;
  options.delimited = (choice & 0x40U) == 0;
  options.datagrams = (choice & 0x40U) != 0;
  options.bit_shift = (choice & 0x40U) == 0 ? 5 : 6;
  return options;
}

}  // namespace
}  // namespace dermis::bytes::devices

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dermis::bytes::devices;
  using namespace dermis::fuzz;
  if (size < 2) return 0;
  const ProtocolOptions options = options_of(data[0]);
  const auto whole = make_decoder(options);
  const auto cut = make_decoder(options);
  require(whole.has_value() == cut.has_value());
  if (!whole) return 0;
  const Bytes bytes(data + 2, size - 2);
  const std::size_t interrupted_at = (data[0] & 0x80U) != 0 ? bytes.size() / 2 : bytes.size();
  const std::size_t piece = 1 + data[1] * std::size_t{data[1]} / 16;
  require(decode(**whole, bytes, interrupted_at, bytes.size()) == decode(**cut, bytes, interrupted_at, piece));
  return 0;
}
