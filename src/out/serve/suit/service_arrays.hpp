// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// An array that clients calibrate and teach.
struct ServiceArray {
  std::string name;
  ArrayDescription description;  ///< As calibration takes it: parts of the circuit may still be unknown.
  std::string model;             ///< Path of its model or array.toml: new files go into that folder.

  [[nodiscard]] std::string folder() const;
  /// A new name in the folder with the time in it, "skin-20261122-101500" or "skin-touches-20261122-101500", with "-2"
  /// and so on where frames have that name.
  [[nodiscard]] std::string new_name(std::string_view content = {}) const;
  /// A path in the folder.
  [[nodiscard]] std::string path_of(const std::string& name) const;
};

/// The arrays of a suit, as requests name them.
class ServiceArrays {
 public:
  explicit ServiceArrays(std::vector<ServiceArray> arrays);

  [[nodiscard]] std::size_t size() const noexcept { return arrays_.size(); }
  [[nodiscard]] const ServiceArray& operator[](std::size_t array) const { return arrays_[array]; }
  /// The place of an array; an empty name is the array where there is one only.
  [[nodiscard]] Result<std::size_t> find(std::string_view name) const;

 private:
  std::vector<ServiceArray> arrays_;
};

[[nodiscard]] ServiceArrays service_arrays(const ServedSuit& suit);

}  // namespace dermis::out::serve
