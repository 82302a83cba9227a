// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace dermis::live::buses {

/// A device that answers questions for holding registers, one client at a time, as Modbus TCP has it. The register of
/// address a holds a + the number of the answer. Addresses below 3000 are refused. One in `wrong_ids` answers is that
/// to another question, by its id; 0: none.
class RegisterDevice {
 public:
  explicit RegisterDevice(unsigned wrong_ids = 0)
      : listener_(::socket(AF_INET, SOCK_STREAM, 0)), wrong_ids_(wrong_ids) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* const address = reinterpret_cast<sockaddr*>(&place);
    static_cast<void>(::bind(listener_, address, sizeof(place)));
    ::listen(listener_, 16);  // clients of before that it has not closed yet wait in this queue, too
    socklen_t size = sizeof(place);
    ::getsockname(listener_, address, &size);
    port_ = ntohs(place.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  RegisterDevice(const RegisterDevice&) = delete;
  RegisterDevice& operator=(const RegisterDevice&) = delete;
  ~RegisterDevice() {
    stop_ = true;
    ::shutdown(listener_, SHUT_RDWR);
    hang_up();
    thread_.join();
    ::close(listener_);
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Closes the connection of its client.
  void hang_up() {
    if (const int client = client_; client >= 0) ::shutdown(client, SHUT_RDWR);
  }

 private:
  void run() {
    while (!stop_) {
      const int client = ::accept(listener_, nullptr, nullptr);
      if (client < 0) return;
      client_ = client;
      while (!stop_ && answer(client)) {
      }
      client_ = -1;
      ::close(client);
    }
  }

  bool answer(int client) {
    std::array<std::uint8_t, 12> question{};
    if (::recv(client, question.data(), question.size(), MSG_WAITALL) != 12) return false;
    const unsigned address = 256U * question[8] + question[9];
    const unsigned words = 256U * question[10] + question[11];
    std::vector<std::uint8_t> bytes(question.begin(), question.begin() + 8);
    if (address < 3000 || question[7] != 3) {
      bytes[7] |= 0x80U;
      bytes.push_back(2);
    } else {
      bytes.push_back(static_cast<std::uint8_t>(2 * words));
      for (unsigned k = 0; k < words; ++k) {
        const unsigned value = address + k + answers_;
        bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
        bytes.push_back(static_cast<std::uint8_t>(value));
      }
      ++answers_;
      if (wrong_ids_ > 0 && answers_ % wrong_ids_ == 0) ++bytes[1];
    }
    bytes[5] = static_cast<std::uint8_t>(bytes.size() - 6);
    return ::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }

  const int listener_;
  std::uint16_t port_ = 0;
  std::atomic<int> client_{-1};
  std::atomic<bool> stop_{false};
  const unsigned wrong_ids_;
  unsigned answers_ = 0;
  std::thread thread_;
};

}  // namespace dermis::live::buses
