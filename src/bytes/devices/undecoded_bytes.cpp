// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/undecoded_bytes.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>

#include "dermis/bytes/devices/device_source.hpp"
#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/proposals/look.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr Nanos kTooLong = std::chrono::seconds(5);
constexpr std::size_t kMostKept = std::size_t{256} << 10U;
constexpr std::size_t kUnknownFrameBytes = 4096;
constexpr std::size_t kMostBytesPerTaxel = 6;  // "65535 "

proposals::Known known_of(const ProtocolOptions& protocol) {
  proposals::Known known;
  if (protocol.shape) known = {.rows = protocol.shape->rows, .cols = protocol.shape->cols};
  return known;
}

/// The reason that the decoder of that name gives for the bytes.
UndecodedReason advice_of(const std::string& name, ProtocolOptions options, std::span<const std::uint8_t> bytes) {
  options.name = name;
  const Result<std::unique_ptr<Decoder>> decoder = make_decoder(options);
  if (!decoder) return {};
  RawFrame frame;
  for (std::size_t at = 0; at < bytes.size(); at += Decoder::kMaxPush) {
    (*decoder)->push(bytes.subspan(at, std::min(Decoder::kMaxPush, bytes.size() - at)));
    while ((*decoder)->next(frame)) {
    }
  }
  return {(*decoder)->advice(), (*decoder)->likely_shape()};
}

}  // namespace

void UndecodedBytes::clear() {
  first_.clear();
  count_ = 0;
}

void UndecodedBytes::add(std::span<const std::uint8_t> bytes, Nanos arrival) {
  if (first_.empty()) begin_ = arrival;
  count_ += bytes.size();
  const std::span<const std::uint8_t> kept = bytes.first(std::min(kMostKept - first_.size(), bytes.size()));
  first_.insert(first_.end(), kept.begin(), kept.end());
}

bool UndecodedBytes::are_too_many(const std::optional<FrameShape>& shape, Nanos at) const {
  const std::size_t frame = shape ? shape->taxel_count() * kMostBytesPerTaxel : kUnknownFrameBytes;
  return count_ >= std::min(4 * frame, kMostKept) && at - begin_ >= kTooLong;
}

Error UndecodedBytes::error(const SourceUri& uri) const {
  return bad_input(why_undecoded(uri, first_).why);
}

UndecodedReason why_undecoded(const SourceUri& uri, std::span<const std::uint8_t> bytes) {
  const ProtocolOptions& protocol = uri.protocol;
  if (protocol.has_layout()) {
    const UndecodedReason advice = advice_of(protocol.name, protocol, bytes);
    return {"'" + uri.text + "': these bytes do not fit " + (protocol.layout.empty() ? "its layout" : protocol.layout) +
            ": " + advice.why};
  }
  const bool is_auto = protocol.name == "auto";
  const std::string looks_like = detect_protocol(bytes);
  const std::string place = "'" + uri.text + "': ";
  if (is_auto || looks_like == protocol.name) {
    const UndecodedReason advice = advice_of(looks_like, protocol, bytes);
    if (!advice.why.empty())
      return {place + "these bytes are " + looks_like + ", but " + advice.why, advice.likely_shape};
  }

  std::string text = place + "these bytes are " + (is_auto ? "of no known protocol" : "not " + protocol.name);
  if (protocol.shape) text += " " + shape_text(*protocol.shape);
  if (is_auto || looks_like.empty()) {
    const bool is_serial = uri.transport == Transport::serial;
    text += std::string(": check protocol=") + (is_serial ? " and baud=" + std::to_string(uri.baud) : "");
    return {text + ". " + proposals::look_of(bytes, known_of(protocol))};
  }
  if (looks_like != protocol.name) return {text + "; they look like " + looks_like + ": protocol=" + looks_like};
  return {text + "; they look like " + looks_like + " of another size: check rows and cols"};
}

std::string shape_text(const FrameShape& shape) {
  return std::to_string(shape.rows) + "x" + std::to_string(shape.cols);
}

}  // namespace dermis::bytes::devices
