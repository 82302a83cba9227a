// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/packet_entry.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "bytes/layouts/field_names.hpp"
#include "dermis/bytes/files/numbers.hpp"

namespace dermis::bytes::layouts {
namespace {

constexpr std::size_t kMostTokens = 64;

std::vector<std::string_view> tokens_of(std::string_view text) {
  std::vector<std::string_view> tokens;
  while (tokens.size() < kMostTokens) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    tokens.push_back(text.substr(0, text.find_first_of(" \t")));
    text.remove_prefix(tokens.back().size());
  }
  return tokens;
}

/// "values u16 le x4" -> "values u16le x4"
std::string with_order_at_type(const std::vector<std::string_view>& tokens) {
  std::string text;
  for (const std::string_view token : tokens) {
    const bool is_order = token == "le" || token == "be";
    if (!text.empty() && !is_order) text += ' ';
    text += token;
  }
  return text;
}

template <typename Number>
std::optional<Number> number_in(std::string_view text) {
  Number value{};
  return files::parse_number(text, value) ? std::optional(value) : std::nullopt;
}

template <typename Number>
std::optional<Number> hexadecimal_in(std::string_view text) {
  Number value{};
  return files::parse_hexadecimal(text, value) ? std::optional(value) : std::nullopt;
}

std::optional<bool> order_in(std::string_view& type) {
  const bool is_big = type.ends_with("be");
  if (!is_big && !type.ends_with("le")) return std::nullopt;
  type.remove_suffix(2);
  return is_big;
}

Error bad_type(std::string_view text) {
  return bad_input(
      "'" + std::string(text) +
      "' is no type: it is u8, i8, u10, u12, u16, i16, u24, u32, i32, u64, f32 or f64, then le where the low byte "
      "comes first or be where the high byte does");
}

Result<WireType> type_in(std::string_view text) {
  std::string_view rest = text;
  const std::optional<bool> is_big_endian = order_in(rest);
  const std::optional<unsigned> bits = number_in<unsigned>(rest.substr(std::min<std::size_t>(rest.size(), 1)));
  if (!bits || rest.empty()) return bad_type(text);
  const std::string_view kinds = "uif";
  const std::size_t kind = kinds.find(rest.front());
  constexpr std::array kWhole = {8U, 10U, 12U, 16U, 24U, 32U, 64U};
  const bool is_real = kind == 2 && (*bits == 32 || *bits == 64);
  const bool is_whole = kind < 2 && std::find(kWhole.begin(), kWhole.end(), *bits) != kWhole.end();
  if ((!is_real && !is_whole) || (*bits > 8 && !is_big_endian)) return bad_type(text);
  return WireType{static_cast<WireType::Kind>(kind), *bits, is_big_endian.value_or(false)};
}

struct KnownChecksum {
  std::string_view name;
  unsigned bits;
  Checksum checksum;
};

Checksum crc(std::uint32_t polynomial, std::uint32_t initial, std::uint32_t final_xor, bool is_reflected) {
  return {Checksum::Kind::crc, 0, polynomial, initial, final_xor, is_reflected};
}

/// The parameters of the CRCs are those of their usual names (reveng.sourceforge.io, catalogue of parametrised CRCs).
const std::array<KnownChecksum, 12>& known_checksums() {
  static const std::array<KnownChecksum, 12> kAll = {{
      {"sum8", 8, {}},
      {"sum16", 16, {}},
      {"sum32", 32, {}},
      {"xor8", 8, {.kind = Checksum::Kind::exclusive_or}},
      {"crc8", 8, crc(0x07, 0, 0, false)},
      {"crc8-maxim", 8, crc(0x31, 0, 0, true)},
      {"crc16", 16, crc(0x1021, 0xFFFF, 0, false)},
      {"crc16-ccitt", 16, crc(0x1021, 0xFFFF, 0, false)},
      {"crc16-xmodem", 16, crc(0x1021, 0, 0, false)},
      {"crc16-modbus", 16, crc(0x8005, 0xFFFF, 0, true)},
      {"crc16-kermit", 16, crc(0x1021, 0, 0, true)},
      {"crc32", 32, kCrc32},
  }};
  return kAll;
}

Status read_checksum_option(std::string_view token, unsigned bits, Checksum& checksum) {
  if (token == "reflected") return checksum.is_reflected = true, Done{};
  if (token == "plain") return checksum.is_reflected = false, Done{};
  if (token == "negated") return checksum.is_negated = true, Done{};
  const std::size_t equals = std::min(token.find('='), token.size());
  const std::string_view name = token.substr(0, equals);
  const std::string_view text = token.substr(std::min(equals + 1, token.size()));
  if (name == "from") {
    const std::optional<std::size_t> from = number_in<std::size_t>(text);
    if (!from || *from > 1024) return bad_input("from=: must be a number of bytes, 0 to 1024");
    return checksum.from = *from, Done{};
  }
  const std::optional<std::uint32_t> value = hexadecimal_in<std::uint32_t>(text);
  if (!value || *value > UINT32_MAX >> (32U - bits)) {
    return bad_input("'" + std::string(token) +
                     "' is no part of a checksum: it has poly=, init= and xorout= in hexadecimal "
                     "digits, from=BYTES, reflected, plain and negated");
  }
  if (name == "poly") return checksum.polynomial = *value, Done{};
  if (name == "init") return checksum.initial = *value, Done{};
  if (name == "xorout") return checksum.final_xor = *value, Done{};
  return bad_input("'" + std::string(name) + "=' is no part of a checksum: it has poly=, init=, xorout= and from=");
}

Result<PacketField> parse_checksum(const std::vector<std::string_view>& tokens) {
  PacketField field;
  field.role = Role::checksum;
  std::string_view name = tokens.size() > 1 ? tokens[1] : std::string_view();
  const std::optional<bool> is_big_endian = order_in(name);
  const auto& all = known_checksums();
  const auto known = std::find_if(all.begin(), all.end(), [&](const KnownChecksum& one) { return one.name == name; });
  if (known == all.end()) {
    std::string names;
    for (const KnownChecksum& one : all) names += (names.empty() ? "" : ", ") + std::string(one.name);
    return bad_input("'" + std::string(name) + "' is no checksum; known are " + names);
  }
  if (known->bits > 8 && !is_big_endian) {
    return bad_input("'" + std::string(name) + "': write le behind it where its low byte comes first, or be");
  }
  field.checksum = known->checksum;
  field.type = {WireType::Kind::whole, known->bits, is_big_endian.value_or(false)};
  for (std::size_t k = 2; k < tokens.size(); ++k) {
    if (Status read = read_checksum_option(tokens[k], known->bits, field.checksum); !read) return read.error();
  }
  return field;
}

Status read_mask(std::string_view digits, WireType& type) {
  const std::optional<std::uint64_t> mask = hexadecimal_in<std::uint64_t>(digits);
  const bool fits = mask && *mask > 0 && (type.bits == 64 || *mask >> type.bits == 0);
  if (!fits || type.kind != WireType::Kind::whole) {
    return bad_input("mask= must be hexadecimal digits of bits that a number without a sign has");
  }
  return type.mask = *mask, Done{};
}

/// "x48" readings, "mask=0FFF", "*0.01", "+273.15"
Status read_option(std::string_view token, PacketField& field) {
  const std::string_view rest = token.substr(1);
  if (token.starts_with("mask=")) return read_mask(token.substr(5), field.type);
  if (token.front() == 'x' && field.role == Role::values) {
    const std::optional<std::size_t> count = number_in<std::size_t>(rest);
    if (!count || *count == 0 || *count > std::size_t{1} << 20U) return bad_input("x must be 1 to 1048576 readings");
    return field.count = *count, Done{};
  }
  const bool is_factor = token.front() == '*';
  const std::optional<double> value = number_in<double>(token.front() == '-' ? token : rest);
  if ((!is_factor && token.front() != '+' && token.front() != '-') || !value || !(*value > -1e12 && *value < 1e12)) {
    return bad_input("'" + std::string(token) + "' is neither *FACTOR nor +OFFSET nor mask=BITS" +
                     (field.role == Role::values ? ", nor x and a number of readings" : ""));
  }
  if (field.role == Role::values)
    return bad_input("scale and offset of readings stand in layout.scale and layout.offset");
  if (is_factor) return field.unit *= *value, Done{};
  return field.offset += *value, Done{};
}

Result<PacketField> parse_skip(const std::vector<std::string_view>& tokens) {
  const std::optional<std::size_t> count = tokens.size() == 2 ? number_in<std::size_t>(tokens[1]) : std::nullopt;
  if (!count || *count == 0 || *count > 65536) return bad_input("skip: give a number of bytes, as 'skip 4'");
  PacketField field;
  field.role = Role::skip;
  field.count = *count;
  return field;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> parse_bytes(std::string_view text) {
  std::vector<std::uint8_t> bytes;
  for (const std::string_view token : tokens_of(text)) {
    const std::optional<unsigned> byte = token.size() == 2 ? hexadecimal_in<unsigned>(token) : std::nullopt;
    if (!byte) return std::nullopt;
    bytes.push_back(static_cast<std::uint8_t>(*byte));
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

Result<PacketField> parse_packet_entry(std::string_view entry, const std::vector<LayoutArray>& arrays) {
  if (auto bytes = parse_bytes(entry)) return PacketField{.role = Role::literal, .literal = *std::move(bytes)};
  const std::string text = with_order_at_type(tokens_of(entry));
  const std::vector<std::string_view> tokens = tokens_of(text);
  if (tokens.empty()) return bad_input("is empty: it is bytes as FF 0A, or a field and its type");
  const Result<NamedField> named = field_named(tokens[0], FieldsOf::packet, arrays);
  if (!named) return named.error();
  if (named->role == Role::skip) return parse_skip(tokens);
  if (named->role == Role::checksum) return parse_checksum(tokens);
  if (tokens.size() < 2) return bad_input("'" + std::string(tokens[0]) + "' needs a type, as u16le");
  const Result<WireType> type = type_in(tokens[1]);
  if (!type) return type.error();
  if (type->bits % 8 != 0 && named->role != Role::values) return bad_input("only readings are packed in 10 or 12 bits");
  PacketField field;
  field.role = named->role;
  field.type = *type;
  field.array = named->array;
  field.unit = named->unit;
  for (std::size_t k = 2; k < tokens.size(); ++k) {
    if (Status read = read_option(tokens[k], field); !read) return read.error();
  }
  return field;
}

}  // namespace dermis::bytes::layouts
