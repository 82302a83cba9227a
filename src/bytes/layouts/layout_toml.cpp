// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The table [layout] of a TOML file (docs/layouts.md).
#include <algorithm>
#include <utility>

#include "bytes/layouts/constant_packets.hpp"
#include "bytes/layouts/has_role.hpp"
#include "bytes/layouts/line_pattern.hpp"
#include "bytes/layouts/packet_entry.hpp"
#include "bytes/layouts/raw_frames.hpp"
#include "dermis/bytes/files/config_table.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::layouts {
namespace {

using files::ConfigFile;

constexpr std::size_t kMostArrays = 64;
constexpr std::size_t kMostTaxels = std::size_t{1} << 20U;
constexpr std::size_t kMostFields = 256;
constexpr std::size_t kMostPatterns = 64;
constexpr std::size_t kMostLiteral = 256;

class LayoutReader {
 public:
  explicit LayoutReader(ConfigFile file) : file_(std::move(file)) {}

  Result<Layout> read() {
    const bool is_text = file_.contains("layout.line");
    if (is_text == file_.contains("layout.packet")) {
      fail("line", "give either line, for text, or packet, for bytes");
    }
    read_arrays();
    if (is_text) {
      read_text();
    } else {
      read_packet();
    }
    read_readings();
    for (const char* const table : {"array", "readout", "device"}) file_.ignore(table);
    if (Status finished = file_.finish(); !finished) return finished.error();
    return std::move(layout_);
  }

 private:
  [[nodiscard]] static std::string key(const std::string& name) { return "layout." + name; }
  void fail(const std::string& name, const std::string& message) { file_.fail(key(name), message); }

  void read_shape(const std::string& table, FrameShape& shape) {
    for (const auto& [name, lines] : {std::pair{"rows", &shape.rows}, {"cols", &shape.cols}}) {
      file_.require(table + name);
      file_.count(table + name, *lines);
      if (*lines < 1 || *lines > kMaxLines) {
        file_.fail(table + name, "must be 1 to 1024");
        *lines = 1;
      }
    }
  }

  void read_arrays() {
    const std::size_t count = file_.table_count(key("array"));
    if (count > kMostArrays) {
      fail("array", "there are more than 64");
      return layout_.arrays.push_back({"", {1, 1}});
    }
    const bool is_in_array = file_.contains("array.rows") && !file_.contains(key("rows"));
    if (count == 0) read_shape(is_in_array ? "array." : "layout.", layout_.arrays.emplace_back().shape);
    for (std::size_t k = 0; k < count; ++k) read_array(key("array[" + std::to_string(k) + "]."));
    if (layout_.arrays.empty()) layout_.arrays.push_back({"", {1, 1}});
    std::size_t taxels = 0;
    for (const LayoutArray& array : layout_.arrays) taxels += array.shape.taxel_count();
    if (taxels > kMostTaxels) fail(count > 0 ? "array" : "rows", "the arrays have more than 1048576 taxels");
  }

  void read_array(const std::string& table) {
    LayoutArray array;
    file_.require(table + "name");
    file_.text(table + "name", array.name);
    read_shape(table, array.shape);
    std::size_t id = 0;
    if (file_.contains(table + "id")) array.id = (file_.count(table + "id", id), id);
    const auto is_same = [&](const LayoutArray& other) {
      return other.name == array.name || (array.id && other.id == array.id);
    };
    if (array.name.empty() || array.name.find_first_of("{}#& \t") != std::string::npos) {
      file_.fail(table + "name", "must be a name without blanks and { } # &");
    } else if (std::any_of(layout_.arrays.begin(), layout_.arrays.end(), is_same)) {
      file_.fail(table + "name", "another array has this name or id");
    }
    layout_.arrays.push_back(std::move(array));
  }

  void read_patterns(TextLayout& text) {
    std::vector<std::string> patterns;
    if (file_.holds_text(key("line"))) {
      file_.text(key("line"), patterns.emplace_back());
    } else {
      file_.texts(key("line"), patterns);
    }
    if (patterns.size() > kMostPatterns) fail("line", "has more than 64 patterns");
    for (std::size_t k = 0; k < std::min(patterns.size(), kMostPatterns); ++k) {
      Result<TextLayout::Pattern> line = parse_line_pattern(patterns[k], layout_.arrays);
      const std::string which = patterns.size() > 1 ? "pattern " + std::to_string(k + 1) + ": " : "";
      if (!line) fail("line", which + line.error().message);
      if (line) text.lines.push_back(*std::move(line));
    }
    if (patterns.empty() || (!text.lines.empty() && !has_role(text.lines, Role::values))) {
      fail("line", "has no readings: write {values}, or the name of an array, where they stand");
    }
    for (const TextLayout::Pattern& line : text.lines) {
      if (has_counts(line)) {
        check_counts("line", line);
      } else {
        check_shares("line", line, !has_role(line, Role::col) && has_role(text.lines, Role::row));
      }
    }
  }

  void read_text() {
    TextLayout text;
    read_patterns(text);
    file_.text(key("line_end"), text.line_end);
    const std::string_view numbers = "0123456789abcdefABCDEF+-.,";
    if (!text.line_end.empty() && numbers.find(text.line_end.back()) != std::string_view::npos) {
      fail("line_end", "its last character must not be part of a number");
    }
    file_.text(key("separator"), text.separator);
    file_.text(key("comment"), text.comment);
    file_.text(key("frame_begin"), text.frame_begin);
    if (file_.contains(key("frame_end"))) file_.text(key("frame_end"), text.frame_end.emplace());
    file_.count(key("width"), text.width);
    if (text.width > 9) fail("width", "must be at most 9 characters");
    std::string point = ".";
    file_.text(key("decimal_point"), point);
    if (point != "." && point != ",") fail("decimal_point", "must be \".\" or \",\"");
    text.decimal_point = point.empty() ? '.' : point.front();
    std::size_t digits = 0;
    file_.choice(key("digits"), {"decimal", "hexadecimal"}, digits);
    text.is_hexadecimal = digits == 1;
    layout_.form = std::move(text);
  }

  /// A field says how many readings it has.
  template <typename Field>
  static bool has_counts(const std::vector<Field>& fields) {
    return std::ranges::any_of(fields,
                               [](const Field& field) { return field.role == Role::values && field.count > 0; });
  }

  template <typename Field>
  void check_counts(const char* name, const std::vector<Field>& fields) {
    const auto is_too_many = [&](const Field& field) {
      return field.role == Role::values && field.count > layout_.arrays[field.array].shape.taxel_count();
    };
    if (std::ranges::any_of(fields, is_too_many)) fail(name, "x is more than the array has taxels");
  }

  /// Fields of one array share its readings.
  template <typename Field>
  void check_shares(const char* name, const std::vector<Field>& fields, bool holds_row) {
    if (has_role(fields, Role::col) || has_role(fields, Role::first)) return;
    for (std::size_t k = 0; k < layout_.arrays.size(); ++k) {
      const FrameShape& shape = layout_.arrays[k].shape;
      const std::size_t shares = shares_of(fields, k);
      if (shares == 0 || (holds_row ? shape.cols : shape.taxel_count()) % shares == 0) continue;
      fail(name,
           std::to_string(shares) + " fields of readings cannot share those of a " + (holds_row ? "row" : "frame"));
    }
  }

  void read_packet() {
    PacketLayout layout;
    std::vector<std::vector<std::string>> packets;
    file_.text_rows(key("packet"), packets);
    if (packets.size() > kMostPatterns) {
      fail("packet", "has more than 64 packets");
      packets.resize(1);
    }
    for (std::size_t k = 0; k < packets.size(); ++k) {
      read_fields(packets[k], packets.size() > 1 ? "packet " + std::to_string(k + 1) + ": " : "",
                  layout.packets.emplace_back());
    }
    read_escape(layout);
    for (const PacketLayout::Packet& packet : layout.packets) check(packet);
    check_marks(layout);
    layout_.form = std::move(layout);
  }

  void read_fields(const std::vector<std::string>& entries, const std::string& which, PacketLayout::Packet& packet) {
    if (entries.size() > kMostFields) return fail("packet", which + "has more than 256 fields");
    for (std::size_t k = 0; k < entries.size(); ++k) {
      Result<PacketField> field = parse_packet_entry(entries[k], layout_.arrays);
      if (!field) fail("packet", which + "field " + std::to_string(k + 1) + ": " + field.error().message);
      if (field) packet.push_back(*std::move(field));
    }
  }

  void read_escape(PacketLayout& packet) {
    std::string escape;
    file_.text(key("escape"), escape);
    if (escape.empty()) return;
    const auto bytes = parse_bytes(escape);
    if (read_substitutes(escape, packet)) return;
    if (escape == "cobs") {
      packet.escape = PacketLayout::Escape::cobs;
    } else if (escape == "slip") {
      packet.escape = PacketLayout::Escape::slip;
    } else if (bytes && bytes->size() == 3) {
      packet.escape = PacketLayout::Escape::stuffed;
      packet.delimiter = (*bytes)[0];
      packet.escape_byte = (*bytes)[1];
      packet.escape_xor = (*bytes)[2];
    } else {
      fail("escape",
           "must be \"cobs\", \"slip\", or the bytes of delimiter, escape and its XOR, as \"7E 7D 20\", or of "
           "delimiter, escape and what its codes stand for, as \"C0 DB DC=C0 DD=DB\"");
    }
  }

  /// "C0 DB DC=C0 DD=DB"; false where it is none such.
  static bool read_substitutes(std::string escape, PacketLayout& packet) {
    const auto codes = std::ranges::count(escape, '=');
    std::ranges::replace(escape, '=', ' ');
    const auto bytes = parse_bytes(escape);
    if (codes == 0 || !bytes || bytes->size() != 2 + 2 * static_cast<std::size_t>(codes)) return false;
    packet.escape = PacketLayout::Escape::substituted;
    packet.delimiter = (*bytes)[0];
    packet.escape_byte = (*bytes)[1];
    for (std::size_t k = 2; k < bytes->size(); k += 2) packet.substitutes.push_back({(*bytes)[k], (*bytes)[k + 1]});
    return true;
  }

  void check(const PacketLayout::Packet& fields) {
    if (!has_role(fields, Role::count) && !has_counts(fields))
      check_shares("packet", fields, has_role(fields, Role::row));
    if (!has_role(fields, Role::values)) fail("packet", "has no readings, as \"values u16le\"");
    for (const PacketField& field : fields) {
      if (field.literal.size() > kMostLiteral) fail("packet", "a field has more than 256 bytes");
    }
    check_counts("packet", fields);
    const bool has_ids = std::all_of(layout_.arrays.begin(), layout_.arrays.end(),
                                     [](const LayoutArray& array) { return array.id.has_value(); });
    if (has_role(fields, Role::array) && !has_ids) fail("array", "each array needs an id, which the field array holds");
  }

  void check_marks(const PacketLayout& layout) {
    const auto begins_with_mark = [](const auto& packet) { return packet.front().role == Role::literal; };
    const auto ends_with_mark = [](const auto& packet) { return packet.back().role == Role::literal; };
    const auto is_empty = [](const auto& packet) { return packet.empty(); };
    const std::vector<PacketLayout::Packet>& packets = layout.packets;
    if (layout.escape != PacketLayout::Escape::none || std::ranges::any_of(packets, is_empty)) return;
    if (std::ranges::all_of(packets, begins_with_mark)) return;
    const Layout whole{layout_.arrays, layout};
    if (has_constant_sizes(whole) || is_one_frame(whole)) return;
    fail("packet", std::ranges::all_of(packets, ends_with_mark)
                       ? "its size differs, so it must begin with bytes that mark it, or have an escape"
                       : "must begin or end with bytes that mark it, as \"FF FF\", have an escape, or be a whole frame "
                         "that is always of one size");
  }

  void read_readings() {
    file_.number(key("scale"), layout_.scale);
    file_.number(key("offset"), layout_.offset);
    if (layout_.scale == 0.0) fail("scale", "must not be 0");
    read_absent();
    read_bytes("start", layout_.start);
    read_bytes("request", layout_.request);
    read_flags("absent", layout_.flags.absent);
    read_flags("late", layout_.flags.late);
    read_flags("corrupt", layout_.flags.corrupt);
    const std::vector<std::string> units = {"counts", "volts", "ohms", "kPa", "newtons"};
    std::size_t unit = 0;
    file_.choice(key("unit"), units, unit);
    layout_.unit = units[unit];
    file_.number(key("rate"), layout_.rate_hz);
    if (layout_.rate_hz && !(*layout_.rate_hz > 0.0 && *layout_.rate_hz <= 1e6)) {
      fail("rate", "must be above 0 and at most 1e6 frames a second");
    }
  }

  void read_absent() {
    std::vector<std::pair<double, double>> ranges;
    file_.ranges(key("absent"), ranges);
    for (const auto& [least, most] : ranges) layout_.absent.push_back({least, most});
  }

  /// A text, each of whose characters up to U+00FF is a byte, or a list of bytes.
  void read_bytes(const std::string& name, std::string& bytes) {
    if (file_.holds_text(key(name))) {
      std::string text;
      file_.text(key(name), text);
      bytes = files::latin_1_bytes(text);
      return;
    }
    std::vector<std::size_t> numbers;
    if (file_.contains(key(name))) file_.counts(key(name), numbers);
    if (std::ranges::any_of(numbers, [](std::size_t number) { return number > 0xFF; }))
      fail(name, "must be a text in quotes, or a list of bytes from 0 to 255");
    for (const std::size_t number : numbers) bytes += static_cast<char>(number);
  }

  void read_flags(const std::string& name, std::vector<std::uint64_t>& values) {
    std::vector<std::size_t> read;
    if (file_.contains(key("flags." + name))) file_.counts(key("flags." + name), read);
    values.assign(read.begin(), read.end());
  }

  ConfigFile file_;
  Layout layout_;
};

}  // namespace

Result<Layout> read_layout(const std::string& path) {
  Result<ConfigFile> file = ConfigFile::read(path);
  if (!file) return file.error();
  return LayoutReader(*std::move(file)).read();
}

Result<Layout> layout_from_toml(std::string_view text, const std::string& name) {
  Result<ConfigFile> file = ConfigFile::parse(text, name);
  if (!file) return file.error();
  return LayoutReader(*std::move(file)).read();
}

}  // namespace dermis::bytes::layouts
