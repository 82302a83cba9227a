// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "bytes/proposals/byte_text.hpp"
#include "bytes/proposals/draft.hpp"
#include "bytes/proposals/packet_drafts.hpp"
#include "bytes/proposals/shapes.hpp"
#include "bytes/proposals/smoothness.hpp"
#include "bytes/proposals/text_drafts.hpp"
#include "bytes/proposals/trial.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/proposals/proposals.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr double kMostLeft = 1.0 / 3.0;
constexpr std::size_t kFewestBytes = 16;
constexpr std::size_t kFewestTaxels = 4;  // of an array that nobody has named
constexpr std::size_t kFewestTaxelsOfLines = 2;
constexpr double kAsGood = 0.12;  // difference of merits
constexpr double kNoise = 0.85;   // roughness of readings that tell nothing

/// Readings that rest at the top of their range, and fall; true where the draft says so now.
bool describe_falling(const Trial& trial, Draft& draft) {
  std::vector<float> all;
  for (const std::vector<float>& frame : trial.readings) all.insert(all.end(), frame.begin(), frame.end());
  if (all.empty() || !std::all_of(all.begin(), all.end(), [](float v) { return v >= 0.0F && v == std::floor(v); }))
    return false;
  std::sort(all.begin(), all.end());
  for (const float top : {255.0F, 1023.0F, 4095.0F, 16383.0F, 65535.0F}) {
    const bool rests_there = all.back() <= top && all[all.size() / 2] > 0.9F * top && all.front() < 0.8F * top;
    const auto is_between = [&](float value) { return value > 0.2F * top && value < 0.8F * top; };
    if (!rests_there || std::ranges::none_of(all, is_between)) continue;  // else negative numbers without their sign
    draft.keys.emplace_back("scale", "-1.0");
    draft.keys.emplace_back("offset", std::to_string(static_cast<int>(top)) + ".0");
    if (trial.has_empty_array) draft.keys.emplace_back("absent", "0");
    draft.reasons.push_back("most readings are near " + std::to_string(static_cast<int>(top)) +
                            " and some far below: pressing lowers them");
    return true;
  }
  return false;
}

/// A number far from all others may stand for no reading.
void doubt_absent(const Readings& readings, Draft& draft) {
  std::vector<float> all;
  for (const std::vector<float>& frame : readings) all.insert(all.end(), frame.begin(), frame.end());
  for (const float number : {-1.0F, 65535.0F, 4294967295.0F}) {
    const auto is_it = [&](float value) { return value == number; };
    const auto is_beyond = [&](float value) { return number < 0.0F ? value < 0.0F : value > number / 2.0F; };
    const auto count = std::ranges::count_if(all, is_it);
    if (count == 0 || std::ranges::count_if(all, is_beyond) > count || std::ranges::all_of(all, is_it)) continue;
    const std::string text = std::to_string(static_cast<std::int64_t>(number));
    draft.doubts.push_back(std::string("some readings are ")
                               .append(text)
                               .append(", far from all others: write absent = ")
                               .append(text)
                               .append(" where it stands for none"));
  }
}

/// Bytes in hexadecimal digits of which every second one is small.
void doubt_halves(const Readings& readings, Draft& draft) {
  const bool is_hexadecimal = std::ranges::any_of(draft.keys, [](const auto& key) { return key.first == "digits"; });
  std::array<float, 2> most{};
  for (const std::vector<float>& frame : readings) {
    for (std::size_t k = 0; k < frame.size(); ++k) most[k % 2] = std::max(most[k % 2], frame[k]);
  }
  const auto [smaller, larger] = std::minmax(most[0], most[1]);
  if (!is_hexadecimal || smaller > 15.0F || larger < 128.0F || larger > 255.0F) return;
  draft.doubts.emplace_back(
      "every second byte is small: two may be one reading; make bytes of these digits "
      "('xxd -r -p'), and describe those");
}

void doubt_readings(const Readings& readings, Draft& draft) {
  doubt_absent(readings, draft);
  doubt_halves(readings, draft);
}

bool are_whole(const Readings& readings) {
  return std::all_of(readings.begin(), readings.end(), [](const std::vector<float>& frame) {
    return std::all_of(frame.begin(), frame.end(),
                       [](float value) { return !std::isfinite(value) || value == std::floor(value); });
  });
}

std::vector<float> frame_that_differs_most(const Readings& readings) {
  const auto range = [](const std::vector<float>& frame) {
    const auto [least, most] = std::minmax_element(frame.begin(), frame.end());
    return std::isfinite(*most - *least) ? *most - *least : 0.0F;
  };
  const auto best = std::max_element(readings.begin(), readings.end(),
                                     [&](const auto& a, const auto& b) { return range(a) < range(b); });
  return best == readings.end() ? std::vector<float>() : *best;
}

std::string question_of(const Draft& draft, const Known& known) {
  const FrameShape& shape = draft.arrays.front().shape;
  const std::string text = "rows=" + std::to_string(shape.rows) + ", cols=" + std::to_string(shape.cols);
  const std::string arrays = draft.arrays.size() > 1 ? std::to_string(draft.arrays.size()) + " arrays, each " : "";
  const bool is_certain = draft.has_certain_shape || (known.rows && known.cols);
  return draft.look + ": " + arrays + text + (is_certain ? "" : "?");
}

std::vector<std::string> open_keys(const Draft& draft, const Readings& readings, const Known& known) {
  std::vector<std::string> open;
  if (!draft.has_certain_shape && !known.rows) open.emplace_back("rows");
  if (!draft.has_certain_shape && !known.cols) open.emplace_back("cols");
  if (!draft.has_certain_unit && known.unit.empty() && !are_whole(readings)) open.emplace_back("unit");
  return open;
}

struct Judged {
  Proposal proposal{};
  double merit = 0.0;
};

void add_known_keys(const Known& known, Draft& draft) {
  if (!known.start.empty()) draft.keys.emplace_back("start", known.start);
  if (!known.request.empty()) draft.keys.emplace_back("request", known.request);
  if (!known.unit.empty()) draft.keys.emplace_back("unit", files::quoted_toml(known.unit));
}

std::optional<Judged> judge(Draft draft, std::span<const std::uint8_t> bytes, const Known& known) {
  const bool is_tiny =
      draft.arrays.front().shape.taxel_count() < (draft.line.empty() ? kFewestTaxels : kFewestTaxelsOfLines);
  if (is_tiny && !known.rows && !known.cols) return std::nullopt;
  add_known_keys(known, draft);
  std::optional<Trial> trial = try_layout(toml_of(draft), bytes);
  if (!trial || trial->frames == 0) return std::nullopt;
  const double left = static_cast<double>(trial->left) / static_cast<double>(bytes.size());
  // The first and the last frame may be cut.
  const double frame = (1.0 - left) / static_cast<double>(trial->frames);
  if (left - std::min(2.0 * frame, 0.5 * (1.0 - left)) > kMostLeft) return std::nullopt;
  const double along = roughness_along(trial->readings);
  const double in_time = roughness_in_time(trial->readings);
  if (draft.is_weak && along > kNoise && in_time > kNoise) return std::nullopt;
  const bool is_changed = describe_falling(*trial, draft);
  if (!is_changed) doubt_readings(trial->readings, draft);
  Judged judged{.merit = draft.merit + (1.0 - left) - 0.3 * along - 0.2 * in_time};
  Proposal& proposal = judged.proposal;
  proposal.toml = toml_of(draft);
  if (is_changed) trial = try_layout(proposal.toml, bytes);
  proposal.summary = question_of(draft, known);
  proposal.reasons = std::move(draft.reasons);
  proposal.doubts = std::move(draft.doubts);
  proposal.left_over = std::move(draft.left_over);
  if (!draft.packet.empty() && trial->left > 0) {
    proposal.left_over.push_back(std::to_string(trial->left) + " of " + std::to_string(bytes.size()) +
                                 " bytes belong to no packet");
  }
  proposal.parts = std::move(draft.parts);
  std::sort(proposal.parts.begin(), proposal.parts.end(),
            [](const Part& a, const Part& b) { return a.begin < b.begin; });
  proposal.open = open_keys(draft, trial->readings, known);
  proposal.frames = trial->frames;
  proposal.left_share = left;
  proposal.shape = draft.arrays.front().shape;
  proposal.arrays = draft.arrays.size();
  proposal.merit = judged.merit;
  proposal.example = frame_that_differs_most(trial->readings);
  return judged;
}

/// The value of a key of a proposal in TOML.
std::string_view value_of(const Proposal& proposal, std::string_view key) {
  const std::string line = "\n" + std::string(key) + " = ";
  const std::size_t at = proposal.toml.find(line);
  if (at == std::string::npos) return {};
  const std::string_view rest = std::string_view(proposal.toml).substr(at + line.size());
  return rest.substr(0, rest.find('\n'));
}

/// The first thing to look at that tells two layouts apart.
std::string difference_of(const Proposal& one, const Proposal& other) {
  if (one.arrays != other.arrays) return "press one array: only its own readings may rise";
  if (one.shape != other.shape && value_of(one, "line") == value_of(other, "line") &&
      value_of(one, "packet") == value_of(other, "packet"))
    return "press a corner: in the right shape it is a corner of the map";
  return "press one taxel: in the right layout one place of the map rises, and the others rest";
}

/// Layouts that fit as well as the first are a doubt of it.
void tell_apart(std::vector<Proposal>& proposals) {
  for (std::size_t k = 1; k < proposals.size(); ++k) {
    if (proposals[k].merit < proposals.front().merit - kAsGood) break;
    proposals.front().doubts.push_back("layout " + std::to_string(k + 1) +
                                       " fits as well: " + difference_of(proposals.front(), proposals[k]));
  }
}

}  // namespace

std::vector<Proposal> propose(std::span<const std::uint8_t> bytes, const Known& known) {
  bytes = bytes.first(std::min(bytes.size(), kMostBytes));
  if (bytes.size() < kFewestBytes) return {};
  const std::vector<Draft> drafts =
      is_text(bytes) ? text_drafts({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, known)
                     : packet_drafts(bytes, known);
  std::vector<Judged> all;
  for (const Draft& draft : drafts) {
    const auto is_same = [&](const Judged& other) { return other.proposal.toml == toml_of(draft); };
    if (std::any_of(all.begin(), all.end(), is_same)) continue;
    if (std::optional<Judged> judged = judge(draft, bytes, known)) all.push_back(*std::move(judged));
  }
  std::stable_sort(all.begin(), all.end(), [](const Judged& a, const Judged& b) { return a.merit > b.merit; });
  std::vector<Proposal> proposals;
  for (Judged& one : all) {
    if (proposals.size() < kMostProposals) proposals.push_back(std::move(one.proposal));
  }
  tell_apart(proposals);
  return proposals;
}

}  // namespace dermis::bytes::proposals
