// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "bytes/formats/zip_archive.hpp"
#include "dermis/bytes/files/array_frames.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/npy.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/formats/imports.hpp"

namespace dermis::bytes::formats {
namespace {

using files::kTimeNames;
using files::TimeName;

constexpr std::string_view kEnding = ".npy";

Error no_times(const std::string& name) {
  return bad_input(name + ": has no times: give a rate, when it is converted or as 'file:" + name + "?rate=HZ'");
}

/// As numpy.load() calls it.
std::string array_name(std::string entry) {
  if (entry.ends_with(kEnding)) entry.resize(entry.size() - kEnding.size());
  return entry;
}

/// The place of the array in `arrays`.
Result<std::size_t> choose(const std::vector<std::string>& arrays, const std::string& file, const std::string& array) {
  if (arrays.empty()) return bad_input(file + ": holds no array");
  const auto is_time = [](const std::string& name) {
    return std::ranges::find(kTimeNames, name, &TimeName::name) != kTimeNames.end();
  };
  const bool is_only_one = std::ranges::count_if(arrays, is_time) + 1 == std::ssize(arrays);
  if (array.empty() && (arrays.size() == 1 || is_only_one)) {
    return static_cast<std::size_t>(std::ranges::find_if_not(arrays, is_time) - arrays.begin()) % arrays.size();
  }
  const auto found = std::find(arrays.begin(), arrays.end(), array);
  if (found != arrays.end()) return static_cast<std::size_t>(found - arrays.begin());
  constexpr std::size_t kMostNames = 50;
  std::string names;
  for (std::size_t i = 0; i < std::min(arrays.size(), kMostNames); ++i) {
    names += (i > 0 ? ", " : "") + files::in_quotes(arrays[i]);
  }
  const std::string which = array.empty() ? "name one" : "has no array " + files::in_quotes(array);
  return bad_input(file + ": " + which + ", as " + files::in_quotes(file + "#" + arrays.front()) +
                   "; it has: " + names);
}

/// The times that stand beside the array; none where there are none.
Result<std::vector<double>> times_in(ZipArchive& archive, const std::vector<std::string>& arrays,
                                     const std::string& file) {
  for (const TimeName& time : kTimeNames) {
    const auto found = std::ranges::find(arrays, time.name);
    if (found == arrays.end()) continue;
    const std::string place = file + "#" + time.name + ": ";
    if (const Status entered = archive.enter(static_cast<std::size_t>(found - arrays.begin())); !entered) {
      return bad_input(place + entered.error().message);
    }
    std::istream in(&archive);
    Result<std::vector<double>> numbers = files::read_npy_numbers(in);
    if (!numbers) return bad_input(place + numbers.error().message);
    numbers = files::seconds_of(*std::move(numbers), time.unit_s);
    return numbers ? std::move(numbers) : Result<std::vector<double>>(bad_input(place + numbers.error().message));
  }
  return std::vector<double>();
}

class Npz final : public FrameSource {
 public:
  /// `reader` reads from `archive`.
  Npz(std::unique_ptr<ZipArchive> archive, std::unique_ptr<files::NpyReader> reader, std::string name)
      : archive_(std::move(archive)), reader_(std::move(reader)), name_(std::move(name)) {}

  Result<bool> next(RawFrame& frame) override {
    Result<bool> more = reader_->next(frame);
    if (archive_->is_bad()) return files::read_failure(name_);
    if ((!more || !*more) && !archive_->damage().empty()) {
      return bad_input(name_ + ": is damaged: " + archive_->damage() + "; save it again");
    }
    return more;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return reader_->shape(); }

 private:
  std::unique_ptr<ZipArchive> archive_;
  std::unique_ptr<files::NpyReader> reader_;
  std::string name_;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> open_npz(std::unique_ptr<std::istream> in, const std::string& name,
                                              const ImportOptions& options) {
  Result<std::unique_ptr<ZipArchive>> opened = ZipArchive::open(std::move(in), name);
  if (!opened) return opened.error();
  std::unique_ptr<ZipArchive> archive = *std::move(opened);
  std::vector<std::string> arrays = archive->entries();
  std::transform(arrays.begin(), arrays.end(), arrays.begin(), array_name);
  const files::ArrayChoice choice = files::array_choice(options.array);
  const Result<std::size_t> chosen = choose(arrays, name, choice.name);
  if (!chosen) return chosen.error();
  files::NpyInput input{options.rate_hz.value_or(0.0), options.shape, choice.axes};
  if (!options.rate_hz) {
    Result<std::vector<double>> times = times_in(*archive, arrays, name);
    if (archive->is_bad()) return files::read_failure(name);
    if (!times) return times.error();
    if (times->empty()) return no_times(name);
    input.seconds = *std::move(times);
  }
  const Status entered = archive->enter(*chosen);
  if (archive->is_bad()) return files::read_failure(name);
  if (!entered) return bad_input(name + ": " + entered.error().message);
  const std::string place = arrays.size() > 1 ? name + "#" + arrays[*chosen] : name;
  Result<std::unique_ptr<files::NpyReader>> reader =
      files::NpyReader::open(std::make_unique<std::istream>(archive.get()), place, input);
  if (!reader) return reader.error();
  return std::unique_ptr<FrameSource>(std::make_unique<Npz>(std::move(archive), *std::move(reader), place));
}

}  // namespace dermis::bytes::formats
