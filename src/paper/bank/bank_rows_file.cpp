// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/bank/bank_rows_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <istream>
#include <memory>
#include <optional>
#include <utility>

#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/output_place.hpp"

namespace dermis::paper {
namespace {

std::string_view bytes_of(std::span<const float> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

bool read_at(std::istream& in, std::uint64_t offset, std::span<char> bytes) {
  in.seekg(static_cast<std::streamoff>(offset));
  return in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())).good();
}

std::string with_checksum(const bytes::files::SafetensorsBeginning& beginning, const std::string& checksum) {
  std::string bytes = beginning.bytes;
  return bytes.replace(beginning.checksum, checksum.size(), checksum);
}

}  // namespace

BankRowsFile::BankRowsFile(const bytes::files::SafetensorsFile& first, Rows rows, Ranks& ranks)
    : beginning_(bytes::files::begin_safetensors(first, rows.tensors, {rows.networks, rows.parameters})),
      rows_(std::move(rows)),
      ranks_(ranks),
      own_(own_part(ranks, rows_.networks)) {}

std::uint64_t BankRowsFile::offset(std::size_t tensor, std::size_t network) const {
  const std::size_t row = tensor * rows_.networks + own_.first + network;
  return beginning_.bytes.size() + row * rows_.parameters * sizeof(float);
}

/// That of the whole file; the ranks add their rows in turn.
std::string BankRowsFile::checksum(const std::string& first, const Row& row) const {
  bytes::files::ContentHash hash = beginning_.hash;
  hash.add(first);
  std::vector<float> values(rows_.parameters);
  for (std::size_t tensor = 0; tensor < rows_.tensors.size(); ++tensor) {
    for (std::size_t rank = 0; rank < ranks_.count(); ++rank) {
      for (std::size_t network = 0; rank == ranks_.rank() && network < own_.count; ++network) {
        row(tensor, network, values);
        hash.add(bytes_of(values));
      }
      broadcast_value(ranks_, hash, rank);
    }
  }
  return hash.text();
}

/// Returns 0, or the errno. All bytes follow each other where the file is not regular.
int BankRowsFile::write_own(int descriptor, bool is_regular, const std::string& beginning, const Row& give) const {
  const auto write = [&](std::span<const std::byte> bytes, std::uint64_t offset) {
    return bytes::files::write_all(descriptor, bytes, is_regular ? std::optional(offset) : std::nullopt);
  };
  int error = ranks_.rank() == 0 ? write(std::as_bytes(std::span(beginning)), 0) : 0;
  std::vector<float> values(rows_.parameters);
  for (std::size_t tensor = 0; tensor < rows_.tensors.size(); ++tensor) {
    for (std::size_t network = 0; error == 0 && network < own_.count; ++network) {
      give(tensor, network, values);
      error = write(std::as_bytes(std::span(values)), offset(tensor, network));
    }
  }
  if (error == 0 && is_regular && ::fsync(descriptor) != 0) error = errno;
  return ::close(descriptor) != 0 && error == 0 ? errno : error;
}

Status BankRowsFile::write(const std::string& path, const Row& give) const {
  const std::string first = beginning_.bytes.substr(beginning_.header_bytes);
  const std::string beginning = with_checksum(beginning_, checksum(first, give));
  Result<bytes::files::OutputPlace> place =
      ranks_.rank() == 0 ? bytes::files::open_output(path) : bytes::files::OutputPlace{};
  if (Status opened = agreed(ranks_, place ? Status(Done{}) : place.error()); !opened) return opened;
  std::string shared = place->unfinished.path();
  broadcast_list(ranks_, shared);
  if (ranks_.rank() > 0) place->descriptor = ::open(shared.c_str(), O_WRONLY | O_CLOEXEC);
  int error = place->descriptor < 0 ? errno : 0;
  if (error == 0) error = write_own(place->descriptor, !shared.empty(), beginning, give);
  Status written = error == 0 ? Status(Done{}) : bytes::files::cannot_write(path, error);
  written = agreed(ranks_, written);
  if (written && place->unfinished.exists()) {
    const Result<bytes::files::Placed> placed = place->unfinished.take_place();
    written = placed ? placed->told : placed.error();
    bytes::files::synchronise_folder_of(place->target);
  }
  return agreed(ranks_, written);
}

Result<std::string> BankRowsFile::read(const std::string& path, const char* otherwise, const Row& take) const {
  const Result<std::unique_ptr<std::istream>> in = bytes::files::open_input(path);
  if (Status opened = agreed(ranks_, in ? Status(Done{}) : in.error()); !opened) return opened.error();
  std::string bytes(beginning_.bytes.size(), '\0');
  bool is_whole = read_at(**in, 0, bytes);
  const std::string recorded = bytes.substr(beginning_.checksum, bytes::files::ContentHash().text().size());
  const std::string header = with_checksum(beginning_, recorded).substr(0, beginning_.header_bytes);
  const Status fits = bytes.starts_with(header) ? Status(Done{}) : bad_input(path + ": " + otherwise);
  if (Status all = agreed(ranks_, fits); !all) return all.error();
  std::string first = bytes.substr(beginning_.header_bytes);
  const std::string found = checksum(first, [&](std::size_t tensor, std::size_t network, std::span<float> values) {
    const std::span<char> row(reinterpret_cast<char*>(values.data()), values.size_bytes());
    is_whole = is_whole && read_at(**in, offset(tensor, network), row);
    take(tensor, network, values);
  });
  const bool is_sound = is_whole && found == recorded;
  const Status sound = is_sound ? Status(Done{}) : bad_input(path + ": is damaged: its checksum differs");
  if (Status all = agreed(ranks_, sound); !all) return all.error();
  return first;
}

}  // namespace dermis::paper
