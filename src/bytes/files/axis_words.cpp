// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/files/axis_words.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::string_view kRest = "...";
constexpr std::string_view kAll = ":";
constexpr std::array<std::string_view, 3> kWords = {"frames", "rows", "cols"};

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  while (true) {
    const std::size_t end = std::min(text.find(','), text.size());
    words.emplace_back(trimmed(text.substr(0, end)));
    if (end == text.size()) return words;
    text.remove_prefix(end + 1);
  }
}

/// One word for each axis: "..." and what is not said are ":".
std::optional<std::vector<std::string>> spread(std::vector<std::string> words, std::size_t axes) {
  const auto rest = std::ranges::find(words, kRest);
  const std::size_t said = words.size() - (rest == words.end() ? 0 : 1);
  if (said > axes || std::ranges::count(words, kRest) > 1) return std::nullopt;
  const auto at = rest == words.end() ? words.end() : words.erase(rest);
  words.insert(at, axes - said, std::string(kAll));
  return words;
}

/// An axis that stays, and as what.
struct Kept {
  std::size_t axis;
  std::string word;
};

class Choice {
 public:
  Choice(const NumberArray& array, const ArrayHints& hints) : from_(array), hints_(hints) { to_.begin = array.begin; }

  Result<ChosenArray> choose() {
    const auto words = spread(words_of(hints_.axes), from_.sizes.size());
    if (!words) return error("has not so many axes");
    for (std::size_t axis = 0; axis < words->size(); ++axis) {
      if (!take(axis, (*words)[axis])) return error("has no " + in_quotes((*words)[axis]));
    }
    const bool is_told = std::ranges::any_of(kept_, [](const Kept& kept) { return kept.word != kAll; });
    if (is_told && !sort()) return error("must name three axes frames, rows and cols, each once");
    if (kept_.size() < 2 || kept_.size() > 3)
      return error("leaves " + std::to_string(kept_.size()) + " axes, not three");
    for (const Kept& kept : kept_) {
      to_.sizes.push_back(from_.sizes[kept.axis]);
      to_.steps.push_back(from_.steps[kept.axis]);
    }
    return ChosenArray{std::move(to_), is_told};
  }

 private:
  bool take(std::size_t axis, const std::string& word) {
    if (word == kAll || std::ranges::find(kWords, word) != kWords.end()) {
      kept_.push_back({axis, word});
      return true;
    }
    const auto size = static_cast<std::int64_t>(from_.sizes[axis]);
    std::int64_t index = 0;
    if (!parse_number(word, index) || index >= size || index < -size) return false;
    to_.begin += static_cast<std::size_t>(index < 0 ? index + size : index) * from_.steps[axis];
    return true;
  }

  /// Axes without a word are what is left, in their order.
  bool sort() {
    std::vector<Kept> sorted;
    if (kept_.size() != kWords.size()) return false;
    for (const std::string_view word : kWords) {
      if (std::ranges::count(kept_, word, &Kept::word) > 1) return false;
      auto found = std::ranges::find(kept_, word, &Kept::word);
      if (found == kept_.end()) found = std::ranges::find(kept_, kAll, &Kept::word);
      if (found == kept_.end()) return false;
      sorted.push_back(*found);
      found->word = "taken";
    }
    kept_ = std::move(sorted);
    return true;
  }

  [[nodiscard]] Error error(const std::string& what) const {
    return bad_input("is " + from_.sizes_text() + "; [" + hints_.axes + "] " + what);
  }

  const NumberArray& from_;
  const ArrayHints& hints_;
  NumberArray to_;
  std::vector<Kept> kept_;
};

ChosenArray without_ones(const NumberArray& array) {
  ChosenArray chosen{{{}, {}, array.begin}, false};
  std::size_t excess = array.sizes.size() - std::min<std::size_t>(array.sizes.size(), 3);
  for (std::size_t axis = 0; axis < array.sizes.size(); ++axis) {
    if (array.sizes[axis] == 1 && excess > 0) {
      --excess;
      continue;
    }
    chosen.array.sizes.push_back(array.sizes[axis]);
    chosen.array.steps.push_back(array.steps[axis]);
  }
  return chosen;
}

}  // namespace

ArrayChoice array_choice(const std::string& text) {
  const std::size_t open = text.ends_with(']') ? text.rfind('[') : std::string::npos;
  if (open == std::string::npos) return {text, ""};
  return {text.substr(0, open), text.substr(open + 1, text.size() - open - 2)};
}

Result<ChosenArray> choose_axes(const NumberArray& array, const ArrayHints& hints) {
  if (!hints.axes.empty()) return Choice(array, hints).choose();
  ChosenArray chosen = without_ones(array);
  const std::size_t axes = chosen.array.sizes.size();
  if (axes == 2 || axes == 3) return chosen;
  if (axes < 2) return bad_input("has " + std::to_string(axes) + " dimensions; frames x rows x cols is expected");
  return bad_input("is " + array.sizes_text() + "; take three of its axes, as " + in_quotes(hints.source + "[:, 0]") +
                   " or " + in_quotes(hints.source + "[..., 2]"));
}

}  // namespace dermis::bytes::files
