// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/streams.hpp"

#include "live/fleet/json_values.hpp"

namespace dermis::live::fleet {
namespace {

constexpr std::int64_t kDuplicatesNanos = 120'000'000'000;
constexpr std::uint64_t kStreamNameInUse = 10058;  // one of the name is there, with other settings
constexpr std::uint64_t kNoStream = 10059;

Result<Json> stream_info(Broker& broker, const std::string& name) {
  const Result<std::string> answer = broker.ask("$JS.API.STREAM.INFO." + name, "");
  if (!answer) return answer.error();
  Json info = Json::parse(*answer, nullptr, false);
  if (!info.is_object()) return failed("stream " + name + ": the server's answer is no JSON");
  return info;
}

/// With `settings` besides the usual ones. One that is there stays as it is.
Status create_stream(Broker& broker, const std::string& name, const Json& settings) {
  Json all = {{"name", name},      {"storage", "file"},   {"retention", "limits"},
              {"discard", "old"},  {"max_consumers", -1}, {"max_msgs", -1},
              {"num_replicas", 1}, {"max_bytes", -1},     {"allow_direct", true}};
  all.update(settings);
  const Result<std::string> answer = broker.ask("$JS.API.STREAM.CREATE." + name, all.dump());
  if (!answer) return answer.error();
  const Json made = Json::parse(*answer, nullptr, false);
  if (!made.is_object()) return failed("stream " + name + ": the server's answer is no JSON");
  const Json error = object_at(made, "error");
  if (error.empty() || number_at(error, "err_code") == kStreamNameInUse) return Done{};
  return failed("stream " + name + ": the server refuses it: " + text_at(error, "description"));
}

}  // namespace

Status make_stream(Broker& broker, const std::string& robot) {
  Json settings = {{"duplicate_window", kDuplicatesNanos}};
  settings["subjects"] = Json::array({"dermis." + robot + ".>"});
  return create_stream(broker, stream_of(robot), settings);
}

Status mirror_stream(Broker& broker, const std::string& robot) {
  const Json external = {{"api", "$JS." + robot + ".API"}, {"deliver", "dermis-mirror." + robot}};
  const Json origin = {{"name", stream_of(robot)}, {"external", external}};
  const std::string name = stream_of(robot);
  if (Status made = create_stream(broker, name, {{"mirror", origin}}); !made) return made;
  const Result<Json> info = stream_info(broker, name);
  if (!info) return info.error();
  if (!object_at(object_at(*info, "config"), "mirror").empty()) return Done{};
  return bad_input("robot '" + robot + "' publishes to this server itself; its stream " + name + " is no copy");
}

Result<bool> has_stream(Broker& broker, const std::string& name) {
  const Result<Json> info = stream_info(broker, name);
  if (!info) return info.error();
  const Json error = object_at(*info, "error");
  if (error.empty()) return true;
  if (number_at(error, "err_code") == kNoStream) return false;
  return failed("stream " + name + ": " + text_at(error, "description"));
}

/// By halves, as the times in a stream rise.
Result<std::uint64_t> first_since(Broker& broker, const StreamSubject& of, Nanos time, std::uint64_t newest) {
  std::uint64_t before = 0;
  std::uint64_t after = newest;
  while (before + 1 < after) {
    const std::uint64_t middle = before + (after - before) / 2;
    const Result<std::optional<StoredMessage>> message = broker.next(of.stream, of.subject, middle);
    if (!message) return message.error();
    if (!*message || (*message)->time >= time) {
      after = middle;
    } else {
      before = (*message)->sequence;
    }
  }
  return after;
}

Result<std::string> domain_of(Broker& broker) {
  const Result<std::string> answer = broker.ask("$JS.API.INFO", "");
  if (!answer) return answer.error();
  return text_at(Json::parse(*answer, nullptr, false), "domain");
}

Status make_key_store(Broker& broker, const std::string& name, Nanos lasts) {
  Json settings = {{"max_msgs_per_subject", 1}, {"max_age", lasts.count()}, {"discard", "new"}};
  settings["subjects"] = Json::array({"$KV." + name + ".>"});
  return create_stream(broker, "KV_" + name, settings);
}

Status make_log(Broker& broker, const std::string& name, const std::string& subjects) {
  Json settings = {{"max_msgs_per_subject", 1}};
  settings["subjects"] = Json::array({subjects});
  return create_stream(broker, name, settings);
}

}  // namespace dermis::live::fleet
