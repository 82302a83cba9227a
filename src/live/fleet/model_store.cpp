// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/model_store.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "live/fleet/broker.hpp"
#include "live/fleet/json_values.hpp"
#include "live/fleet/streams.hpp"

namespace dermis::live::fleet {
namespace {

constexpr const char* kModels = "dermis-models";  // a stream, and the first part of its subjects
constexpr std::size_t kPieceBytes = 256U << 10U;  // a server takes messages of 1 MiB
constexpr std::size_t kPlaceOfSha256 = 3;         // in the parts of a piece's subject

std::string subjects_of(const std::string& robot, const std::string& array) {
  return std::string(kModels) + "." + robot + "." + array + ".";
}

std::string manifest_subject(const std::string& robot, const std::string& array) {
  return subjects_of(robot, array) + "current";
}

/// Pieces are named by the content, so pieces of two models never mix.
std::string piece_subject(const ModelManifest& manifest, const std::string& sha256, std::uint64_t piece) {
  return subjects_of(manifest.robot, manifest.array) + sha256 + "." + std::to_string(piece);
}

std::string part_of(const std::string& subject, std::size_t place) {
  std::size_t begin = 0;
  for (; place > 0; --place) {
    begin = subject.find('.', begin);
    if (begin == std::string::npos) return "";
    ++begin;
  }
  return subject.substr(begin, subject.find('.', begin) - begin);
}

Result<ModelManifest> manifest_of(std::string_view text, const std::string& robot, const std::string& array) {
  Result<ModelManifest> manifest = manifest_from_json(text);
  if (manifest && (manifest->robot != robot || manifest->array != array)) {
    return bad_input("a list of pushed models: is of " + manifest->robot + "/" + manifest->array);
  }
  return manifest;
}

Status check_names(const std::string& robot, const std::string& array) {
  if (Status good = check_name("robot", robot); !good) return good;
  return check_name("array", array);
}

}  // namespace

ModelStore::ModelStore(std::unique_ptr<Broker> broker) : broker_(std::move(broker)) {}

ModelStore::~ModelStore() = default;

Result<std::unique_ptr<ModelStore>> ModelStore::connect(const BrokerAddress& address) {
  Result<std::unique_ptr<Broker>> broker = connect_broker(address);
  if (!broker) return broker.error();
  return std::unique_ptr<ModelStore>(new ModelStore(*std::move(broker)));
}

/// The last message of a subject; empty where there is none. The server of a robot passes the question on to the hub.
/// A server alone has no domain and answers itself.
Result<std::string> ModelStore::read(const std::string& subject) {
  const std::string question = std::string(".API.DIRECT.GET.") + kModels + "." + subject;
  Result<std::string> answer = broker_->ask(std::string("$JS.") + kHubDomain + question, "");
  if (answer) return answer;
  return broker_->ask("$JS" + question, "");
}

Status ModelStore::store(const std::string& subject, std::string_view bytes) {
  const Result<std::uint64_t> stored =
      broker_->store(subject, "", std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
  return stored ? Status(Done{}) : Status(stored.error());
}

/// On the server of a robot, models would hide those of the hub.
Status ModelStore::prepare_hub() {
  const Result<std::string> domain = domain_of(*broker_);
  if (!domain) return domain.error();
  if (!domain->empty() && *domain != kHubDomain) {
    return bad_input("this is the server of robot '" + *domain + "'; models are pushed to the hub");
  }
  return make_log(*broker_, kModels, std::string(kModels) + ".>");
}

Result<std::optional<ModelManifest>> ModelStore::manifest(const std::string& robot, const std::string& array) {
  if (const Status good = check_names(robot, array); !good) return good.error();
  const Result<std::string> text = read(manifest_subject(robot, array));
  if (!text) return text.error();
  if (text->empty()) return std::optional<ModelManifest>();
  Result<ModelManifest> manifest = manifest_of(*text, robot, array);
  if (!manifest) return manifest.error();
  return std::optional(*std::move(manifest));
}

void ModelStore::stop() {
  broker_->stop();
}

Result<std::string> ModelStore::fetch(const ModelManifest& manifest) {
  const PushedModel& model = manifest.current_model();
  std::string bytes;
  for (std::uint64_t piece = 0; piece < model.pieces; ++piece) {
    const Result<std::string> part = read(piece_subject(manifest, model.sha256, piece));
    if (!part) return part.error();
    if (part->empty()) return bad_input("a piece of it is missing on the hub; push it again");
    if (part->size() > model.bytes - bytes.size()) return bad_input("its pieces are larger than it; push it again");
    bytes += *part;
  }
  const Result<std::string> hash = sha256(bytes);
  if (!hash) return hash.error();
  if (*hash != model.sha256) return bad_input("its SHA-256 is wrong; push it again");
  return bytes;
}

Result<ModelManifest> ModelStore::push(const std::string& robot, const std::string& array, const std::string& name,
                                       std::string_view bytes) {
  if (bytes.empty() || bytes.size() > ModelManifest::kMostBytes)
    return bad_input(name + ": a model has at most 256 MiB");
  if (const Status good = check_names(robot, array); !good) return good.error();
  if (const Status prepared = prepare_hub(); !prepared) return prepared.error();
  const Result<std::optional<ModelManifest>> present = manifest(robot, array);
  if (!present && present.error().kind != ErrorKind::bad_input) return present.error();
  const Result<std::string> hash = sha256(bytes);
  if (!hash) return hash.error();
  ModelManifest next{.robot = robot, .array = array};
  if (present && *present) next = **present;
  next.add({.name = name,
            .sha256 = *hash,
            .bytes = bytes.size(),
            .pieces = (bytes.size() + kPieceBytes - 1) / kPieceBytes,
            .time = std::chrono::system_clock::now().time_since_epoch()});
  if (const auto read = manifest_from_json(manifest_to_json(next)); !read) return read.error();
  for (std::uint64_t piece = 0; piece < next.current_model().pieces; ++piece) {
    const std::string_view part = bytes.substr(piece * kPieceBytes, kPieceBytes);
    if (const Status stored = store(piece_subject(next, *hash, piece), part); !stored) return stored.error();
  }
  if (const Status stored = store(manifest_subject(robot, array), manifest_to_json(next)); !stored) {
    return stored.error();
  }
  if (const Status removed = remove_unnamed(next); !removed) return removed.error();
  return next;
}

/// Pieces of older models, and of pushes that did not end.
Status ModelStore::remove_unnamed(const ModelManifest& manifest) {
  const std::string subjects = subjects_of(manifest.robot, manifest.array);
  const Result<std::string> answer =
      broker_->ask(std::string("$JS.API.STREAM.INFO.") + kModels, Json({{"subjects_filter", subjects + ">"}}).dump());
  if (!answer) return answer.error();
  std::set<std::string> unnamed;
  const Json present = object_at(object_at(Json::parse(*answer, nullptr, false), "state"), "subjects");
  for (const auto& subject : present.items()) unnamed.insert(part_of(subject.key(), kPlaceOfSha256));
  unnamed.erase("current");
  for (const PushedModel& model : manifest.models) unnamed.erase(model.sha256);
  for (const std::string& sha256 : unnamed) {
    const Result<std::string> purged = broker_->ask(std::string("$JS.API.STREAM.PURGE.") + kModels,
                                                    Json({{"filter", subjects + sha256 + ".*"}}).dump());
    if (!purged) return purged.error();
  }
  return Done{};
}

Result<ModelManifest> ModelStore::roll_back(const std::string& robot, const std::string& array) {
  if (const Status prepared = prepare_hub(); !prepared) return prepared.error();
  Result<std::optional<ModelManifest>> present = manifest(robot, array);
  if (!present) return present.error();
  if (!*present) return bad_input(robot + "/" + array + ": no model was pushed to it");
  ModelManifest next = **std::move(present);
  if (const Status rolled = next.roll_back(); !rolled) return rolled.error();
  if (const Status stored = store(manifest_subject(robot, array), manifest_to_json(next)); !stored) {
    return stored.error();
  }
  return next;
}

Result<std::vector<ModelManifest>> ModelStore::all(std::vector<std::string>& unreadable) {
  std::vector<ModelManifest> manifests;
  const Result<bool> is_there = has_stream(*broker_, kModels);
  if (!is_there) return is_there.error();
  for (std::uint64_t next = 1; *is_there;) {
    const auto message = broker_->next(kModels, manifest_subject("*", "*"), next);
    if (!message) return message.error();
    if (!*message) break;
    const std::vector<std::uint8_t>& bytes = (*message)->bytes;
    Result<ModelManifest> manifest = manifest_from_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    if (manifest)
      manifests.push_back(*std::move(manifest));
    else
      unreadable.push_back("message " + std::to_string((*message)->sequence) + ": " + manifest.error().message);
    next = (*message)->sequence + 1;
  }
  std::sort(manifests.begin(), manifests.end(), [](const ModelManifest& a, const ModelManifest& b) {
    return std::pair(a.robot, a.array) < std::pair(b.robot, b.array);
  });
  return manifests;
}

}  // namespace dermis::live::fleet
