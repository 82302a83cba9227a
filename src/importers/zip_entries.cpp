// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "importers/zip_entries.hpp"

#include <zlib.h>

#include <algorithm>
#include <ios>
#include <optional>
#include <streambuf>
#include <string_view>
#include <utility>

#include "dermis/files/input.hpp"
#include "dermis/files/text.hpp"

namespace dermis::importers {
namespace {

// APPNOTE.TXT of PKWARE: sizes of the fixed parts and places in them.
constexpr std::size_t kEndBytes = 22;
constexpr std::size_t kLongestComment = 65535;
constexpr std::size_t kEnd64Bytes = 56;
constexpr std::size_t kLocator64Bytes = 20;
constexpr std::size_t kHeaderBytes = 46;       // in the list of contents
constexpr std::size_t kLocalHeaderBytes = 30;  // before the file itself
constexpr std::size_t kMostListBytes = std::size_t{1} << 24U;
constexpr std::uint64_t kIn64 = 0xFFFFFFFF;  // the number stands in a field of Zip64
constexpr std::size_t kPieceBytes = std::size_t{1} << 16U;

/// Little-endian; the bytes must be there.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t number = 0;
  for (std::size_t i = size; i-- > 0;) number = number << 8U | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

/// Fewer bytes where there are no more.
std::string read_at(std::istream& in, std::uint64_t offset, std::size_t size) {
  std::string bytes(size, '\0');
  in.clear();
  in.seekg(static_cast<std::streamoff>(std::min<std::uint64_t>(offset, 1ULL << 62U)));
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  bytes.resize(in ? size : static_cast<std::size_t>(in.gcount()));
  return bytes;
}

struct ListPlace {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
};

/// Where the list of contents stands, as the end of the archive says.
std::optional<ListPlace> find_list(std::istream& in) {
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(std::max<std::streamoff>(in.tellg(), 0));
  const std::uint64_t from = size - std::min<std::uint64_t>(size, kEndBytes + kLongestComment + kLocator64Bytes);
  const std::string tail = read_at(in, from, static_cast<std::size_t>(size - from));
  const std::size_t end = tail.rfind("PK\5\6");
  if (end == std::string::npos || tail.size() - end < kEndBytes) return std::nullopt;
  const ListPlace place{number_at(tail, end + 16, 4), number_at(tail, end + 12, 4)};
  const bool has_locator = end >= kLocator64Bytes && tail.substr(end - kLocator64Bytes, 4) == "PK\6\7";
  if (!has_locator) return place;
  const std::string end64 = read_at(in, number_at(tail, end - kLocator64Bytes + 8, 8), kEnd64Bytes);
  if (end64.size() < kEnd64Bytes || !end64.starts_with("PK\6\6")) return std::nullopt;
  return ListPlace{number_at(end64, 48, 8), number_at(end64, 40, 8)};
}

/// The numbers of an entry that need more than 32 bits stand in this order in its field of Zip64.
bool read_64(std::string_view fields, std::uint64_t uncompressed_bytes, ZipEntry& entry) {
  constexpr std::size_t kFieldHeader = 4;
  constexpr std::uint64_t kZip64 = 1;
  while (fields.size() >= kFieldHeader) {
    const std::uint64_t id = number_at(fields, 0, 2);
    const auto size = static_cast<std::size_t>(number_at(fields, 2, 2));
    if (fields.size() < kFieldHeader + size) return false;
    std::string_view field = fields.substr(kFieldHeader, size);
    fields.remove_prefix(kFieldHeader + size);
    if (id != kZip64) continue;
    if (uncompressed_bytes == kIn64) field.remove_prefix(std::min<std::size_t>(8, field.size()));
    for (std::uint64_t* const number : {&entry.compressed_bytes, &entry.offset}) {
      if (*number != kIn64) continue;
      if (field.size() < 8) return false;
      *number = number_at(field, 0, 8);
      field.remove_prefix(8);
    }
  }
  return true;
}

Status read_entry(std::string_view& list, ZipEntry& entry) {
  if (list.size() < kHeaderBytes || !list.starts_with("PK\1\2")) return bad_input("its list of contents is damaged");
  const auto name_bytes = static_cast<std::size_t>(number_at(list, 28, 2));
  const auto field_bytes = static_cast<std::size_t>(number_at(list, 30, 2));
  const auto comment_bytes = static_cast<std::size_t>(number_at(list, 32, 2));
  const std::size_t bytes = kHeaderBytes + name_bytes + field_bytes + comment_bytes;
  if (list.size() < bytes) return bad_input("its list of contents is cut");
  entry.name = list.substr(kHeaderBytes, name_bytes);
  entry.compressed_bytes = number_at(list, 20, 4);
  entry.offset = number_at(list, 42, 4);
  entry.crc32 = static_cast<std::uint32_t>(number_at(list, 16, 4));
  const std::uint64_t method = number_at(list, 10, 2);
  entry.is_deflated = method == 8;
  const bool is_encrypted = (number_at(list, 8, 2) & 1U) != 0;
  if (is_encrypted) return bad_input(files::in_quotes(entry.name) + " in it is encrypted");
  if (method != 0 && method != 8) return bad_input(files::in_quotes(entry.name) + " in it is not stored or deflated");
  const std::string_view fields = list.substr(kHeaderBytes + name_bytes, field_bytes);
  if (!read_64(fields, number_at(list, 24, 4), entry)) return bad_input("its list of contents is damaged");
  list.remove_prefix(bytes);
  return Done{};
}

}  // namespace

/// Inflated where they are deflated.
class ZipEntryStream::Bytes final : public std::streambuf {
 public:
  Bytes(std::unique_ptr<std::istream> in, const ZipEntry& entry)
      : in_(std::move(in)),
        left_(entry.compressed_bytes),
        compressed_(kPieceBytes),
        plain_(kPieceBytes),
        is_deflated_(entry.is_deflated),
        wanted_crc32_(entry.crc32) {
    constexpr int kNoHeader = -MAX_WBITS;
    is_over_ = is_deflated_ && inflateInit2(&state_, kNoHeader) != Z_OK;
  }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;
  ~Bytes() override {
    if (is_deflated_) inflateEnd(&state_);
  }

  [[nodiscard]] bool is_damaged() const noexcept { return is_at_end_ && crc32_ != wanted_crc32_; }

 private:
  int_type underflow() override {
    const std::size_t size = is_deflated_ ? inflate_piece() : read_piece(plain_);
    if (in_->bad()) throw std::ios_base::failure("cannot be read");  // as of std::filebuf: makes the stream bad
    crc32_ = ::crc32(crc32_, reinterpret_cast<const Bytef*>(plain_.data()), static_cast<uInt>(size));
    is_at_end_ = size == 0;
    setg(plain_.data(), plain_.data(), plain_.data() + size);
    return is_at_end_ ? traits_type::eof() : traits_type::to_int_type(plain_.front());
  }

  std::size_t read_piece(std::vector<char>& into) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(left_, into.size()));
    in_->read(into.data(), static_cast<std::streamsize>(wanted));
    const auto size = static_cast<std::size_t>(in_->gcount());
    left_ -= size;
    return size;
  }

  std::size_t inflate_piece() {
    state_.next_out = reinterpret_cast<Bytef*>(plain_.data());
    state_.avail_out = static_cast<uInt>(plain_.size());
    while (!is_over_ && state_.avail_out > 0) {
      if (state_.avail_in == 0) {
        state_.avail_in = static_cast<uInt>(read_piece(compressed_));
        state_.next_in = reinterpret_cast<Bytef*>(compressed_.data());
      }
      is_over_ = state_.avail_in == 0 || inflate(&state_, Z_NO_FLUSH) != Z_OK;
    }
    return plain_.size() - state_.avail_out;
  }

  std::unique_ptr<std::istream> in_;
  std::uint64_t left_;
  std::vector<char> compressed_;
  std::vector<char> plain_;
  z_stream state_{};
  bool is_deflated_;
  bool is_over_ = false;  ///< There is nothing more to inflate.
  bool is_at_end_ = false;
  uLong crc32_ = 0;
  uLong wanted_crc32_;
};

ZipEntryStream::ZipEntryStream(std::unique_ptr<std::istream> in, const ZipEntry& entry)
    : std::istream(nullptr), bytes_(std::make_unique<Bytes>(std::move(in), entry)) {
  rdbuf(bytes_.get());
}

ZipEntryStream::~ZipEntryStream() = default;

bool ZipEntryStream::is_damaged() const noexcept {
  return bytes_->is_damaged();
}

Result<std::vector<ZipEntry>> list_zip(std::istream& in) {
  const std::optional<ListPlace> place = find_list(in);
  if (!place) return bad_input("is no zip archive, or its end is missing");
  if (place->bytes > kMostListBytes) return bad_input("has a list of contents of more than 16 MiB");
  const std::string bytes = read_at(in, place->offset, static_cast<std::size_t>(place->bytes));
  if (bytes.size() < place->bytes) return bad_input("its list of contents is cut");
  std::vector<ZipEntry> entries;
  for (std::string_view list = bytes; !list.empty();) {
    ZipEntry entry;
    if (const Status read = read_entry(list, entry); !read) return read.error();
    entries.push_back(std::move(entry));
  }
  return entries;
}

Result<std::unique_ptr<ZipEntryStream>> open_zip_entry(std::unique_ptr<std::istream> in, const ZipEntry& entry,
                                                       const std::string& name) {
  const std::string header = read_at(*in, entry.offset, kLocalHeaderBytes);
  if (in->bad()) return files::read_failure(name);
  if (header.size() < kLocalHeaderBytes || !header.starts_with("PK\3\4")) {
    return bad_input(name + ": " + files::in_quotes(entry.name) + " in it is not where the list of contents says");
  }
  const std::uint64_t data = entry.offset + kLocalHeaderBytes + number_at(header, 26, 2) + number_at(header, 28, 2);
  in->clear();
  in->seekg(static_cast<std::streamoff>(std::min<std::uint64_t>(data, 1ULL << 62U)));
  return std::make_unique<ZipEntryStream>(std::move(in), entry);
}

}  // namespace dermis::importers
