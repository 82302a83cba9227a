// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/classes_file.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::learn::recognition {
namespace {

using bytes::files::SafetensorsFile;
using bytes::files::TensorReader;
using Json = nlohmann::json;
using Shape = std::vector<std::size_t>;

constexpr std::size_t kMostColumns = 65536;
constexpr std::array kQuantities{"counts", "pressure", "force"};  // in the order of Quantity

Json to_json(const Layout& layout) {
  Json arrays = Json::array();
  for (const SensedArray& array : layout.arrays) {
    arrays.push_back({{"name", array.name},
                      {"rows", array.rows},
                      {"cols", array.cols},
                      {"first_column", array.first_column},
                      {"row_pitch_mm", array.row_pitch_mm},
                      {"col_pitch_mm", array.col_pitch_mm}});
  }
  return {{"arrays", arrays},
          {"readings", layout.readings},
          {"extras", layout.extras},
          {"rate_hz", layout.rate_hz},
          {"quantity", kQuantities.at(static_cast<std::size_t>(layout.quantity))},
          {"least_reading", layout.least_reading()}};  // by which readers before `quantity` know forces
}

/// Takes values out of JSON objects; remembers whether one was missing or of another type.
class JsonReader {
 public:
  std::size_t count(const Json& object, const char* key) {
    const Json* const value = find(object, key);
    if (value != nullptr && value->is_number_unsigned()) return value->get<std::size_t>();
    is_good_ = false;
    return 0;
  }

  double number(const Json& object, const char* key) {
    const Json* const value = find(object, key);
    if (value != nullptr && value->is_number()) return value->get<double>();
    is_good_ = false;
    return 0.0;
  }

  std::string text(const Json& object, const char* key) {
    const Json* const value = find(object, key);
    return text(value != nullptr ? *value : Json());
  }

  std::string text(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    is_good_ = false;
    return {};
  }

  /// The place of a text among `names`.
  std::size_t choice(const Json& object, const char* key, std::span<const char* const> names) {
    const auto found = std::find(names.begin(), names.end(), text(object, key));
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    is_good_ = false;
    return 0;
  }

  /// Empty where there is no array.
  Json array(const Json& object, const char* key) {
    const Json* const value = find(object, key);
    if (value != nullptr && value->is_array()) return *value;
    is_good_ = false;
    return Json::array();
  }

  [[nodiscard]] bool is_good() const noexcept { return is_good_; }

 private:
  static const Json* find(const Json& object, const char* key) {
    const auto found = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && found != object.end() ? &*found : nullptr;
  }

  bool is_good_ = true;
};

/// Files before `quantity` show forces by the least reading that means anything.
Quantity quantity_from(const Json& json, JsonReader& reader) {
  const double least_reading = reader.number(json, "least_reading");
  if (!json.contains("quantity")) return least_reading == kLeastNewtons ? Quantity::force : Quantity::counts;
  return static_cast<Quantity>(reader.choice(json, "quantity", kQuantities));
}

Layout layout_from(const Json& json, JsonReader& reader) {
  Layout layout;
  for (const Json& array : reader.array(json, "arrays")) {
    layout.arrays.push_back({.name = reader.text(array, "name"),
                             .rows = reader.count(array, "rows"),
                             .cols = reader.count(array, "cols"),
                             .first_column = reader.count(array, "first_column"),
                             .row_pitch_mm = reader.number(array, "row_pitch_mm"),
                             .col_pitch_mm = reader.number(array, "col_pitch_mm")});
  }
  layout.readings = reader.count(json, "readings");
  layout.extras = reader.count(json, "extras");
  layout.rate_hz = reader.number(json, "rate_hz");
  layout.quantity = quantity_from(json, reader);
  return layout;
}

/// null where there are none.
Json to_json(const std::optional<TouchLimits>& touches) {
  if (!touches) return nullptr;
  return {{"onset", touches->onset},
          {"release_share", touches->release_share},
          {"gap_frames", touches->gap_frames},
          {"before_frames", touches->before_frames},
          {"after_frames", touches->after_frames}};
}

/// All but the tables.
Json description_of(const Classes& classes) {
  Json experts = Json::array();
  for (const Expert& expert : classes.experts) {
    experts.push_back({{"name", expert.name},
                       {"weight", expert.weight},
                       {"columns", expert.columns.size()},
                       {"rank", expert.rank},
                       {"unknown_weight", expert.unknown_weight},
                       {"distances", expert.distances.size()}});
    if (expert.centres.empty()) continue;
    experts.back()["width"] = expert.width;
    experts.back()["centres"] = expert.influences.size() / classes.names.size();
  }
  return {{"layout", to_json(classes.layout)},
          {"moving", classes.moving ? 1U : 0U},
          {"names", classes.names},
          {"doubts", classes.doubts.size()},
          {"doubt_weight", classes.doubt_weight},
          {"unknown_from", classes.unknown_from},
          {"touches", to_json(classes.touches)},
          {"experts", experts}};
}

TouchLimits touches_from(const Json& json, JsonReader& reader) {
  return {.onset = reader.number(json, "onset"),
          .release_share = reader.number(json, "release_share"),
          .gap_frames = reader.count(json, "gap_frames"),
          .before_frames = reader.count(json, "before_frames"),
          .after_frames = reader.count(json, "after_frames")};
}

std::string tensor_name(std::size_t expert, const char* table) {
  return "expert." + std::to_string(expert) + "." + table;
}

Expert expert_from(const Json& json, std::size_t place, std::size_t class_count, JsonReader& reader,
                   TensorReader& tensors) {
  Expert expert{.name = reader.text(json, "name"), .weight = reader.number(json, "weight")};
  const std::size_t columns = std::min(reader.count(json, "columns"), kMostColumns);
  const auto get = [&](const char* name, const Shape& shape, auto& values) {
    tensors.get(tensor_name(place, name), shape, values);
  };
  get("columns", {columns}, expert.columns);
  get("mean", {columns}, expert.mean);
  get("scale", {columns}, expert.scale);
  expert.rank = std::min(reader.count(json, "rank"), columns);
  expert.unknown_weight = reader.number(json, "unknown_weight");
  get("axes", {expert.rank, columns}, expert.axes);
  get("class_means", {class_count, expert.rank}, expert.class_means);
  get("distances", {reader.count(json, "distances")}, expert.distances);
  if (!json.contains("centres")) return expert;
  const std::size_t centres = reader.count(json, "centres");
  expert.width = reader.number(json, "width");
  get("centres", {centres, columns}, expert.centres);
  get("influences", {centres, class_count}, expert.influences);
  return expert;
}

Result<Classes> classes_from(const SafetensorsFile& file) {
  if (Status right = bytes::files::check_format(file, kClassesFormat); !right) return right.error();
  const auto description = file.metadata.find("classes");
  if (description == file.metadata.end()) return bad_input(kClassesFormat.otherwise);
  const Json json = Json::parse(description->second, nullptr, false);
  JsonReader reader;
  TensorReader tensors(file);
  Classes classes;
  classes.layout = layout_from(json.is_object() ? json.value("layout", Json()) : Json(), reader);
  classes.moving = reader.count(json, "moving") != 0;
  for (const Json& name : reader.array(json, "names")) classes.names.push_back(reader.text(name));
  classes.doubt_weight = reader.number(json, "doubt_weight");
  classes.unknown_from = reader.number(json, "unknown_from");
  const Json touches = json.is_object() ? json.value("touches", Json()) : Json();
  if (!touches.is_null()) classes.touches = touches_from(touches, reader);
  tensors.get("examples", {classes.names.size()}, classes.examples);
  tensors.get("doubts", {reader.count(json, "doubts")}, classes.doubts);
  for (const Json& expert : reader.array(json, "experts")) {
    classes.experts.push_back(expert_from(expert, classes.experts.size(), classes.names.size(), reader, tensors));
    if (!reader.is_good() || tensors.first_error()) break;
  }
  if (!reader.is_good()) return bad_input("its description of the classes is damaged; learn them again");
  if (tensors.first_error()) return *tensors.first_error();
  if (Status checked = classes.validate(); !checked) return checked.error();
  return classes;
}

}  // namespace

Status write_classes(const std::string& path, const Classes& classes) {
  if (const Status checked = classes.validate(); !checked) {
    return failed("cannot write " + bytes::files::in_quotes(path) + ": " + checked.error().message);
  }
  SafetensorsFile file;
  file.metadata["format"] = kClassesFormat.name;
  file.metadata["classes"] = description_of(classes).dump(-1, ' ', false, Json::error_handler_t::replace);
  put_tensor(file, "examples", {classes.examples.size()}, classes.examples);
  put_tensor(file, "doubts", {classes.doubts.size()}, classes.doubts);
  for (std::size_t place = 0; place < classes.experts.size(); ++place) {
    const Expert& expert = classes.experts[place];
    put_tensor(file, tensor_name(place, "columns"), {expert.columns.size()}, expert.columns);
    put_tensor(file, tensor_name(place, "mean"), {expert.mean.size()}, expert.mean);
    put_tensor(file, tensor_name(place, "scale"), {expert.scale.size()}, expert.scale);
    put_tensor(file, tensor_name(place, "axes"), {expert.rank, expert.columns.size()}, expert.axes);
    put_tensor(file, tensor_name(place, "class_means"), {classes.names.size(), expert.rank}, expert.class_means);
    put_tensor(file, tensor_name(place, "distances"), {expert.distances.size()}, expert.distances);
    if (expert.centres.empty()) continue;
    const std::size_t centres = expert.influences.size() / classes.names.size();
    put_tensor(file, tensor_name(place, "centres"), {centres, expert.columns.size()}, expert.centres);
    put_tensor(file, tensor_name(place, "influences"), {centres, classes.names.size()}, expert.influences);
  }
  return bytes::files::write_safetensors(path, file);
}

Result<Classes> read_classes(const std::string& path) {
  const Result<SafetensorsFile> file = bytes::files::read_safetensors(path);
  if (!file) return file.error();
  Result<Classes> classes = classes_from(*file);
  if (!classes) return bad_input(path + ": " + classes.error().message);
  return classes;
}

Result<Classes> classes_from_bytes(std::string_view bytes, const std::string& name) {
  const Result<SafetensorsFile> file = bytes::files::safetensors_from_bytes(bytes, name);
  if (!file) return file.error();
  Result<Classes> classes = classes_from(*file);
  if (!classes) return bad_input(name + ": " + classes.error().message);
  return classes;
}

}  // namespace dermis::learn::recognition
