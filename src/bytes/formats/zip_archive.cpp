// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/formats/zip_archive.hpp"

#include <algorithm>
#include <cstdio>
#include <ios>
#include <limits>
#include <utility>

#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::uint64_t kMostListBytes = std::uint64_t{1} << 24U;
constexpr std::size_t kPieceBytes = std::size_t{1} << 16U;

}  // namespace

Result<std::unique_ptr<ZipArchive>> ZipArchive::open(std::unique_ptr<std::istream> in, const std::string& name) {
  std::unique_ptr<ZipArchive> archive(new ZipArchive(std::move(in)));
  archive->readable_bytes_ = kMostListBytes;
  const auto answer = [](void* asked, void* data, zip_uint64_t size, zip_source_cmd_t command) {
    return static_cast<ZipArchive*>(asked)->answer(data, size, command);
  };
  zip_error_t error{};
  zip_source_t* const source = zip_source_function_create(answer, archive.get(), &error);
  archive->archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
  if (!archive->archive_) zip_source_free(source);  // else the archive has it
  const std::string why = zip_error_strerror(&error);
  zip_error_fini(&error);
  if (archive->is_bad()) return files::read_failure(name);
  if (archive->readable_bytes_ == 0) return bad_input(name + ": has a list of contents of more than 16 MiB");
  if (!archive->archive_) return bad_input(name + ": cannot be read as a zip archive: " + why);
  archive->readable_bytes_ = std::numeric_limits<std::uint64_t>::max();
  return archive;
}

ZipArchive::~ZipArchive() {
  entry_.reset();
  archive_.reset();  // asks for the last time
  zip_error_fini(&error_);
}

std::vector<std::string> ZipArchive::entries() const {
  std::vector<std::string> names(static_cast<std::size_t>(zip_get_num_entries(archive_.get(), 0)));
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = zip_get_name(archive_.get(), i, ZIP_FL_ENC_RAW);
  return names;
}

Status ZipArchive::enter(std::size_t entry) {
  entry_.reset(zip_fopen_index(archive_.get(), entry, 0));
  piece_.resize(kPieceBytes);
  setg(nullptr, nullptr, nullptr);
  if (entry_) return Done{};
  const std::string name = files::in_quotes(zip_get_name(archive_.get(), entry, ZIP_FL_ENC_RAW));
  return bad_input(name + " in it cannot be read: " + zip_strerror(archive_.get()));
}

ZipArchive::int_type ZipArchive::underflow() {
  const zip_int64_t size = zip_fread(entry_.get(), piece_.data(), piece_.size());
  if (is_bad()) throw std::ios_base::failure("cannot be read");
  if (size < 0) damage_ = zip_file_strerror(entry_.get());
  if (size <= 0) return traits_type::eof();
  setg(piece_.data(), piece_.data(), piece_.data() + size);
  return traits_type::to_int_type(piece_.front());
}

/// What libzip asks of the file.
zip_int64_t ZipArchive::answer(void* data, zip_uint64_t size, zip_source_cmd_t command) {
  switch (command) {
    case ZIP_SOURCE_SUPPORTS: return ZIP_SOURCE_SUPPORTS_SEEKABLE;
    case ZIP_SOURCE_OPEN: return seek(0, SEEK_SET);
    case ZIP_SOURCE_READ: return read(static_cast<char*>(data), size);
    case ZIP_SOURCE_STAT: return describe(*static_cast<zip_stat_t*>(data));
    case ZIP_SOURCE_TELL: return in_->tellg();
    case ZIP_SOURCE_SEEK: {
      const auto& place = *static_cast<const zip_source_args_seek_t*>(data);
      return seek(place.offset, place.whence);
    }
    case ZIP_SOURCE_ERROR: return zip_error_to_data(&error_, data, size);
    case ZIP_SOURCE_CLOSE:
    case ZIP_SOURCE_FREE: return 0;
    default: return fail(ZIP_ER_OPNOTSUPP);
  }
}

zip_int64_t ZipArchive::read(char* data, zip_uint64_t size) {
  readable_bytes_ -= std::min(readable_bytes_, size);
  if (readable_bytes_ == 0) return fail(ZIP_ER_READ);
  in_->read(data, static_cast<std::streamsize>(size));
  return is_bad() ? fail(ZIP_ER_READ) : in_->gcount();
}

zip_int64_t ZipArchive::seek(std::streamoff offset, int whence) {
  in_->clear(in_->rdstate() & std::ios::badbit);  // an end that was reached is left
  in_->seekg(offset, whence == SEEK_SET ? std::ios::beg : whence == SEEK_CUR ? std::ios::cur : std::ios::end);
  return in_->good() ? 0 : fail(ZIP_ER_SEEK);
}

zip_int64_t ZipArchive::describe(zip_stat_t& stat) {
  if (seek(0, SEEK_END) < 0) return -1;
  zip_stat_init(&stat);
  stat.valid = ZIP_STAT_SIZE;
  stat.size = static_cast<zip_uint64_t>(in_->tellg());
  return sizeof(stat);
}

zip_int64_t ZipArchive::fail(int code) {
  zip_error_set(&error_, code, 0);
  return -1;
}

}  // namespace dermis::bytes::formats
