// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/lerobot_tables.hpp"

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "out/datasets/lerobot_program.hpp"

namespace dermis::out::datasets {
namespace {

constexpr const char* kUse = "LeRobot datasets are written by Python and pyarrow: ";

/// The socket is its standard input. Ctrl-C is ours: the child has a group of its own, and ends with the socket.
int spawn(const std::string& python, const std::string& folder, int socket, pid_t& process) {
  posix_spawnattr_t attributes{};
  posix_spawn_file_actions_t files{};
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, socket, STDIN_FILENO);
  ::posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  std::array<std::string, 4> words = {python, "-c", kLeRobotProgram, folder};
  std::array<char*, 5> arguments = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  const int failure = ::posix_spawnp(&process, python.c_str(), &files, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  return failure;
}

}  // namespace

Result<std::unique_ptr<LeRobotTables>> LeRobotTables::start(const std::string& python, const std::string& folder) {
  std::array<int, 2> sockets{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) {
    return failed(std::string(kUse) + std::strerror(errno));
  }
  pid_t process = 0;
  const int failure = spawn(python, folder, sockets[1], process);
  ::close(sockets[1]);
  if (failure != 0) {
    ::close(sockets[0]);
    return failed(kUse + python + ": " + std::strerror(failure));
  }
  auto tables = std::unique_ptr<LeRobotTables>(new LeRobotTables(sockets[0], process));
  if (const Status ready = tables->expect("ready"); !ready) return ready.error();
  return tables;
}

LeRobotTables::~LeRobotTables() {
  ::close(socket_);
  ::waitpid(process_, nullptr, 0);
}

/// Where the process has ended, its last line says why.
Status LeRobotTables::send(std::span<const std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return expect({});
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return Done{};
}

Status LeRobotTables::send_line(std::string line) const {
  line += '\n';
  return send(std::as_bytes(std::span(line)));
}

Status LeRobotTables::expect(std::string_view answer) const {
  constexpr std::size_t kMostCharacters = 4096;
  std::string line;
  for (char letter = 0; line.size() < kMostCharacters;) {
    const ssize_t got = ::read(socket_, &letter, 1);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0 || letter == '\n') break;
    line += letter;
  }
  if (!answer.empty() && line == answer) return Done{};
  return failed(kUse + (line.empty() ? "it has ended without a word" : line));
}

Status LeRobotTables::finish(std::string line) const {
  if (Status sent = send_line(std::move(line)); !sent) return sent;
  return expect("done");
}

}  // namespace dermis::out::datasets
