// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/publishing_process.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <system_error>
#include <utility>

#include "live/fleet/json_values.hpp"

namespace dermis::live::fleet {
namespace {

constexpr std::size_t kMostCharacters = 4096;
constexpr std::size_t kMostOfAHost = 64;
constexpr int kFieldOfStart = 22;  // of /proc/PID/stat, from 1 on; the state is field 3

struct Run {
  char state = ' ';
  std::uint64_t started = 0;
};

/// Empty where the machine does not show it.
std::optional<Run> run_of(std::int64_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream fields(text.substr(name_end + 1));
  Run run;
  fields >> run.state;
  std::string skipped;
  for (int field = 4; field < kFieldOfStart; ++field) fields >> skipped;
  if (!(fields >> run.started)) return std::nullopt;
  return run;
}

std::string kernel_of_this() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string boot;
  file >> boot;
  std::error_code error;
  return boot + " " + std::filesystem::read_symlink("/proc/self/ns/pid", error).string();
}

std::string new_token() {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device random;
  std::string token(32, '0');
  for (char& digit : token) digit = kDigits[random() % kDigits.size()];
  return token;
}

/// Letters, digits, '.', '-' and '_' of it: it is shown to people.
std::string plain(std::string text) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
           c == '_';
  };
  std::erase_if(text, [&](char c) { return !is_plain(c); });
  return text.substr(0, kMostOfAHost);
}

}  // namespace

std::string PublishingProcess::shown() const {
  return "process " + std::to_string(pid) + " on " + host;
}

bool PublishingProcess::is_gone() const {
  if (pid <= 0 || kernel != kernel_of_this()) return false;
  if (::kill(static_cast<pid_t>(pid), 0) != 0 && errno == ESRCH) return true;
  const std::optional<Run> run = run_of(pid);
  if (!run) return false;
  return run->state == 'Z' || run->state == 'X' || (started != 0 && run->started != started);
}

PublishingProcess this_process() {
  std::array<char, 256> host{};
  static_cast<void>(::gethostname(host.data(), host.size() - 1));
  const std::optional<Run> run = run_of(::getpid());
  return {.token = new_token(),
          .host = plain(host.data()),
          .kernel = kernel_of_this(),
          .pid = ::getpid(),
          .started = run ? run->started : 0};
}

std::string to_json(const PublishingProcess& process) {
  return Json({{"token", process.token},
               {"host", process.host},
               {"kernel", process.kernel},
               {"pid", static_cast<std::uint64_t>(process.pid)},
               {"started", process.started},
               {"replaces", process.replaces}})
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<PublishingProcess> process_from_json(std::string_view text) {
  if (text.size() > kMostCharacters) return std::nullopt;
  const Json json = Json::parse(text, nullptr, false);
  const std::uint64_t pid = number_at(json, "pid");
  PublishingProcess process{.token = text_at(json, "token"),
                            .host = plain(text_at(json, "host")),
                            .kernel = text_at(json, "kernel"),
                            .pid = static_cast<std::int64_t>(pid <= 0x7fffffffU ? pid : 0U),
                            .started = number_at(json, "started"),
                            .replaces = text_at(json, "replaces")};
  if (process.token.empty()) return std::nullopt;
  return process;
}

}  // namespace dermis::live::fleet
