// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/protocol.hpp"

#include <algorithm>

#include "bytes/devices/protocols.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/nearest_name.hpp"

namespace dermis::bytes::devices {
namespace {

template <std::unique_ptr<Decoder> (*Make)(const ProtocolOptions&, bool)>
Result<std::unique_ptr<Decoder>> make_text_decoder(const ProtocolOptions& options) {
  return Make(options, false);
}

/// Bauds are those of MatrixArray.ino, TouchStreamer and WiSensToolkit.cpp.
std::vector<ProtocolEntry> all_protocols() {
  std::vector<ProtocolEntry> all = described_protocols();
  all.insert(all.end(),
             {{"3dvitac", std::nullopt, make_3dvitac_decoder, make_3dvitac_encoder, kIsText + 2, 2'000'000},
              {"csv", std::nullopt, make_text_decoder<make_csv_decoder>, make_csv_encoder, kIsText + 1},
              {"dermis", std::nullopt, make_dermis_decoder, make_dermis_encoder, kHasChecksum + 1},
              {"json", std::nullopt, make_text_decoder<make_json_decoder>, make_json_encoder, kIsText},
              {"stag", std::nullopt, make_stag_decoder, make_stag_encoder, kIsBinary + 1, 1'000'000},
              {"tactileglove", std::nullopt, make_tactileglove_decoder, make_tactileglove_encoder, kIsBinary},
              {"wiresens", std::nullopt, make_wiresens_decoder, make_wiresens_encoder, std::nullopt, 250'000}});
  std::ranges::sort(all, {}, &ProtocolEntry::name);
  all.push_back({"auto", std::nullopt, make_auto_decoder, nullptr});
  return all;
}

std::string to_string(const FrameShape& shape) {
  return "rows=" + std::to_string(shape.rows) + "&cols=" + std::to_string(shape.cols);
}

Error unknown(const std::string& name) {
  const std::vector<std::string>& names = protocol_names();
  const std::string nearest = nearest_name(name, {names.begin(), names.end()});
  if (!nearest.empty()) return bad_input("protocol=" + name + ": is not known; did you mean '" + nearest + "'?");
  std::string all;
  for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
  return bad_input("protocol=" + name + ": is not known; known are " + all);
}

/// The protocol, with options that it can have.
Result<const ProtocolEntry*> find_for(const ProtocolOptions& options) {
  const ProtocolEntry* protocol = find_protocol(options.name);
  if (protocol == nullptr) return unknown(options.name);
  if (!options.shape) return protocol;
  const FrameShape& shape = *options.shape;
  const auto is_valid = [](std::size_t lines) { return lines >= 1 && lines <= kMaxLines; };
  if (!is_valid(shape.rows) || !is_valid(shape.cols)) {
    return bad_input(to_string(shape) + ": rows and cols must be 1 ... " + std::to_string(kMaxLines));
  }
  if (protocol->only_shape && shape != *protocol->only_shape) {
    return bad_input(to_string(shape) + ": protocol=" + options.name + " has " + to_string(*protocol->only_shape));
  }
  return protocol;
}

Result<std::unique_ptr<Decoder>> make_layout_decoder(const ProtocolOptions& options) {
  Result<layouts::Layout> layout = read_layout(options);
  if (!layout) return layout.error();
  const Result<std::size_t> array = layout->find_array(options.array);
  if (!array) return bad_input(options.layout + ": " + array.error().message);
  const FrameShape& shape = layout->arrays[*array].shape;
  if (options.shape && *options.shape != shape) {
    return bad_input(to_string(*options.shape) + ": " + options.layout + " has " + to_string(shape));
  }
  return layouts::make_decoder(std::make_shared<const layouts::Layout>(*std::move(layout)), *array,
                               options.is_whole_file);
}

}  // namespace

const std::vector<ProtocolEntry>& protocol_entries() {
  static const std::vector<ProtocolEntry> kEntries = all_protocols();
  return kEntries;
}

const ProtocolEntry* find_protocol(std::string_view name) {
  const auto found = std::ranges::find(protocol_entries(), name, &ProtocolEntry::name);
  return found == protocol_entries().end() ? nullptr : &*found;
}

const std::vector<std::string>& protocol_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> all;
    for (const ProtocolEntry& entry : protocol_entries()) all.emplace_back(entry.name);
    return all;
  }();
  return kNames;
}

Result<std::unique_ptr<Decoder>> make_decoder(const ProtocolOptions& options) {
  if (options.has_layout()) return make_layout_decoder(options);
  const Result<const ProtocolEntry*> protocol = find_for(options);
  if (!protocol) return protocol.error();
  return (*protocol)->make_decoder(options);
}

Result<layouts::Layout> read_layout(const ProtocolOptions& options) {
  if (!options.layout.empty()) return layouts::read_layout(options.layout);
  Result<layouts::Layout> layout = layouts::layout_from_toml(options.layout_keys, "");
  if (layout) return layout;
  const std::string& message = layout.error().message;
  constexpr std::string_view kTable = "layout.";
  const std::size_t key = message.find(kTable);
  return bad_input(key == std::string::npos ? message : message.substr(key + kTable.size()));
}

Result<std::string> unit_of(const ProtocolOptions& options) {
  const Result<layouts::Layout> layout = read_layout(options);
  if (!layout) return layout.error();
  return layout->unit;
}

Result<std::unique_ptr<Encoder>> make_encoder(const ProtocolOptions& options) {
  if (options.name == "auto") return bad_input("protocol=auto: cannot be sent; name the protocol of the device");
  const Result<const ProtocolEntry*> protocol = find_for(options);
  if (!protocol) return protocol.error();
  if (!options.shape) return bad_input("protocol=" + options.name + ": needs rows and cols to send frames");
  return (*protocol)->make_encoder(options);
}

}  // namespace dermis::bytes::devices
