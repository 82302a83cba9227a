// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fleet/streams.hpp"

#include <nlohmann/json.hpp>

namespace dermis::fleet {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kDuplicatesNanos = 120'000'000'000;
constexpr int kStreamNameInUse = 10058;    // one of the name is there, with other settings
constexpr int kConsumerNameInUse = 10013;  // the same

/// Asks for something of a name to be made. One that is there stays as it is.
Status create(Broker& broker, const std::string& what, const std::string& subject, const Json& settings) {
  const Result<std::string> answer = broker.ask(subject, settings.dump());
  if (!answer) return answer.error();
  const Json made = Json::parse(*answer, nullptr, false);
  if (!made.is_object()) return failed(what + ": the server's answer is no JSON");
  const Json error = made.value("error", Json::object());
  const int code = error.value("err_code", 0);
  if (error.empty() || code == kStreamNameInUse || code == kConsumerNameInUse) return Done{};
  return failed(what + ": " + error.value("description", "refused"));
}

/// With `settings` besides the usual ones.
Status create_stream(Broker& broker, const std::string& name, const Json& settings) {
  Json all = {{"name", name},      {"storage", "file"},   {"retention", "limits"},
              {"discard", "old"},  {"max_consumers", -1}, {"max_msgs", -1},
              {"num_replicas", 1}, {"max_bytes", -1},     {"allow_direct", true}};
  all.update(settings);
  return create(broker, "stream " + name, "$JS.API.STREAM.CREATE." + name, all);
}

}  // namespace

Status make_stream(Broker& broker, const std::string& robot, std::uint64_t most_bytes) {
  Json settings = {{"duplicate_window", kDuplicatesNanos}};
  settings["subjects"] = Json::array({"dermis." + robot + ".>"});
  if (most_bytes > 0) settings["max_bytes"] = most_bytes;
  return create_stream(broker, stream_of(robot), settings);
}

Status mirror_stream(Broker& broker, const std::string& robot) {
  const Json origin = {{"name", stream_of(robot)}, {"external", {{"api", "$JS." + robot + ".API"}}}};
  return create_stream(broker, stream_of(robot), {{"mirror", origin}});
}

Status make_work_queue(Broker& broker, const std::string& name, const std::string& subject,
                       std::chrono::nanoseconds lease) {
  Json stream = {{"retention", "workqueue"}};
  stream["subjects"] = Json::array({subject});
  if (Status made = create_stream(broker, name, stream); !made) return made;
  const Json config = {{"durable_name", name},       {"ack_policy", "explicit"}, {"deliver_policy", "all"},
                       {"replay_policy", "instant"}, {"max_deliver", -1},        {"max_ack_pending", -1},
                       {"ack_wait", lease.count()}};
  return create(broker, "consumer " + name, "$JS.API.CONSUMER.DURABLE.CREATE." + name + "." + name,
                {{"stream_name", name}, {"config", config}});
}

Status make_log(Broker& broker, const std::string& name, const std::string& subjects) {
  Json settings = {{"duplicate_window", kDuplicatesNanos}};
  settings["subjects"] = Json::array({subjects});
  return create_stream(broker, name, settings);
}

}  // namespace dermis::fleet
