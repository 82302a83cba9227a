// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "out/serve/parts/part.hpp"

namespace dermis::out::serve {

/// Calls a service as the server does for a client.
inline Result<std::string> call(Part& part, std::string_view name, std::string_view request) {
  for (const websocket::Service& service : part.services()) {
    if (service.name == name) return service.call(request);
  }
  return bad_input("there is no such service");
}

inline std::vector<bytes::ros_messages::Diagnosis> diagnoses_of(const Part& part) {
  std::vector<bytes::ros_messages::Diagnosis> diagnoses;
  part.diagnose(diagnoses);
  return diagnoses;
}

}  // namespace dermis::out::serve
