// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fleet/streams.hpp"

#include <nlohmann/json.hpp>

namespace dermis::fleet {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kDuplicatesNanos = 120'000'000'000;
constexpr int kNameInUse = 10058;  // a stream of the name is there, with other settings

Status create_stream(Broker& broker, Json settings) {
  const std::string name = settings["name"];
  settings.update({{"storage", "file"},
                   {"retention", "limits"},
                   {"discard", "old"},
                   {"max_consumers", -1},
                   {"max_msgs", -1},
                   {"num_replicas", 1},
                   {"allow_direct", true}});
  const Result<std::string> answer = broker.ask("$JS.API.STREAM.CREATE." + name, settings.dump());
  if (!answer) return answer.error();
  const Json made = Json::parse(*answer, nullptr, false);
  if (!made.is_object()) return failed("stream " + name + ": the server's answer is no JSON");
  const Json error = made.value("error", Json::object());
  if (error.empty() || error.value("err_code", 0) == kNameInUse) return Done{};
  return failed("stream " + name + ": " + error.value("description", "refused"));
}

}  // namespace

Status make_stream(Broker& broker, const std::string& robot, std::uint64_t most_bytes) {
  return create_stream(broker, {{"name", stream_of(robot)},
                                {"subjects", {"dermis." + robot + ".>"}},
                                {"duplicate_window", kDuplicatesNanos},
                                {"max_bytes", most_bytes > 0 ? static_cast<std::int64_t>(most_bytes) : -1}});
}

Status mirror_stream(Broker& broker, const std::string& robot) {
  return create_stream(broker,
                       {{"name", stream_of(robot)},
                        {"max_bytes", -1},
                        {"mirror", {{"name", stream_of(robot)}, {"external", {{"api", "$JS." + robot + ".API"}}}}}});
}

}  // namespace dermis::fleet
