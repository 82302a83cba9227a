// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "out/serve/parts/part.hpp"

namespace dermis::out::serve {

/// All parts of a server, in the order in which they hear a frame. Thread-safe as Part is, once all are added.
class PartList {
 public:
  void add(std::unique_ptr<Part> part);
  [[nodiscard]] Status prepare();

  void keep(std::size_t array, const RawFrame& frame) const;
  void hear(const live::suits::ArrayResult& result) const;
  void tick(std::int64_t tick) const;
  void model_changed(std::size_t array) const;
  [[nodiscard]] Status use_classes(std::size_t array, const learn::recognition::Classes& classes) const;
  /// From the last part to the first, so that arrays come before threats (docs/stream.md).
  [[nodiscard]] std::vector<bytes::ros_messages::Diagnosis> diagnoses() const;
  void report(live::fleet::RobotHealth& health) const;
  void finish() const;

  [[nodiscard]] std::vector<websocket::Service> services() const;
  [[nodiscard]] std::vector<websocket::Parameter> parameters() const;
  /// Errors: an unknown name, a value that it cannot have.
  [[nodiscard]] Status set(const websocket::Parameter& parameter, const std::string& client) const;

 private:
  std::vector<std::unique_ptr<Part>> parts_;
  std::vector<LiveParameter> parameters_;
};

}  // namespace dermis::out::serve
