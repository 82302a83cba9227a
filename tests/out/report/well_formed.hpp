// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace dermis::out::report {

/// A strict little checker of the XML that we write: returns what is wrong first, or "".
class WellFormed {
 public:
  explicit WellFormed(std::string_view text) : rest_(text) {}

  std::string check() {
    skip_prologue("<?", "?>");
    skip_prologue("<!", ">");
    while (error_.empty() && !rest_.empty()) {
      if (rest_.front() == '<') {
        tag();
      } else if (rest_.front() == '&') {
        entity();
      } else {
        character();
      }
    }
    if (error_.empty() && !open_.empty()) error_ = "not closed: " + open_.back();
    if (error_.empty() && roots_ != 1) error_ = "roots: " + std::to_string(roots_);
    return error_;
  }

 private:
  void skip_prologue(std::string_view start, std::string_view end) {
    if (!rest_.starts_with(start)) return;
    rest_.remove_prefix(rest_.find(end) + end.size());
    while (!rest_.empty() && rest_.front() == '\n') rest_.remove_prefix(1);
  }

  void fail(const std::string& what) {
    if (error_.empty()) error_ = what + " at: " + std::string(rest_.substr(0, 60));
  }

  void character() {
    const auto byte = static_cast<unsigned char>(rest_.front());
    if (byte < 0x20 && byte != '\n') fail("control character");
    if (rest_.front() == '>' && !is_style()) fail("bare >");
    if (open_.empty() && !std::isspace(byte)) fail("text outside the root");
    rest_.remove_prefix(1);
  }

  void entity() {
    for (const std::string_view name : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"}) {
      if (rest_.starts_with(name)) return rest_.remove_prefix(name.size());
    }
    fail("bare &");
    rest_ = {};
  }

  std::string name() {
    std::size_t size = 0;
    while (size < rest_.size() && (std::isalnum(static_cast<unsigned char>(rest_[size])) || rest_[size] == '-')) ++size;
    std::string word(rest_.substr(0, size));
    if (word.empty()) fail("name expected");
    rest_.remove_prefix(size);
    return word;
  }

  void tag() {
    rest_.remove_prefix(1);
    if (rest_.starts_with('/')) return close_tag();
    const std::string element = name();
    if (open_.empty()) ++roots_;
    std::vector<std::string> seen;
    while (error_.empty() && rest_.starts_with(' ')) attribute(seen);
    if (rest_.starts_with("/>")) return rest_.remove_prefix(2);
    if (!rest_.starts_with('>')) return fail("> expected");
    rest_.remove_prefix(1);
    open_.push_back(element);
  }

  void close_tag() {
    rest_.remove_prefix(1);
    const std::string element = name();
    if (open_.empty() || open_.back() != element) return fail("closes what is not open: " + element);
    if (!rest_.starts_with('>')) return fail("> expected");
    rest_.remove_prefix(1);
    open_.pop_back();
  }

  void attribute(std::vector<std::string>& seen) {
    rest_.remove_prefix(1);
    std::string key = name();
    for (const std::string& other : seen) {
      if (other == key) fail("attribute twice: " + key);
    }
    seen.push_back(std::move(key));
    if (!rest_.starts_with("=\"")) return fail("=\" expected");
    rest_.remove_prefix(2);
    while (!rest_.empty() && rest_.front() != '"' && error_.empty()) {
      if (rest_.front() == '<') fail("< in an attribute");
      if (rest_.front() == '&') {
        entity();
      } else {
        rest_.remove_prefix(1);
      }
    }
    if (rest_.empty()) return fail("attribute without an end");
    rest_.remove_prefix(1);
  }

  bool is_style() const { return !open_.empty() && open_.back() == "style"; }

  std::string_view rest_;
  std::string error_;
  std::vector<std::string> open_;
  int roots_ = 0;
};

inline std::string xml_error(std::string_view text) {
  return WellFormed(text).check();
}

/// True where "nan" or "inf" stands as a word of its own, in any case and with any sign.
inline bool has_bad_number(std::string_view text) {
  std::string word;
  for (const char byte : std::string(text) + " ") {
    if (std::isalnum(static_cast<unsigned char>(byte))) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(byte)));
      continue;
    }
    if (word == "nan" || word == "inf" || word == "infinity") return true;
    word.clear();
  }
  return false;
}

/// How often `part` stands in `text`.
inline std::size_t occurrences(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

}  // namespace dermis::out::report
