// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/dataset.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <type_traits>
#include <utility>

#include "dermis/bytes/files/npy.hpp"
#include "dermis/bytes/files/text.hpp"
#include "learn/recognition/names.hpp"

namespace dermis::learn::recognition {
namespace {

using bytes::files::CsvTable;

/// Places of columns; keeps the first error.
class Columns {
 public:
  explicit Columns(const CsvTable& table) : table_(table) {}

  std::size_t needed(const std::string& name) {
    const Result<std::size_t> place = table_.needed_column(name);
    if (place) return *place;
    if (!first_error_) first_error_ = place.error();
    return 0;
  }
  [[nodiscard]] const std::optional<Error>& first_error() const { return first_error_; }

 private:
  const CsvTable& table_;
  std::optional<Error> first_error_;
};

/// The value, or nothing; keeps the first error.
template <typename T>
T value_or_none(const Result<T>& value, std::optional<Error>& first_error) {
  if (value) return *value;
  if (!first_error) first_error = value.error();
  return T{};
}

/// Which of the recordings each line of the labels is of.
Result<std::vector<std::size_t>> recordings_of(const CsvTable& table, const std::vector<ForceRecording>& recordings) {
  std::vector<std::size_t> places(table.rows(), 0);
  if (recordings.size() == 1 && !table.column("recording")) return places;
  const Result<std::size_t> column = table.needed_column("recording");
  if (!column) return column.error();
  std::string names;
  for (const ForceRecording& recording : recordings) names += (names.empty() ? "" : ", ") + recording.name;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& name = table.at(row, *column);
    const auto found = std::find_if(recordings.begin(), recordings.end(),
                                    [&](const ForceRecording& recording) { return recording.name == name; });
    if (found == recordings.end()) {
      return table.error(row,
                         "there is no recording " + bytes::files::in_quotes(name) + " among those given: " + names);
    }
    places[row] = static_cast<std::size_t>(found - recordings.begin());
  }
  return places;
}

/// The errors in the labels of one recording, or in its frames.
Status check_recording(const LabelledFrames& data, const ForceRecording& recording) {
  if (Status checked = data.check_labels(); !checked) return checked;
  for (const Label& label : data.labels) {
    if (label.first >= recording.tare_frames) continue;
    return bad_input("label '" + label.id + "' begins at frame " + std::to_string(label.first) + "; the first " +
                     std::to_string(recording.tare_frames) + " frames are the tare, during which nothing may touch");
  }
  return data.check_frames();
}

/// `part`, which stands behind `data`.
void append(LabelledFrames& data, LabelledFrames part) {
  const std::size_t before = data.frame_count();
  data.frames.insert(data.frames.end(), part.frames.begin(), part.frames.end());
  data.extras.insert(data.extras.end(), part.extras.begin(), part.extras.end());
  for (Label& label : part.labels) {
    label.first += before;
    label.last += before;
    data.labels.push_back(std::move(label));
  }
}

/// parse(table)
template <typename Parse>
auto read_table(const std::string& path, const Parse& parse) -> std::invoke_result_t<Parse, const CsvTable&> {
  const Result<CsvTable> table = CsvTable::read(path);
  if (!table) return table.error();
  return parse(*table);
}

/// Lines of a table by the name of their split, in order.
class SplitReader {
 public:
  SplitReader(const CsvTable& table, const std::vector<Label>& labels) : table_(table) {
    for (std::size_t place = 0; place < labels.size(); ++place) places_[labels[place].id] = place;
  }

  /// visit(split, row, label)
  [[nodiscard]] Status read(const std::function<Status(Split&, std::size_t, std::size_t)>& visit) {
    Columns columns(table_);
    const std::size_t split = columns.needed("split");
    const std::size_t id = columns.needed("id");
    if (columns.first_error()) return *columns.first_error();
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      const auto place = places_.find(table_.at(row, id));
      if (place == places_.end()) {
        return table_.error(row, "id " + bytes::files::in_quotes(table_.at(row, id)) + " is not among the labels");
      }
      const auto [known, is_new] = of_name_.try_emplace(table_.at(row, split), splits_.size());
      if (is_new) splits_.push_back({table_.at(row, split), {}, {}});
      if (Status visited = visit(splits_[known->second], row, place->second); !visited) return visited;
    }
    if (splits_.empty()) return table_.error("names no split");
    return Done{};
  }

  [[nodiscard]] std::vector<Split>& splits() { return splits_; }

 private:
  const CsvTable& table_;
  std::map<std::string, std::size_t> places_;   // of the labels
  std::map<std::string, std::size_t> of_name_;  // place of each split
  std::vector<Split> splits_;
};

void teach_all_others(Split& split, std::size_t label_count) {
  std::vector<bool> is_asked(label_count, false);
  for (const std::size_t label : split.asked) is_asked[label] = true;
  for (std::size_t label = 0; label < label_count; ++label) {
    if (!is_asked[label]) split.taught.push_back(label);
  }
}

}  // namespace

Result<std::vector<SensedArray>> arrays_of(const CsvTable& table) {
  Columns columns(table);
  const std::size_t name = columns.needed("array");
  const std::size_t rows = columns.needed("rows");
  const std::size_t cols = columns.needed("cols");
  const std::size_t first_column = columns.needed("first_column");
  if (columns.first_error()) return *columns.first_error();
  const std::optional<std::size_t> row_pitch = table.column("row_pitch_mm");
  const std::optional<std::size_t> col_pitch = table.column("col_pitch_mm");
  std::vector<SensedArray> arrays;
  std::optional<Error> error;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    SensedArray array{.name = table.at(row, name),
                      .rows = value_or_none(table.count_at(row, rows), error),
                      .cols = value_or_none(table.count_at(row, cols), error),
                      .first_column = value_or_none(table.count_at(row, first_column), error)};
    if (row_pitch) array.row_pitch_mm = value_or_none(table.number_at(row, *row_pitch), error);
    if (col_pitch) array.col_pitch_mm = value_or_none(table.number_at(row, *col_pitch), error);
    arrays.push_back(std::move(array));
  }
  if (error) return *error;
  return arrays;
}

Result<std::vector<Label>> labels_of(const CsvTable& table, const std::string& label) {
  Columns columns(table);
  const std::size_t id = columns.needed("id");
  const std::size_t first = columns.needed("first");
  const std::size_t last = columns.needed("last");
  const std::size_t name = columns.needed(label);
  if (columns.first_error()) return *columns.first_error();
  const std::optional<std::size_t> subject = table.column("subject");
  const std::optional<std::size_t> session = table.column("session");
  const std::optional<std::size_t> order = table.column("order");
  std::vector<Label> labels;
  std::optional<Error> error;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Label read{.id = table.at(row, id),
               .first = value_or_none(table.count_at(row, first), error),
               .last = value_or_none(table.count_at(row, last), error),
               .name = table.at(row, name)};
    const Status named = check_class_name(read.name);
    if (!named && !error) error = table.error(row, named.error().message);
    if (const auto group = subject ? subject : session) read.group = table.at(row, *group);
    read.order = order ? value_or_none(table.number_at(row, *order), error) : static_cast<double>(read.first);
    labels.push_back(std::move(read));
  }
  if (error) return *error;
  return labels;
}

Result<LabelledFrames> read_dataset(const DatasetFiles& files) {
  LabelledFrames data;
  Result<std::vector<SensedArray>> arrays = read_table(files.arrays, arrays_of);
  if (!arrays) return arrays.error();
  Result<std::vector<Label>> labels =
      read_table(files.labels, [&](const CsvTable& table) { return labels_of(table, files.label); });
  if (!labels) return labels.error();
  Result<bytes::files::NpyTable> frames = bytes::files::read_npy_table(files.frames);
  if (!frames) return frames.error();
  data.layout.arrays = *std::move(arrays);
  data.layout.readings = frames->cols;
  data.layout.rate_hz = files.rate_hz;
  data.frames = std::move(frames->values);
  data.labels = *std::move(labels);
  if (const Status checked = data.layout.validate(); !checked) {
    return bad_input(files.arrays + ": " + checked.error().message);
  }
  if (!files.extras.empty()) {
    Result<bytes::files::NpyTable> extras = bytes::files::read_npy_table(files.extras);
    if (!extras) return extras.error();
    if (extras->rows != frames->rows) {
      return bad_input(files.extras + ": has " + std::to_string(extras->rows) + " lines, " + files.frames + " " +
                       std::to_string(frames->rows) + " frames");
    }
    data.layout.extras = extras->cols;
    data.extras = std::move(extras->values);
  }
  if (const Status checked = data.check_labels(); !checked) {
    return bad_input(files.labels + ": " + checked.error().message);
  }
  if (const Status checked = data.check_frames(); !checked) {
    return bad_input(files.frames + ": " + checked.error().message);
  }
  if (const Status checked = data.check_extras(); !checked) {
    return bad_input(files.extras + ": " + checked.error().message);
  }
  return data;
}

Result<LabelledFrames> label_recordings(const Layout& layout, std::vector<ForceRecording> recordings,
                                        const std::string& labels, const std::string& label) {
  if (const Status checked = layout.validate(); !checked) return checked.error();
  const Result<CsvTable> table = CsvTable::read(labels);
  if (!table) return table.error();
  const Result<std::vector<Label>> read = labels_of(*table, label);
  if (!read) return read.error();
  const Result<std::vector<std::size_t>> places = recordings_of(*table, recordings);
  if (!places) return places.error();
  const bool names_groups = table->column("subject") || table->column("session");
  const bool names_order = table->column("order").has_value();
  LabelledFrames data{layout, {}, {}, {}};
  for (std::size_t place = 0; place < recordings.size(); ++place) {
    ForceRecording& recording = recordings[place];
    LabelledFrames part{layout, std::move(recording.frames), std::move(recording.extras), {}};
    for (std::size_t row = 0; row < read->size(); ++row) {
      if ((*places)[row] != place) continue;
      part.labels.push_back((*read)[row]);
      if (!names_groups && recordings.size() > 1) part.labels.back().group = recording.name;
      if (!names_order) part.labels.back().order += static_cast<double>(data.frame_count());
    }
    if (const Status checked = check_recording(part, recording); !checked) {
      return bad_input(labels + ": " + recording.name + ": " + checked.error().message);
    }
    append(data, std::move(part));
  }
  if (const Status checked = data.validate(); !checked) return bad_input(labels + ": " + checked.error().message);
  return data;
}

Result<std::vector<Split>> splits_of(const CsvTable& table, const std::vector<Label>& labels) {
  SplitReader reader(table, labels);
  const Status read = reader.read([](Split& split, std::size_t, std::size_t label) -> Status {
    split.asked.push_back(label);
    return Done{};
  });
  if (!read) return read.error();
  for (Split& split : reader.splits()) teach_all_others(split, labels.size());
  return std::move(reader.splits());
}

Result<std::vector<Split>> read_splits(const std::string& path, const std::vector<Label>& labels) {
  return read_table(path, [&](const CsvTable& table) { return splits_of(table, labels); });
}

Result<std::vector<Split>> open_splits_of(const CsvTable& table, const std::vector<Label>& labels) {
  const Result<std::size_t> role_column = table.needed_column("role");
  if (!role_column) return role_column.error();
  SplitReader reader(table, labels);
  std::set<std::pair<std::string, std::size_t>> seen;  // splits and labels
  const Status read = reader.read([&](Split& split, std::size_t row, std::size_t label) -> Status {
    if (!seen.emplace(split.name, label).second) {
      return table.error(row, "id " + bytes::files::in_quotes(labels[label].id) + " stands twice in split " +
                                  bytes::files::in_quotes(split.name) + "; an example is learned from or answered for");
    }
    const std::string& role = table.at(row, *role_column);
    const bool is_asked = role == "known" || role == "unknown";
    if (!is_asked && role != "train") {
      return table.error(row, "role " + bytes::files::in_quotes(role) + " is unknown; write train, known or unknown");
    }
    (is_asked ? split.asked : split.taught).push_back(label);
    return Done{};
  });
  if (!read) return read.error();
  return std::move(reader.splits());
}

Result<std::vector<Split>> read_open_splits(const std::string& path, const std::vector<Label>& labels) {
  return read_table(path, [&](const CsvTable& table) { return open_splits_of(table, labels); });
}

}  // namespace dermis::learn::recognition
