// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/importers/npz.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/files/input.hpp"
#include "dermis/files/npy.hpp"
#include "dermis/files/text.hpp"
#include "importers/zip_entries.hpp"

namespace dermis::importers {
namespace {

constexpr std::string_view kEnding = ".npy";

/// As numpy.load() calls it.
std::string_view array_name(const ZipEntry& entry) {
  std::string_view name = entry.name;
  if (name.ends_with(kEnding)) name.remove_suffix(kEnding.size());
  return name;
}

Result<ZipEntry> choose(const std::vector<ZipEntry>& entries, const std::string& file, const std::string& array) {
  if (entries.empty()) return bad_input(file + ": holds no array");
  if (array.empty() && entries.size() == 1) return entries.front();
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const ZipEntry& entry) { return array_name(entry) == array; });
  if (found != entries.end()) return *found;
  constexpr std::size_t kMostNames = 50;
  std::string names;
  for (std::size_t i = 0; i < std::min(entries.size(), kMostNames); ++i) {
    names += (i > 0 ? ", " : "") + files::in_quotes(array_name(entries[i]));
  }
  const std::string which = array.empty() ? "name one" : "has no array " + files::in_quotes(array);
  return bad_input(file + ": " + which + ", as " +
                   files::in_quotes(file + "#" + std::string(array_name(entries.front()))) + "; it has: " + names);
}

class Npz final : public FrameSource {
 public:
  /// `reader` reads from `bytes`.
  Npz(std::unique_ptr<files::NpyReader> reader, const ZipEntryStream& bytes, std::string name)
      : reader_(std::move(reader)), bytes_(bytes), name_(std::move(name)) {}

  Result<bool> next(RawFrame& frame) override {
    Result<bool> more = reader_->next(frame);
    if (bytes_.bad()) return files::read_failure(name_);
    if ((!more || !*more) && bytes_.is_damaged()) {
      return bad_input(name_ + ": is damaged: its bytes have not the checksum of the archive; save it again");
    }
    return more;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return reader_->shape(); }

 private:
  std::unique_ptr<files::NpyReader> reader_;
  const ZipEntryStream& bytes_;
  std::string name_;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> open_npz(std::unique_ptr<std::istream> in, const std::string& name,
                                              const ImportOptions& options) {
  const Result<std::vector<ZipEntry>> entries = list_zip(*in);
  if (in->bad()) return files::read_failure(name);
  if (!entries) return bad_input(name + ": " + entries.error().message);
  const Result<ZipEntry> entry = choose(*entries, name, options.array);
  if (!entry) return entry.error();
  Result<std::unique_ptr<ZipEntryStream>> opened = open_zip_entry(std::move(in), *entry, name);
  if (!opened) return opened.error();
  const ZipEntryStream& bytes = **opened;
  const std::string place = entries->size() > 1 ? name + "#" + std::string(array_name(*entry)) : name;
  Result<std::unique_ptr<files::NpyReader>> reader =
      files::NpyReader::open(*std::move(opened), place, {*options.rate_hz, options.shape});
  if (!reader) return reader.error();
  return std::unique_ptr<FrameSource>(std::make_unique<Npz>(*std::move(reader), bytes, place));
}

}  // namespace dermis::importers
