// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

namespace dermis::app {
namespace {

constexpr std::chrono::seconds kGrace{2};
constexpr std::chrono::milliseconds kLook{5};
constexpr int kSignalled = 128;  // as shells say it

/// The child has a group of its own, so that its own children are stopped with it. It gets no file of ours but the
/// output, so that it holds no device.
class SpawnSettings {
 public:
  SpawnSettings() {
    ::posix_spawnattr_init(&attributes_);
    sigset_t as_usual{};
    sigemptyset(&as_usual);
    sigaddset(&as_usual, SIGPIPE);  // a program that ignores them hands that on
    sigaddset(&as_usual, SIGXFSZ);
    ::posix_spawnattr_setsigdefault(&attributes_, &as_usual);
    ::posix_spawnattr_setpgroup(&attributes_, 0);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    ::posix_spawn_file_actions_init(&files_);
    ::posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addclosefrom_np(&files_, STDERR_FILENO + 1);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  ~SpawnSettings() {
    ::posix_spawnattr_destroy(&attributes_);
    ::posix_spawn_file_actions_destroy(&files_);
  }

  [[nodiscard]] const posix_spawnattr_t* attributes() const { return &attributes_; }
  [[nodiscard]] const posix_spawn_file_actions_t* files() const { return &files_; }

 private:
  posix_spawnattr_t attributes_{};
  posix_spawn_file_actions_t files_{};
};

}  // namespace

Result<ChildProcess> ChildProcess::start(const std::vector<std::string>& command) {
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::signal(SIGCHLD, SIG_DFL);  // who ignores it cannot wait for a child
  const SpawnSettings settings;
  pid_t pid = 0;
  const int error =
      ::posix_spawnp(&pid, arguments.front(), settings.files(), settings.attributes(), arguments.data(), environ);
  if (error != 0) return bad_input("cannot start '" + command.front() + "': " + std::strerror(error));
  return ChildProcess(pid);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, 0)), exit_status_(other.exit_status_) {}

ChildProcess::~ChildProcess() {
  stop();
}

std::optional<int> ChildProcess::exit_status() noexcept {
  if (pid_ == 0) return exit_status_;
  int status = 0;
  const pid_t ended = ::waitpid(pid_, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno != ECHILD)) return std::nullopt;
  ::kill(-pid_, SIGKILL);  // what it has left behind
  pid_ = 0;
  exit_status_ = WIFSIGNALED(status) ? kSignalled + WTERMSIG(status) : WEXITSTATUS(status);
  return exit_status_;
}

void ChildProcess::stop() noexcept {
  if (pid_ == 0 || exit_status()) return;
  ::kill(-pid_, SIGTERM);
  const auto end = std::chrono::steady_clock::now() + kGrace;
  while (!exit_status() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kLook);
  if (exit_status()) return;
  ::kill(-pid_, SIGKILL);
  while (!exit_status()) std::this_thread::sleep_for(kLook);
}

}  // namespace dermis::app
