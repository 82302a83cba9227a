// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/publishing/kept_models.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/models/model_fit.hpp"
#include "dermis/live/fleet/model_store.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

namespace dermis::out::serve {
namespace {

namespace filesystem = std::filesystem;

constexpr const char* kModelEnding = ".safetensors";
constexpr std::size_t kMostOfManifest = 65536;

Status write_file(const filesystem::path& path, std::string_view bytes) {
  std::error_code error;
  filesystem::create_directories(path.parent_path(), error);
  if (error) return failed(fmt::format("{}: {}", path.parent_path().string(), error.message()));
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(path.string());
  if (!file) return file.error();
  file->write(bytes);
  return file->commit();
}

/// In what a model does not fit its array; empty: it fits. A calibration may have found the circuit of an array that
/// was described without one.
std::string difference(const ArrayDescription& array, const ArrayDescription& of_model) {
  const Circuit circuit = array.readout.circuit;
  std::string why = bytes::models::misfit(array, of_model);
  if (!why.empty() || circuit == Circuit::automatic || circuit == of_model.readout.circuit) return why;
  return fmt::format("it is of the circuit {}, the array of {}", to_string(of_model.readout.circuit),
                     to_string(circuit));
}

}  // namespace

KeptModels::KeptModels(filesystem::path folder, ArrayDescription array)
    : folder_(std::move(folder)), array_(std::move(array)) {}

filesystem::path KeptModels::manifest_path() const {
  return folder_ / "current.json";
}

filesystem::path KeptModels::path_of(const live::fleet::PushedModel& model) const {
  return folder_ / (model.sha256 + kModelEnding);
}

Result<std::optional<live::fleet::ModelManifest>> KeptModels::manifest() const {
  std::error_code error;
  if (!filesystem::exists(manifest_path(), error)) return std::optional<live::fleet::ModelManifest>();
  const Result<std::string> text = bytes::files::read_file(manifest_path().string(), kMostOfManifest);
  if (!text) return text.error();
  Result<live::fleet::ModelManifest> manifest = live::fleet::manifest_from_json(*text);
  if (!manifest) return bad_input(manifest_path().string() + ": " + manifest.error().message);
  return std::optional(*std::move(manifest));
}

Status KeptModels::write(const live::fleet::PushedModel& model, std::string_view bytes) const {
  return write_file(path_of(model), bytes);
}

Result<std::shared_ptr<const touch::pipeline::Model>> KeptModels::read(const live::fleet::PushedModel& model) const {
  const std::string path = path_of(model).string();
  const Result<std::string> bytes = bytes::files::read_file(path, live::fleet::ModelManifest::kMostBytes);
  if (!bytes) return bytes.error();
  const Result<std::string> hash = live::fleet::sha256(*bytes);
  if (!hash) return hash.error();
  if (*hash != model.sha256) return bad_input(path + ": its SHA-256 is wrong");
  Result<touch::pipeline::Model> read = bytes::models::read_model(path);
  if (!read) return read.error();
  if (const std::string why = difference(array_, read->array); !why.empty()) return bad_input(why);
  if (const auto works = touch::pipeline::Pipeline::create(*read); !works) return bad_input(works.error().message);
  return std::make_shared<const touch::pipeline::Model>(*std::move(read));
}

void KeptModels::remove(const live::fleet::PushedModel& model) const {
  std::error_code error;
  filesystem::remove(path_of(model), error);
}

Status KeptModels::use(const live::fleet::ModelManifest& manifest) const {
  std::error_code error;
  filesystem::last_write_time(path_of(manifest.current_model()), filesystem::file_time_type::clock::now(), error);
  remove_old();  // first: a process that is killed between the two leaves no eleventh
  return write_file(manifest_path(), live::fleet::manifest_to_json(manifest));
}

void KeptModels::remove_old() const {
  std::error_code error;
  std::vector<std::pair<filesystem::file_time_type, filesystem::path>> models;
  for (filesystem::directory_iterator file(folder_, error), end; !error && file != end; file.increment(error)) {
    if (file->path().extension() == kModelEnding) models.emplace_back(file->last_write_time(error), file->path());
  }
  std::sort(models.rbegin(), models.rend());
  for (std::size_t k = kMost; k < models.size(); ++k) filesystem::remove(models[k].second, error);
}

}  // namespace dermis::out::serve
