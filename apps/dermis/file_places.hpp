// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// The files behind "-".
inline constexpr const char* kStandardInput = "/dev/stdin";
inline constexpr const char* kStandardOutput = "/dev/stdout";

/// The files that a command reads and writes, and the rule that keeps it from overwriting any. Added options must live
/// as long as this.
class FilePlaces {
 public:
  /// `option` names a file, or a source (docs/devices.md), which may be in a file; what a suit.toml names is read, too.
  /// Empty: none.
  void add_input(const std::string& option, const std::string& name);
  void add_input(const std::string& option, const std::vector<std::string>& names);

  void add_output(const std::string& option, const std::string& path);
  /// Files that the command writes beside.
  void add_outputs(const std::string& option, std::function<std::vector<std::string>()> paths);
  /// A model or classes: the command keeps earlier ones.
  void add_model_output(const std::string& option, const std::string& path);
  /// Files in a folder. Those of a folder with an origin.toml were simulated, and can be again.
  void add_output_folder(const std::string& option, const std::string& folder, std::vector<std::string> files);

  [[nodiscard]] bool has_outputs() const noexcept { return !outputs_.empty(); }

  /// Fails if an output is an input or another output, by whatever name, or two inputs are the standard input. Fails if
  /// it exists and is neither a table of results nor a picture, unless `is_forced`. Says which files will be replaced.
  /// Takes the names of the outputs (bytes::files::claim_output()); fails if another process writes one.
  [[nodiscard]] Status check(bool is_forced) const;

 private:
  struct Place {
    std::string option;
    std::function<std::vector<std::string>()> paths;
    bool is_model = false;
    std::function<bool()> can_be_made_again{};  ///< Empty: it cannot.
  };

  /// Fails where two of these places are the same stream.
  [[nodiscard]] static Status check_one_uses(const std::string& stream, const std::vector<Place>& places,
                                             const char* use);
  [[nodiscard]] Status check_distinct() const;
  [[nodiscard]] Status claim() const;

  std::vector<Place> inputs_;
  std::vector<Place> outputs_;
};

}  // namespace dermis::app
