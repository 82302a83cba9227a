// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <arpa/inet.h>
#include <fmt/core.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "child_process.hpp"
#include "dermis/live/fleet/hub.hpp"
#include "dermis/touch/frames/one_line.hpp"
#include "fleet_connection.hpp"
#include "fleet_robots.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

namespace filesystem = std::filesystem;

constexpr std::chrono::milliseconds kLookEvery{50};
constexpr std::chrono::seconds kLongestStart{20};

constexpr const char* kArray = R"([array]
name = "chest"
rows = 8
cols = 6
taxel_area_mm2 = 100.0

[readout]
circuit = "divider"
drive_ohm = 20.0
load_ohm = 200.0
adc_bits = 12
adc_reference_v = 5.0
supply_v = 5.0
)";

/// Removed with all that is in it.
class TrialFolder {
 public:
  [[nodiscard]] static Result<TrialFolder> make() {
    std::error_code error;
    const filesystem::path parent = filesystem::temp_directory_path(error);
    std::string path = ((error ? filesystem::path("/tmp") : parent) / "dermis-fleet-XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) return failed(path + ": cannot be made; set TMPDIR to a folder for files");
    return TrialFolder(path);
  }
  TrialFolder(TrialFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TrialFolder& operator=(TrialFolder&&) = delete;
  ~TrialFolder() {
    std::error_code error;
    if (!path_.empty()) filesystem::remove_all(path_, error);
  }

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  explicit TrialFolder(filesystem::path path) : path_(std::move(path)) {}

  filesystem::path path_;
};

std::uint16_t free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  static_cast<void>(::bind(socket, reinterpret_cast<sockaddr*>(&address), size));
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(socket);
  return ntohs(address.sin_port);
}

/// A hub and its robots. They end in the reverse order: robots say their last words to the hub.
class Trial {
 public:
  explicit Trial(TrialFolder folder) : folder_(std::move(folder)) {}

  [[nodiscard]] Status start();
  /// Fails where one of its programs has ended.
  [[nodiscard]] Status look();
  [[nodiscard]] const std::string& hub() const noexcept { return hub_; }
  [[nodiscard]] std::string model() const { return folder_.file("chest.safetensors"); }

 private:
  struct Program {
    std::string name;
    ChildProcess process;
  };

  [[nodiscard]] Status start_server();
  [[nodiscard]] Status calibrate();
  [[nodiscard]] Status start_robot(const std::string& name, const std::string& model, int rate_hz);
  [[nodiscard]] Result<ChildProcess> dermis(const std::string& log, const std::vector<std::string>& arguments) const;
  [[nodiscard]] Status run(const std::string& name, const std::vector<std::string>& arguments) const;
  [[nodiscard]] Error why_ended(const std::string& name) const;

  TrialFolder folder_;
  std::string hub_;
  std::vector<Program> server_{};
  std::vector<Program> robots_{};
};

/// Debian keeps the server where users do not look.
Status Trial::start_server() {
  const std::uint16_t port = free_port();
  hub_ = "nats://127.0.0.1:" + std::to_string(port);
  for (const char* const program : {"nats-server", "/usr/sbin/nats-server"}) {
    Result<ChildProcess> server =
        ChildProcess::start({program, "-a", "127.0.0.1", "-p", std::to_string(port), "-js", "-sd",
                             folder_.file("store"), "-l", folder_.file("nats-server.log")});
    if (!server) continue;
    server_.push_back({"nats-server", *std::move(server)});
    return Done{};
  }
  return bad_input("fleet try: needs nats-server; install it (Debian: apt install nats-server)");
}

/// The own program, with its words in a file.
Result<ChildProcess> Trial::dermis(const std::string& log, const std::vector<std::string>& arguments) const {
  std::error_code error;
  const std::string own = filesystem::read_symlink("/proc/self/exe", error).string();
  std::vector<std::string> command{"/bin/sh",
                                   "-c",
                                   R"(log=$1; shift; exec "$@" >"$log" 2>&1)",
                                   "sh",
                                   folder_.file(log + ".log"),
                                   error ? "dermis" : own};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return ChildProcess::start(command);
}

/// The last line of its log.
Error Trial::why_ended(const std::string& name) const {
  std::ifstream log(folder_.file(name + ".log"));
  std::string last;
  for (std::string line; std::getline(log, line);) last = line;
  return failed(fmt::format("fleet try: {} has ended: {}", name, last.empty() ? "it says nothing" : one_line(last)));
}

Status Trial::run(const std::string& name, const std::vector<std::string>& arguments) const {
  Result<ChildProcess> child = dermis(name, arguments);
  if (!child) return child.error();
  while (!stop_flag() && !child->exit_status()) std::this_thread::sleep_for(kLookEvery);
  const std::optional<int> status = child->exit_status();
  return !status || *status == 0 ? Status(Done{}) : Status(why_ended(name));
}

Status Trial::calibrate() {
  std::ofstream(folder_.file("chest.toml")) << kArray;
  const std::string data = folder_.file("presses");
  if (Status made =
          run("simulate", {"simulate", "--array", folder_.file("chest.toml"), "--scene", "calibration", "--out", data});
      !made)
    return made;
  return run("calibrate", {"calibrate", "--array", folder_.file("chest.toml"), "--frames", data + "/frames.csv",
                           "--loads", data + "/loads.csv", "--out", model()});
}

Status Trial::start_robot(const std::string& name, const std::string& model, int rate_hz) {
  std::error_code error;
  filesystem::create_directory(folder_.file(name), error);
  const std::string own = folder_.file(name + "/" + filesystem::path(model).filename().string());
  filesystem::copy_file(model, own, error);
  if (error) return failed(own + ": " + error.message());
  Result<ChildProcess> robot = dermis(name, {"serve", "--from", fmt::format("sim:contacts?rate={}", rate_hz), "--model",
                                             own, "--port", "0", "--publish", hub_, "--robot", name});
  if (!robot) return robot.error();
  robots_.push_back({name, *std::move(robot)});
  return Done{};
}

Status Trial::look() {
  for (std::vector<Program>* const programs : {&server_, &robots_}) {
    for (Program& program : *programs) {
      if (program.process.exit_status()) return why_ended(program.name);
    }
  }
  return Done{};
}

Status Trial::start() {
  if (Status started = start_server(); !started) return started;
  if (Status made = calibrate(); !made || stop_flag()) return made;
  if (Status started = start_robot("anna", model(), 100); !started) return started;
  if (Status started = start_robot("bob", folder_.file("chest.toml"), 50); !started) return started;
  const auto end = std::chrono::steady_clock::now() + kLongestStart;
  while (!stop_flag() && std::chrono::steady_clock::now() < end) {
    if (Status goes = look(); !goes) return goes;
    const Result<std::unique_ptr<live::fleet::Hub>> hub = connect_fleet<live::fleet::Hub>(hub_);
    if (!hub && hub.error().kind == ErrorKind::bad_input) return hub.error();
    const auto robots = hub ? (*hub)->robots() : Result<std::vector<live::fleet::RobotState>>(hub.error());
    if (robots && robots->size() == 2) return Done{};
    std::this_thread::sleep_for(kLookEvery);
  }
  return stop_flag() ? Status(Done{}) : Status(failed("fleet try: the robots do not reach their hub"));
}

Status try_fleet(PageOptions& page) {
  Result<TrialFolder> folder = TrialFolder::make();
  if (!folder) return folder.error();
  Trial trial(*std::move(folder));
  print_notice("a hub and two simulated robots begin here");
  if (Status started = trial.start(); !started || stop_flag()) return started;
  print_notice(fmt::format("robots anna and bob publish to {}; in another terminal:", trial.hub()));
  print_notice(fmt::format("  dermis fleet list {}", trial.hub()));
  print_notice(fmt::format("  dermis fleet push {} {} --for bob/chest", trial.hub(), trial.model()));
  page.hub = trial.hub();
  return serve_fleet_page(page, [&trial] { return trial.look(); });
}

}  // namespace

void add_fleet_try(Command& fleet) {
  auto page = std::make_shared<PageOptions>();
  page->server.port = 0;
  Command command = fleet.subcommand("try", "A hub, two simulated robots and the page on this machine, until Ctrl-C");
  command.option("--port", page->server.port, "Port of the page; 0: any that is free").shows_default();
  command.action([page] { return try_fleet(*page); });
}

}  // namespace dermis::app
