// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/format_rows.hpp"

#include <algorithm>
#include <utility>

#include "bytes/recordings/described_sensors.hpp"
#include "bytes/recordings/hdf5_plugin.hpp"
#include "dermis/bytes/files/array_frames.hpp"
#include "dermis/bytes/files/file_kind.hpp"
#include "dermis/bytes/files/frames_csv.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/npy.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/formats/imports.hpp"
#include "dermis/bytes/formats/matlab.hpp"
#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::recordings {
namespace {

using Source = Result<std::unique_ptr<FrameSource>>;
using Sink = Result<std::unique_ptr<FrameSink>>;

template <typename Interface, typename Opened>
Result<std::unique_ptr<Interface>> as(Result<std::unique_ptr<Opened>> opened) {
  if (!opened) return opened.error();
  return std::unique_ptr<Interface>(*std::move(opened));
}

formats::ImportOptions import_options(const std::string& path, const FrameFileInput& input) {
  return {input.shape, input.rate_hz, recording_place(path).array, input.notice, input.loss};
}

/// A file of another system, read as a stream.
template <auto Open>
Source imported(const std::string& path, const FrameFileInput& input) {
  const std::string file = recording_place(path).path;
  Result<std::unique_ptr<std::istream>> in = files::open_input(file);
  if (!in) return in.error();
  return Open(*std::move(in), file, import_options(path, input));
}

Source open_csv(const std::string& path, const FrameFileInput& input) {
  return as<FrameSource>(files::FramesCsvReader::open(path, input.shape, input.loss));
}

Sink create_csv(const std::string& path, FrameShape shape, const FrameNotes& notes) {
  return as<FrameSink>(files::FramesCsvWriter::create(path, shape, {.sensors = described_sensors(notes)}));
}

Source open_npy(const std::string& path, const FrameFileInput& input) {
  const RecordingPlace place = recording_place(path);
  return as<FrameSource>(
      files::NpyReader::open(place.path, {*input.rate_hz, input.shape, files::array_choice(place.array).axes}));
}

Sink create_npy(const std::string& path, FrameShape shape, const FrameNotes&) {
  return as<FrameSink>(files::NpyWriter::create(path, shape));
}

/// Messages without dimensions are one row of numbers: rows and columns that were told.
class Folded final : public FrameSource {
 public:
  Folded(std::unique_ptr<FrameSource> frames, FrameShape shape) : frames_(std::move(frames)), shape_(shape) {}

  Result<bool> next(RawFrame& frame) override { return frames_->next(frame); }
  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_; }
  [[nodiscard]] SourceStatistics statistics() const override { return frames_->statistics(); }

 private:
  std::unique_ptr<FrameSource> frames_;
  FrameShape shape_;
};

Source open_mcap(const std::string& path, const FrameFileInput& input) {
  const RecordingPlace place = recording_place(path);
  auto reader = RecordingReader::open(place.path, place.array);
  const std::optional<FrameShape> found = reader ? (*reader)->shape() : std::nullopt;
  if (found && !input.shape && found->cols > kMaxLines) {
    return bad_input(path + ": has frames of " + std::to_string(found->cols) + " numbers; say how many rows and cols");
  }
  if (!found || !input.shape || *found == *input.shape) return as<FrameSource>(std::move(reader));
  if (found->rows == 1 && found->cols == input.shape->taxel_count()) {
    return std::unique_ptr<FrameSource>(std::make_unique<Folded>(*std::move(reader), *input.shape));
  }
  return bad_input(path + ": has " + files::size_text(*found) + " taxels, the array is " +
                   files::size_text(*input.shape));
}

Sink create_mcap(const std::string& path, FrameShape shape, const FrameNotes& notes) {
  RecordingOptions options;
  if (!notes.name.empty()) options.name = notes.name;
  options.array_toml = notes.array_toml;
  options.model_hash = notes.model_hash;
  options.simulation = notes.simulation;
  options.model_file = notes.model_file;
  options.live = false;
  return as<FrameSink>(RecordingWriter::create(path, shape, options));
}

Source open_hdf5(const std::string& path, const FrameFileInput& input) {
  return as<FrameSource>(by_hdf5(&Hdf5Plugin::open_frames, path, input.shape));
}

Sink create_hdf5(const std::string& path, FrameShape shape, const FrameNotes& notes) {
  return by_hdf5(&Hdf5Plugin::create_frames, path, shape, notes);
}

Source open_wiresens(const std::string& path, const FrameFileInput& input) {
  return by_hdf5(&Hdf5Plugin::open_wiresens, path, input.shape);
}

Sink create_wiresens(const std::string& path, FrameShape shape, const FrameNotes&) {
  return by_hdf5(&Hdf5Plugin::create_wiresens, path, shape);
}

Source open_hdf5_dataset(const std::string& path, const FrameFileInput& input) {
  const RecordingPlace place = recording_place(path);
  return by_hdf5(&Hdf5Plugin::open_dataset, place.path, place.array, input.shape, input.rate_hz);
}

/// A file of MATLAB 7.3, which is HDF5.
bool is_matlab_hdf5(const std::string& path) {
  constexpr std::string_view kBeginning = "MATLAB 7.3";
  return files::first_bytes_of(path, kBeginning.size()) == kBeginning;
}

Source open_mat(const std::string& path, const FrameFileInput& input) {
  const std::string name = recording_place(path).path;
  constexpr Source (*kOpen)(std::unique_ptr<std::istream>, const std::string&, const formats::ImportOptions&) =
      formats::open_matlab;
  if (!is_matlab_hdf5(name)) return imported<kOpen>(path, input);
  const Result<std::unique_ptr<formats::MatlabFile>> file = by_hdf5(&Hdf5Plugin::open_matlab, name);
  if (!file) return file.error();
  return formats::open_matlab(**file, name, import_options(path, input));
}

Source open_pictures(const std::string& path, const FrameFileInput& input) {
  return formats::open_png_stack(recording_place(path).path, import_options(path, input));
}

}  // namespace

const std::vector<FormatRow>& format_rows() {
  using enum FrameFormat;
  using enum Times;
  using enum Holds;
  static const std::vector<FormatRow> kRows = {
      {csv, "frames.csv", {".csv"}, {}, {}, always, temperatures, open_csv, create_csv},
      {mcap, "MCAP", {".mcap"}, files::kMcapKind, {}, always, all, open_mcap, create_mcap},
      {wiresens,
       "WiReSens HDF5",
       {".wiresens.h5", ".wiresens.hdf5"},
       files::kHdf5Kind,
       {},
       always,
       counts,
       open_wiresens,
       create_wiresens},
      {hdf5, "HDF5", {".h5", ".hdf5"}, files::kHdf5Kind, {}, always, all, open_hdf5, create_hdf5},
      {npy, "NumPy", {".npy"}, files::kNpyKind, {}, never, counts, open_npy, create_npy},
      {npz, "NumPy archive", {".npz"}, files::kZipKind, {}, sometimes, counts, imported<formats::open_npz>},
      {dsa, "Weiss DSA", {".dsa", ".dsa3"}, {}, {}, always, counts, imported<formats::open_dsa>},
      {tekscan,
       "Tekscan ASCII",
       {".asf"},
       files::kTableKind,
       {"DATA_TYPE"},
       always,
       counts,
       imported<formats::open_tekscan>},
      {xsensor, "XSENSOR ASCII", {}, {}, {"File:", "FRAME"}, always, counts, imported<formats::open_xsensor>},
      {novel_lst, "novel listing", {".lst"}, files::kTableKind, {}, always, counts, imported<formats::open_novel_lst>},
      {novel_asc, "novel ASCII", {".asc"}, files::kTableKind, {}, always, counts, imported<formats::open_novel_asc>},
      {matlab, "MATLAB", {".mat"}, {}, {}, sometimes, counts, open_mat},
      {text_matrix, "text matrix", {".txt"}, files::kTableKind, {}, never, counts, imported<formats::open_text_matrix>},
      {png_stack, "PNG", {".png"}, {}, {}, never, counts, open_pictures},
      {packed10, "packed 10 bits", {".packed10"}, {}, {}, never, counts, imported<formats::open_packed10>},
      {hdf5_dataset, "HDF5 dataset", {}, {}, {}, sometimes, counts, open_hdf5_dataset},
  };
  return kRows;
}

const FormatRow& row_of(FrameFormat format) {
  return *std::ranges::find(format_rows(), format, &FormatRow::format);
}

}  // namespace dermis::bytes::recordings
