// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/server_files.hpp"

#include <arpa/inet.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/config_table.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "live/fleet/fleet_keys.hpp"
#include "live/fleet/server_texts.hpp"

namespace dermis::live::fleet {
namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t kPort = 4222;
constexpr std::uint16_t kRobotsPort = 7422;
constexpr const char* kHub = "hub";

/// While it lives, new files and folders are their owner's alone.
class OnlyForOwner {
 public:
  OnlyForOwner() : before_(::umask(S_IRWXG | S_IRWXO)) {}
  OnlyForOwner(const OnlyForOwner&) = delete;
  OnlyForOwner& operator=(const OnlyForOwner&) = delete;
  ~OnlyForOwner() { ::umask(before_); }

 private:
  mode_t before_;
};

bool is_host(const std::string& name) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_'; };
  return !name.empty() && name.size() <= 253 && name.front() != '-' && std::all_of(name.begin(), name.end(), fits);
}

bool is_ipv4(const std::string& name) {
  in_addr address{};
  return ::inet_pton(AF_INET, name.c_str(), &address) == 1;
}

Status check(const FleetPlan& plan) {
  if (!is_host(plan.hub)) return bad_input("hub: '" + plan.hub + "' must be the name or the IPv4 address of a machine");
  if (plan.port == plan.robots_port) return bad_input("hub: its two ports must differ");
  if (plan.robots.empty()) return bad_input("robot: a fleet needs the name of one");
  for (const std::string& robot : plan.robots) {
    if (Status good = check_name("robot", robot); !good) return good;
    if (robot == kHub) return bad_input("robot: 'hub' is the name of the hub; a robot needs another");
  }
  return Done{};
}

std::string plan_text(const FleetPlan& plan) {
  std::string text =
      "# A fleet of dermis. A robot that leaves is taken out here; the hub's file is then written anew.\n"
      "hub = \"" +
      plan.hub + "\"\nport = " + std::to_string(plan.port) + "\nrobots_port = " + std::to_string(plan.robots_port) +
      "\nrobots = [\n";
  for (const std::string& robot : plan.robots) text += "  \"" + robot + "\",\n";
  return text + "]\n";
}

void read_port(bytes::files::ConfigFile& file, const char* key, std::uint16_t& port) {
  std::size_t value = port;
  file.require(key);
  file.count(key, value);
  if (value == 0 || value > std::numeric_limits<std::uint16_t>::max()) file.fail(key, "must be a port, 1 to 65535");
  port = static_cast<std::uint16_t>(value);
}

/// The plan of before; empty where there is none.
Result<std::optional<FleetPlan>> read_plan(const std::string& path) {
  if (!fs::exists(path)) return std::optional<FleetPlan>();
  Result<bytes::files::ConfigFile> file = bytes::files::ConfigFile::read(path);
  if (!file) return file.error();
  FleetPlan plan{.port = kPort, .robots_port = kRobotsPort};
  file->require("hub");
  file->text("hub", plan.hub);
  read_port(*file, "port", plan.port);
  read_port(*file, "robots_port", plan.robots_port);
  file->require("robots");
  file->texts("robots", plan.robots);
  if (const Status finished = file->finish(); !finished) return finished.error();
  return std::optional(std::move(plan));
}

/// `wanted`, in the fleet that is there.
Result<FleetPlan> joined(FleetPlan plan, const FleetPlan& wanted, const std::string& path) {
  const bool fits = (wanted.hub.empty() || wanted.hub == plan.hub) && (wanted.port == 0 || wanted.port == plan.port) &&
                    (wanted.robots_port == 0 || wanted.robots_port == plan.robots_port);
  if (!fits) return bad_input(path + ": the hub and its ports stay as they are; another fleet needs another folder");
  std::set<std::string> there(plan.robots.begin(), plan.robots.end());
  if (there.size() != plan.robots.size()) return bad_input(path + ": robots: one is there twice");
  for (const std::string& robot : wanted.robots) {
    if (there.insert(robot).second) plan.robots.push_back(robot);
  }
  if (const Status good = check(plan); !good) return good.error();
  return plan;
}

class Folder {
 public:
  Folder(fs::path place, std::unique_ptr<FleetKeys> keys) : place_(std::move(place)), keys_(std::move(keys)) {}

  [[nodiscard]] Status write(const FleetPlan& plan);
  [[nodiscard]] const std::vector<std::string>& written() const { return written_; }

 private:
  [[nodiscard]] Status write_hub(const FleetPlan& plan);
  [[nodiscard]] Status write_robot(const FleetPlan& plan, const std::string& robot);
  /// The text of a file, which is made where it is not there.
  template <typename Make>
  [[nodiscard]] Result<std::string> kept(const std::string& name, Make make);
  [[nodiscard]] Status keep(const std::string& name, const std::string& text);
  [[nodiscard]] Status update(const std::string& name, const std::string& text);
  [[nodiscard]] Status replace(const std::string& name, const std::string& text);
  [[nodiscard]] Result<std::string> key(const std::string& name);
  [[nodiscard]] Status certify(const std::string& name, CertificatePlan plan);
  /// The public key of a seed.
  [[nodiscard]] Result<std::string> user(const std::string& name);

  const fs::path place_;
  const std::unique_ptr<FleetKeys> keys_;
  std::string authority_;
  std::string authority_key_;
  std::vector<std::string> written_;
};

template <typename Make>
Result<std::string> Folder::kept(const std::string& name, Make make) {
  const fs::path path = place_ / name;
  if (fs::exists(path)) {
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file) return failed(path.string() + ": cannot be read");
    return text;
  }
  const Result<std::string> made = make();
  if (!made) return made.error();
  if (const Status put = replace(name, *made); !put) return put.error();
  return *made;
}

/// A file that is there stays.
Status Folder::keep(const std::string& name, const std::string& text) {
  const Result<std::string> there = kept(name, [&] { return Result<std::string>(text); });
  return there ? Status(Done{}) : Status(there.error());
}

Status Folder::update(const std::string& name, const std::string& text) {
  const Result<std::string> before = kept(name, [&] { return Result<std::string>(text); });
  if (!before) return before.error();
  return *before == text ? Status(Done{}) : replace(name, text);
}

Status Folder::replace(const std::string& name, const std::string& text) {
  const fs::path path = place_ / name;
  std::error_code failure;
  fs::create_directories(path.parent_path(), failure);
  if (failure) return bad_input(path.parent_path().string() + ": " + failure.message());
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(path.string());
  if (!file) return file.error();
  file->write(text);
  if (Status committed = file->commit(); !committed) return committed;
  written_.push_back(path.string());
  return Done{};
}

Result<std::string> Folder::key(const std::string& name) {
  return kept(name, [&] { return keys_->make_key(); });
}

Status Folder::certify(const std::string& name, CertificatePlan plan) {
  const Result<std::string> own = key(name + ".key");
  if (!own) return own.error();
  plan.key = *own;
  plan.authority = authority_;
  plan.authority_key = authority_key_;
  const Result<std::string> certificate = kept(name + ".pem", [&] { return keys_->make_certificate(plan); });
  return certificate ? Status(Done{}) : Status(certificate.error());
}

Result<std::string> Folder::user(const std::string& name) {
  const Result<std::string> seed = kept(name, [&]() -> Result<std::string> {
    const Result<std::string> made = keys_->make_seed();
    return made ? Result<std::string>(*made + "\n") : made;
  });
  if (!seed) return seed.error();
  Result<std::string> public_key = keys_->user_of(seed->substr(0, seed->find('\n')));
  if (!public_key) return bad_input((place_ / name).string() + ": " + public_key.error().message);
  return public_key;
}

Status Folder::write(const FleetPlan& plan) {
  if (Status put = update("fleet.toml", plan_text(plan)); !put) return put;
  const Result<std::string> authority_key = key("ca.key");
  if (!authority_key) return authority_key.error();
  const Result<std::string> authority =
      kept("ca.pem", [&] { return keys_->make_certificate({.name = "fleet of " + plan.hub, .key = *authority_key}); });
  if (!authority) return authority.error();
  authority_key_ = *authority_key;
  authority_ = *authority;
  for (const std::string& robot : plan.robots) {
    if (Status put = write_robot(plan, robot); !put) return put;
  }
  return write_hub(plan);
}

Status Folder::write_hub(const FleetPlan& plan) {
  std::string names = "DNS:localhost,IP:127.0.0.1";
  if (plan.hub != "localhost" && plan.hub != "127.0.0.1") names += (is_ipv4(plan.hub) ? ",IP:" : ",DNS:") + plan.hub;
  if (Status put = certify("hub/hub", {.holder = Holder::server, .name = "hub", .other_names = names}); !put)
    return put;
  const Result<std::string> operator_key = user("operator.seed");
  if (!operator_key) return operator_key.error();
  const Result<std::string> worker_key = user("worker.seed");
  if (!worker_key) return worker_key.error();
  if (Status put = keep("hub/ca.pem", authority_); !put) return put;
  return update("hub/nats.conf", hub_text(plan, {*operator_key, *worker_key}));
}

Status Folder::write_robot(const FleetPlan& plan, const std::string& robot) {
  const std::string begin = "robots/" + robot + "/";
  const CertificatePlan certificate{
      .holder = Holder::robot, .name = robot, .other_names = "email:" + robot_user(robot)};
  if (Status put = certify(begin + robot, certificate); !put) return put;
  if (Status put = keep(begin + "ca.pem", authority_); !put) return put;
  const Result<std::string> user_key = user(begin + robot + ".seed");
  if (!user_key) return user_key.error();
  return keep(begin + "nats.conf", robot_text(plan, robot, *user_key));
}

}  // namespace

Result<std::vector<std::string>> write_server_files(const FleetPlan& plan, const std::string& folder) {
  const std::string path = (fs::path(folder) / "fleet.toml").string();
  const Result<std::optional<FleetPlan>> before = read_plan(path);
  if (!before) return before.error();
  FleetPlan first = plan;
  first.robots.clear();
  if (first.hub.empty()) first.hub = "127.0.0.1";
  if (first.port == 0) first.port = kPort;
  if (first.robots_port == 0) first.robots_port = kRobotsPort;
  const Result<FleetPlan> whole = joined(before->value_or(first), plan, path);
  if (!whole) return whole.error();
  Result<std::unique_ptr<FleetKeys>> keys = load_fleet_keys();
  if (!keys) return keys.error();
  const OnlyForOwner mask;
  Folder place(folder, *std::move(keys));
  if (const Status written = place.write(*whole); !written) return written.error();
  return place.written();
}

}  // namespace dermis::live::fleet
