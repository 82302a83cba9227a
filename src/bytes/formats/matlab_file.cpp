// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/formats/matlab_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "bytes/formats/zlib_input.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::formats {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kMostVariables = 1000;
constexpr std::uint32_t kLongestName = 256;
constexpr std::uint32_t kMostDimensions = 8;
constexpr std::uint64_t kHeader5 = 128;

// The types of elements in files of version 5, by their codes.
constexpr std::uint32_t kInt8 = 1;
constexpr std::uint32_t kUint8 = 2;
constexpr std::uint32_t kInt16 = 3;
constexpr std::uint32_t kUint16 = 4;
constexpr std::uint32_t kInt32 = 5;
constexpr std::uint32_t kUint32 = 6;
constexpr std::uint32_t kSingle = 7;
constexpr std::uint32_t kDouble = 9;
constexpr std::uint32_t kInt64 = 12;
constexpr std::uint32_t kUint64 = 13;
constexpr std::uint32_t kMatrix = 14;
constexpr std::uint32_t kCompressed = 15;

/// Types of version 4, in the order of their codes.
constexpr std::array<std::uint32_t, 6> kTypes4 = {kDouble, kSingle, kInt32, kInt16, kUint16, kUint8};

/// 0: no number.
std::size_t bytes_of(std::uint32_t type) {
  switch (type) {
    case kInt8:
    case kUint8: return 1;
    case kInt16:
    case kUint16: return 2;
    case kInt32:
    case kUint32:
    case kSingle: return 4;
    case kDouble:
    case kInt64:
    case kUint64: return 8;
    default: return 0;
  }
}

template <typename Stored, typename Value>
void convert(std::span<char> bytes, bool is_big_endian, Value* values) {
  for (std::size_t k = 0; k < bytes.size() / sizeof(Stored); ++k) {
    const std::span<char> item = bytes.subspan(k * sizeof(Stored), sizeof(Stored));
    if (is_big_endian) std::reverse(item.begin(), item.end());
    Stored stored{};
    std::memcpy(&stored, item.data(), sizeof(Stored));
    values[k] = static_cast<Value>(stored);
  }
}

template <typename Value>
void convert(std::uint32_t type, std::span<char> bytes, bool is_big_endian, Value* values) {
  switch (type) {
    case kInt8: return convert<std::int8_t>(bytes, is_big_endian, values);
    case kUint8: return convert<std::uint8_t>(bytes, is_big_endian, values);
    case kInt16: return convert<std::int16_t>(bytes, is_big_endian, values);
    case kUint16: return convert<std::uint16_t>(bytes, is_big_endian, values);
    case kInt32: return convert<std::int32_t>(bytes, is_big_endian, values);
    case kUint32: return convert<std::uint32_t>(bytes, is_big_endian, values);
    case kSingle: return convert<float>(bytes, is_big_endian, values);
    case kInt64: return convert<std::int64_t>(bytes, is_big_endian, values);
    case kUint64: return convert<std::uint64_t>(bytes, is_big_endian, values);
    default: return convert<double>(bytes, is_big_endian, values);
  }
}

/// Where a variable is in the file.
struct Place {
  std::uint64_t begin = 0;  // of its bytes, as they are stored
  std::uint64_t bytes = 0;
  bool is_compressed = false;
  std::uint64_t values_at = 0;  // of its bytes, decompressed
  std::uint32_t type = 0;       // of its values
};

class File final : public MatlabFile {
 public:
  File(std::unique_ptr<std::istream> in, std::string name) : in_(std::move(in)), name_(std::move(name)) {}

  Status open() {
    std::array<char, kHeader5> header{};
    in_->read(header.data(), header.size());
    const auto got = static_cast<std::size_t>(in_->gcount());
    in_->clear();
    in_->seekg(0, std::ios::end);
    const std::streamoff end = in_->tellg();
    if (end < 0) return bad_input(name_ + ": cannot be read from a pipe; save it as a file");
    size_ = static_cast<std::uint64_t>(end);
    const std::string_view order(header.data() + kHeader5 - 2, 2);
    if (got == kHeader5 && (order == "IM" || order == "MI")) {
      is_big_endian_ = order == "MI";
      return list_version_5();
    }
    is_big_endian_ = header[0] == 0 && header[3] != 0;  // the first number is 0 ... 4052
    return list_version_4();
  }

  Status read(std::size_t index, std::vector<float>& values) override { return read_values(index, values); }
  Status read(std::size_t index, std::vector<double>& values) override { return read_values(index, values); }

 private:
  [[nodiscard]] Error damaged() const { return bad_input(name_ + ": is cut off or damaged, or no file of MATLAB"); }

  std::optional<std::uint32_t> number(ZlibInput& bytes) const {
    std::array<char, 4> item{};
    std::uint32_t value = 0;
    if (!bytes.read(item)) return std::nullopt;
    convert<std::uint32_t>(item, is_big_endian_, &value);
    return value;
  }

  Status list_version_4() {
    for (std::uint64_t at = 0; at < size_ && variables_.size() < kMostVariables;) {
      const Result<std::uint64_t> end = list_matrix_4(at);
      if (!end) return end.error();
      at = *end;
    }
    return Done{};
  }

  /// Returns its end.
  Result<std::uint64_t> list_matrix_4(std::uint64_t at) {
    constexpr std::uint32_t kBigEndian = 1000;
    in_->clear();
    in_->seekg(static_cast<std::streamoff>(at));
    ZlibInput bytes(*in_, size_ - at, false);
    std::array<std::uint32_t, 5> header{};  // type, rows, columns, whether it is complex, bytes of the name
    for (std::uint32_t& field : header) {
      const std::optional<std::uint32_t> read = number(bytes);
      if (!read) return damaged();
      field = *read;
    }
    const auto [kind, rows, cols, is_complex, name_bytes] = header;
    const std::uint32_t code = kind % kBigEndian / 10;
    if (kind / kBigEndian != (is_big_endian_ ? 1U : 0U) || code >= kTypes4.size()) return damaged();
    if (is_complex > 1 || name_bytes == 0 || name_bytes > kLongestName) return damaged();
    std::string name(name_bytes, '\0');
    if (!bytes.read(name)) return damaged();
    const std::uint64_t values_at = 4 * header.size() + name_bytes;
    const std::uint64_t count = std::uint64_t{rows} * cols;
    const std::uint64_t left = size_ - at - values_at;
    const std::uint64_t most = left / (bytes_of(kTypes4[code]) * (1 + is_complex));
    if (count > most) return damaged();
    const std::uint64_t length = count * bytes_of(kTypes4[code]);
    if (is_complex == 0 && kind % 10 == 0) {  // neither text nor sparse
      variables_.push_back({name.substr(0, name.find('\0')), {rows, cols}});
      places_.push_back({at, values_at + length, false, values_at, kTypes4[code]});
    }
    return at + values_at + length * (1 + is_complex);
  }

  Status list_version_5() {
    for (std::uint64_t at = kHeader5; at < size_ && variables_.size() < kMostVariables;) {
      in_->clear();
      in_->seekg(static_cast<std::streamoff>(at));
      ZlibInput tag(*in_, size_ - at, false);
      const std::optional<std::uint32_t> type = number(tag);
      const std::optional<std::uint32_t> length = number(tag);
      if (!type || !length || *length > size_ - at - 8) return damaged();
      Place place{at + 8, *length, *type == kCompressed};
      if (place.is_compressed || *type == kMatrix) {
        if (Status listed = list_matrix_5(place); !listed) return listed;
      }
      at += 8 + *length;
    }
    return Done{};
  }

  /// The bytes of an element within a matrix.
  struct Element {
    std::uint32_t type = 0;
    std::uint32_t bytes = 0;
    bool is_small = false;  // in the tag itself

    [[nodiscard]] std::uint64_t padded() const { return is_small ? 4 : (std::uint64_t{bytes} + 7) / 8 * 8; }
    [[nodiscard]] std::uint64_t size() const { return (is_small ? 4 : 8) + padded(); }
  };

  std::optional<Element> element(ZlibInput& bytes) const {
    const std::optional<std::uint32_t> first = number(bytes);
    if (!first) return std::nullopt;
    if (*first >> 16U != 0) return Element{*first & 0xFFFFU, *first >> 16U, true};
    const std::optional<std::uint32_t> length = number(bytes);
    if (!length) return std::nullopt;
    return Element{*first, *length, false};
  }

  /// The content of an element of at most so many bytes.
  std::optional<std::string> content(ZlibInput& bytes, const Element& element, std::uint32_t most) const {
    if (element.bytes > most || (element.is_small && element.bytes > 4)) return std::nullopt;
    std::string content(element.padded(), '\0');
    if (!bytes.read(content)) return std::nullopt;
    content.resize(element.bytes);
    return content;
  }

  Status list_matrix_5(Place place) {
    in_->clear();
    in_->seekg(static_cast<std::streamoff>(place.begin));
    ZlibInput bytes(*in_, place.bytes, place.is_compressed);
    if (place.is_compressed) {
      const std::optional<Element> matrix = element(bytes);
      if (!matrix) return damaged();
      if (matrix->type != kMatrix || matrix->is_small) return Done{};
      place.values_at = 8;
    }
    std::array<std::string, 3> parts;  // flags, sizes, name
    constexpr std::array<std::uint32_t, 3> kMost = {8, 4 * kMostDimensions, kLongestName};
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const std::optional<Element> part = element(bytes);
      if (!part) return damaged();
      std::optional<std::string> read = content(bytes, *part, kMost[k]);
      if (!read) return Done{};  // other kinds of variables have others
      parts[k] = *std::move(read);
      place.values_at += part->size();
    }
    const std::optional<Element> values = element(bytes);
    if (!values) return Done{};  // empty
    place.values_at += values->is_small ? 4 : 8;
    place.type = values->type;
    return add(place, *values, parts);
  }

  Status add(const Place& place, const Element& values, std::array<std::string, 3>& parts) {
    constexpr std::uint32_t kComplex = 0x800;
    auto& [flags, sizes, name] = parts;
    if (flags.size() != 8 || sizes.size() % 4 != 0) return Done{};
    std::uint32_t flag = 0;
    convert<std::uint32_t>(std::span(flags).first(4), is_big_endian_, &flag);
    const std::uint32_t kind = flag & 0xFFU;
    const bool is_number = kind >= 6 && kind <= 15;  // double to uint64
    if (!is_number || (flag & kComplex) != 0 || bytes_of(values.type) == 0) return Done{};
    std::vector<std::uint32_t> lengths(sizes.size() / 4);
    convert<std::uint32_t>(std::span(sizes), is_big_endian_, lengths.data());
    MatlabVariable variable{name, {lengths.begin(), lengths.end()}};
    const std::size_t count = variable.value_count();
    if (count > std::numeric_limits<std::uint32_t>::max() || values.bytes != count * bytes_of(values.type)) {
      return damaged();
    }
    variables_.push_back(std::move(variable));
    places_.push_back(place);
    return Done{};
  }

  template <typename Value>
  Status read_values(std::size_t index, std::vector<Value>& values) {
    constexpr std::size_t kPieceValues = 8192;
    const Place& place = places_[index];
    in_->clear();
    in_->seekg(static_cast<std::streamoff>(place.begin));
    ZlibInput bytes(*in_, place.bytes, place.is_compressed);
    if (!bytes.skip(place.values_at)) return damaged();
    values.clear();
    std::vector<char> piece;
    for (std::size_t left = variables_[index].value_count(); left > 0;) {
      const std::size_t count = std::min(left, kPieceValues);
      piece.resize(count * bytes_of(place.type));
      if (!bytes.read(piece)) {
        if (in_->bad()) return files::read_failure(name_);
        return damaged();
      }
      values.resize(values.size() + count);
      convert(place.type, piece, is_big_endian_, values.data() + values.size() - count);
      left -= count;
    }
    if (!bytes.finish()) return damaged();
    return Done{};
  }

  std::unique_ptr<std::istream> in_;
  std::string name_;
  std::uint64_t size_ = 0;
  bool is_big_endian_ = false;
  std::vector<Place> places_;  // of variables_
};

}  // namespace

Result<std::unique_ptr<MatlabFile>> open_matlab_file(std::unique_ptr<std::istream> in, const std::string& name) {
  auto file = std::make_unique<File>(std::move(in), name);
  if (const Status opened = file->open(); !opened) return opened.error();
  return std::unique_ptr<MatlabFile>(std::move(file));
}

}  // namespace dermis::bytes::formats
