// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <thread>
#include <utility>

#include "support/temporary_folder.hpp"

namespace dermis::support {

inline std::uint16_t free_port() {
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

/// A real nats-server with JetStream, on a port of its own.
class NatsServer {
 public:
  NatsServer() : folder_(temporary_.file("")), port_(free_port()) {
    write_bytes(folder_ + "/nats.conf", "jetstream { store_dir: \"store\" }\n");
    start();
  }
  /// In a folder with its configuration "nats.conf".
  NatsServer(std::string folder, std::uint16_t port) : folder_(std::move(folder)), port_(port) { start(); }
  NatsServer(const NatsServer&) = delete;
  NatsServer& operator=(const NatsServer&) = delete;
  ~NatsServer() { kill(); }

  [[nodiscard]] static bool is_installed() { return std::system("nats-server --version >/dev/null 2>&1") == 0; }
  [[nodiscard]] std::string log() const { return read_bytes(folder_ + "/log"); }
  [[nodiscard]] std::string url() const { return "nats://127.0.0.1:" + std::to_string(port_); }

  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = 0;
  }

  /// Reads its files again.
  void reload() const { ::kill(process_, SIGHUP); }

  /// With the streams that it had.
  void start() {
    process_ = ::fork();
    if (process_ == 0) {
      const int log = ::open((folder_ + "/log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
      ::dup2(log, 1);
      ::dup2(log, 2);
      if (::chdir(folder_.c_str()) != 0) ::_exit(126);
      ::execlp("nats-server", "nats-server", "-c", "nats.conf", "-p", std::to_string(port_).c_str(), nullptr);
      ::_exit(127);
    }
    for (int look = 0; look < 200 && !answers(); ++look) std::this_thread::sleep_for(std::chrono::milliseconds(25));
  }

 private:
  [[nodiscard]] bool answers() const {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port_);
    const bool connected = ::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
    ::close(socket);
    return connected;
  }

  TemporaryFolder temporary_;
  const std::string folder_;
  const std::uint16_t port_;
  pid_t process_ = 0;
};

}  // namespace dermis::support
