// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>  // Asio 1.74 forgets it
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::out::serve {

/// A client of the stream that waits for each answer; a test that waits in vain is ended by its time limit.
class StreamClient {
 public:
  struct Message {
    std::string topic;
    Nanos time{};
    std::vector<std::uint8_t> bytes;
  };

  explicit StreamClient(std::uint16_t port);
  ~StreamClient();

  /// All of them; returns when the server knows it.
  void subscribe(const std::vector<std::string>& topics);
  [[nodiscard]] Message next_message();
  /// Of this topic; others are passed over.
  [[nodiscard]] Message next_message(const std::string& topic);

  /// The JSON of all parameters; of the one that was set, as it is then. `value` is JSON.
  std::string parameters();
  std::string set_parameter(const std::string& name, const std::string& value);
  /// The answer, or the line of the error.
  std::string call(const std::string& service, const std::string& request);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::out::serve
