// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/hold_out.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>

#include "dermis/bytes/files/text.hpp"

namespace dermis::out::datasets {
namespace {

constexpr const char* kField = "hold-out";

std::optional<double> share_of(const std::vector<std::string>& wanted) {
  double share = 0.0;
  if (wanted.size() != 1 || bytes::files::number_at(wanted.front(), share) != wanted.front().size())
    return std::nullopt;
  return share;
}

/// By its path, or by the name of its file.
bool is_named(const std::string& recording, const std::string& name) {
  return recording == name || std::filesystem::path(recording).filename() == name;
}

}  // namespace

Result<HoldOut> HoldOut::create(const std::vector<std::string>& wanted, const std::vector<std::string>& recordings) {
  HoldOut made;
  made.order_.resize(recordings.size());
  std::iota(made.order_.begin(), made.order_.end(), std::size_t{0});
  made.trained_ = recordings.size();
  if (wanted.empty()) return made;
  if (const std::optional<double> share = share_of(wanted)) {
    if (!(*share > 0.0 && *share < 1.0)) return bad_field(kField, "must be more than 0 and less than 1, such as 0.2");
    made.share_ = *share;
    return made;
  }
  for (const std::string& name : wanted) {
    if (std::ranges::none_of(recordings, [&](const std::string& one) { return is_named(one, name); })) {
      return bad_field(kField, bytes::files::in_quotes(name) + " is none of the recordings, and no share such as 0.2");
    }
  }
  const auto is_trained = [&](std::size_t k) {
    return std::ranges::none_of(wanted, [&](const std::string& name) { return is_named(recordings[k], name); });
  };
  const auto held = std::stable_partition(made.order_.begin(), made.order_.end(), is_trained);
  made.trained_ = static_cast<std::size_t>(held - made.order_.begin());
  if (made.trained_ == 0) return bad_field(kField, "names all recordings, so none is left to train on");
  return made;
}

Result<std::uint64_t> HoldOut::episodes(std::uint64_t episodes, std::uint64_t of_trained) const {
  if (share_ == 0.0) return episodes - of_trained;
  const auto held = static_cast<std::uint64_t>(std::llround(share_ * static_cast<double>(episodes)));
  if (held > 0 && held < episodes) return held;
  if (episodes < 2) return bad_field(kField, "there is 1 episode; give more recordings");
  return bad_field(kField, fmt::format("{} of {} episodes is {}; give {:.2g} to {:.2g}", share_, episodes,
                                       held == 0 ? "none" : "all of them", 1.0 / static_cast<double>(episodes),
                                       1.0 - 1.0 / static_cast<double>(episodes)));
}

}  // namespace dermis::out::datasets
