// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "bytes/recordings/bag_folder.hpp"
#include "bytes/recordings/format_rows.hpp"
#include "bytes/recordings/hdf5_plugin.hpp"
#include "dermis/bytes/files/file_kind.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr const char* kWritten = ".csv, .mcap, .h5, .hdf5, .wiresens.h5, .wiresens.hdf5 and .npy";

/// A pipe, a terminal; the standard input and output, also where a shell leads them to a file.
bool is_stream(const std::string& path) {
  if (path == "/dev/stdin" || path == "/dev/stdout") return true;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  return std::filesystem::is_fifo(status) || std::filesystem::is_character_file(status);
}

/// Which of the HDF5 formats a file has, by its datasets.
Result<FrameFormat> hdf5_format(const std::string& path) {
  const Result<Hdf5Contents> found = by_hdf5(&Hdf5Plugin::contents, path);
  if (!found) return found.error();
  if (found->has_frames) return FrameFormat::hdf5;
  if (found->has_wiresens) return FrameFormat::wiresens;
  return bad_input(path + ": has neither the dataset 'counts' (dermis) nor 'pressure' and 'frame_count' (WiReSens): " +
                   "name one, as " + files::in_quotes(path + "#/observations/tactile") + found->datasets);
}

/// Files of others that this library does not read, and the way out.
struct Elsewhere {
  std::string_view ending;
  std::string_view mend;
};
constexpr std::string_view kInPython = "is read by the Python package: dermis.Recording.read()";
constexpr std::string_view kPickle =
    "is a pickle, which may run any program when it is read; save its numbers by numpy.save";
constexpr std::string_view kRosBag =
    "is a bag that is no MCAP; make it one by rosbags-convert of PyPI (docs/recordings.md)";
constexpr std::array<Elsewhere, 6> kElsewhere{{{".parquet", kInPython},
                                               {".zarr", kInPython},
                                               {".pkl", kPickle},
                                               {".pickle", kPickle},
                                               {".bag", kRosBag},
                                               {".db3", kRosBag}}};

std::string_view read_elsewhere(std::string_view name) {
  while (name.ends_with('/')) name.remove_suffix(1);
  const auto* const found =
      std::ranges::find_if(kElsewhere, [&](const Elsewhere& one) { return name.ends_with(one.ending); });
  return found == kElsewhere.end() ? std::string_view() : found->mend;
}

/// A folder that 'dermis simulate' has written.
bool was_simulated(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::exists(folder / "origin.toml", ignored) &&
         std::filesystem::exists(folder / "frames.csv", ignored);
}

/// The first bytes of a file that can be read from its beginning again; else nothing.
std::string first_bytes(const std::string& path) {
  constexpr std::size_t kLooked = 4096;
  return files::first_bytes_of(path, kLooked);
}

/// The first word of a text, without quotes.
std::string first_word(std::string text) {
  constexpr std::string_view kBetween = " \t\r\n\",;";
  if (text.starts_with(files::kByteOrderMark)) text.erase(0, files::kByteOrderMark.size());
  const std::size_t begin = std::min(text.find_first_not_of(kBetween), text.size());
  return text.substr(begin, std::min(text.find_first_of(kBetween, begin), text.size()) - begin);
}

/// Exports of several systems have the endings .csv and .txt.
FrameFormat text_format(const std::string& path, FrameFormat by_name) {
  const std::string word = first_word(first_bytes(path));
  const auto begins_so = [&](const FormatRow& row) {
    return std::ranges::find(row.first_words, word) != row.first_words.end();
  };
  const auto found = std::ranges::find_if(format_rows(), begins_so);
  if (found != format_rows().end()) return found->format;
  double number = 0.0;
  return files::parse_number(word, number) ? FrameFormat::text_matrix : by_name;
}

}  // namespace

const char* to_string(FrameFormat format) {
  return row_of(format).name;
}

bool has_times(FrameFormat format) {
  return row_of(format).times == Times::always;
}

bool may_have_times(FrameFormat format) {
  return row_of(format).times == Times::sometimes;
}

Result<FrameFormat> frame_format(const std::string& path) {
  const std::string name = files::in_lower_case(path);
  const auto ends_so = [&](const FormatRow& row) {
    return std::ranges::any_of(row.endings, [&](std::string_view ending) { return name.ends_with(ending); });
  };
  const auto found = std::ranges::find_if(format_rows(), ends_so);
  if (found != format_rows().end()) return found->format;
  if (is_stream(path)) return FrameFormat::csv;
  std::error_code ignored;
  const bool is_folder = std::filesystem::is_directory(path, ignored);
  if (const std::optional<BagFolder> bag = is_folder ? bag_folder(path) : std::nullopt) {
    if (!bag->file.empty()) return FrameFormat::mcap;
    return bad_input(path + ": " + bag->objection);
  }
  if (is_folder && read_elsewhere(name).empty()) return FrameFormat::png_stack;
  if (const std::string_view other = read_elsewhere(name); !other.empty()) {
    return bad_input(path + ": " + std::string(other));
  }
  return bad_input(files::in_quotes(path) + ": the ending of its name tells no format of frames; known: " + kWritten +
                   ", and to read .npz, .dsa, .dsa3, .asf, .lst, .asc, .mat, .txt, .png and .packed10");
}

Result<FrameFormat> output_format(const std::string& path) {
  Result<FrameFormat> format = frame_format(path);
  if (!format || row_of(*format).create != nullptr) return format;
  return bad_input(files::in_quotes(path) + ": files of this ending are only read; to write, there are " + kWritten);
}

Result<FrameFormat> recognise_frames(const std::string& path) {
  const RecordingPlace place = recording_place(path);
  Result<FrameFormat> format = frame_format(place.path);
  if (!format) return format;
  if (was_simulated(place.path)) {
    return bad_input(place.path + ": is a folder; name " + (std::filesystem::path(place.path) / "frames.csv").string());
  }
  if (const std::string_view kind = row_of(*format).kind; !kind.empty()) {
    if (const auto other = files::wrong_kind(first_bytes(place.path), kind))
      return bad_input(place.path + ": " + *other);
  }
  if (*format == FrameFormat::hdf5 || *format == FrameFormat::wiresens) {
    return place.array.empty() ? hdf5_format(place.path) : FrameFormat::hdf5_dataset;
  }
  if (*format == FrameFormat::csv || *format == FrameFormat::text_matrix) return text_format(place.path, *format);
  return format;
}

}  // namespace dermis::bytes::recordings
