// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/suit/service_arrays.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

#include "dermis/bytes/files/kept_copy.hpp"

namespace dermis::out::serve {
std::string ServiceArray::folder() const {
  return std::filesystem::path(model).parent_path().string();
}

std::string ServiceArray::new_name(std::string_view content) const {
  std::string new_name = name + "-";
  if (!content.empty()) new_name.append(content).append("-");
  new_name += bytes::files::time_stamp(std::chrono::system_clock::now());
  std::string unused = new_name;
  std::error_code error;
  for (int number = 2; std::filesystem::exists(path_of(unused + ".frames.csv"), error); ++number) {
    unused = new_name + "-" + std::to_string(number);
  }
  return unused;
}

std::string ServiceArray::path_of(const std::string& name) const {
  return (std::filesystem::path(folder()) / name).string();
}

ServiceArrays::ServiceArrays(std::vector<ServiceArray> arrays) : arrays_(std::move(arrays)) {}

Result<std::size_t> ServiceArrays::find(std::string_view name) const {
  if (name.empty() && arrays_.size() == 1) return std::size_t{0};
  const auto found = std::ranges::find(arrays_, name, &ServiceArray::name);
  if (found == arrays_.end()) return bad_input("array: there is none of that name");
  return static_cast<std::size_t>(found - arrays_.begin());
}

ServiceArrays service_arrays(const ServedSuit& suit) {
  std::vector<ServiceArray> arrays;
  for (const ServedArray& array : suit.arrays) arrays.push_back({array.name, array.description, array.model_path});
  return ServiceArrays(std::move(arrays));
}

}  // namespace dermis::out::serve
