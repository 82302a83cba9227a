// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/bytes/files/csv_table.hpp"
#include "dermis/learn/recognition/examples.hpp"
#include "dermis/touch/frames/result.hpp"

/// Labelled frames in plain files; docs/recognition.md describes them.
namespace dermis::learn::recognition {

struct DatasetFiles {
  std::string frames;           ///< frames.npy: [frames, readings]
  std::string arrays;           ///< arrays.csv: array,rows,cols,first_column
  std::string extras;           ///< extra.npy: [frames, extras]; empty where there is none.
  std::string labels;           ///< labels.csv: id,first,last,class
  std::string label = "class";  ///< The column of labels.csv that names the class.
  double rate_hz = 0.0;         ///< Frames a second; 0 where it is not known.
};

/// Read the tables of a data set, each by itself, without a check against the frames.
[[nodiscard]] Result<std::vector<SensedArray>> arrays_of(const bytes::files::CsvTable& table);
[[nodiscard]] Result<std::vector<Label>> labels_of(const bytes::files::CsvTable& table, const std::string& label);

/// Reads and validates. Errors name the file.
[[nodiscard]] Result<LabelledFrames> read_dataset(const DatasetFiles& files);

/// The frames of a recording, as loads.
struct ForceRecording {
  std::string name;             ///< The name in the column `recording` of labels.csv.
  std::vector<float> frames;    ///< [frames, readings]
  std::size_t tare_frames = 0;  ///< The first so many were taken for unloaded: they are no example.
  std::vector<float> extras{};  ///< [frames, extras]
};

/// The recordings one after the other, with their labels: `id,first,last,class,recording`, where frames count from 0 in
/// each recording. The column `recording` may be missing where there is one. Where the labels name neither subject nor
/// session, but several recordings, those are the groups. Validates; errors name the file of the labels.
[[nodiscard]] Result<LabelledFrames> label_recordings(const Layout& layout, std::vector<ForceRecording> recordings,
                                                      const std::string& labels, const std::string& label);

/// Labels by their place: those to learn from, and those to answer for.
struct Split {
  std::string name;
  std::vector<std::size_t> taught;
  std::vector<std::size_t> asked;
};

/// `split,id`: the ids to answer for; each split learns from all others. In the order of the file.
[[nodiscard]] Result<std::vector<Split>> read_splits(const std::string& path, const std::vector<Label>& labels);
[[nodiscard]] Result<std::vector<Split>> splits_of(const bytes::files::CsvTable& table,
                                                   const std::vector<Label>& labels);

/// `split,role,id`: role `train` is learned from, `known` and `unknown` are answered for; no
/// id stands twice in a split.
[[nodiscard]] Result<std::vector<Split>> read_open_splits(const std::string& path, const std::vector<Label>& labels);
[[nodiscard]] Result<std::vector<Split>> open_splits_of(const bytes::files::CsvTable& table,
                                                        const std::vector<Label>& labels);

}  // namespace dermis::learn::recognition
