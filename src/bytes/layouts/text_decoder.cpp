// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/text_decoder.hpp"

#include <algorithm>
#include <utility>

#include "bytes/layouts/has_role.hpp"

namespace dermis::bytes::layouts {
namespace {

constexpr std::size_t kLongestReading = 32;
constexpr std::size_t kOtherText = 4096;
constexpr std::uint64_t kNanosOfDay = 86'400'000'000'000;

/// A line holds every array once at most.
std::size_t longest_line(const Layout& layout) {
  std::size_t taxels = 0;
  for (const LayoutArray& array : layout.arrays) taxels += array.shape.taxel_count();
  return kLongestReading * taxels + kOtherText;
}

Moduli moduli_of(const TextLayout& text) {
  return {0, has_role(text.lines, Role::clock) ? kNanosOfDay : 0};
}

bool begins_with(std::span<const std::uint8_t> line, std::string_view text) noexcept {
  return line.size() >= text.size() && std::equal(text.begin(), text.end(), line.begin(), [](char a, std::uint8_t b) {
           return static_cast<std::uint8_t>(a) == b;
         });
}

}  // namespace

TextDecoder::TextDecoder(std::shared_ptr<const Layout> layout, std::size_t array, bool ends_last_line)
    : layout_(std::move(layout)),
      text_(std::get<TextLayout>(layout_->form)),
      array_(array),
      end_byte_(text_.line_end.empty() ? '\n' : static_cast<std::uint8_t>(text_.line_end.back())),
      ends_last_line_(ends_last_line),
      lines_(longest_line(*layout_), end_byte_),
      match_(*layout_, array),
      assembly_(*layout_, array, moduli_of(text_)) {}

void TextDecoder::push(std::span<const std::uint8_t> bytes) {
  if (!breaks_are_blanks()) return lines_.push(bytes);
  unbroken_.assign(bytes.begin(), bytes.end());
  std::replace_if(
      unbroken_.begin(), unbroken_.end(), [](std::uint8_t byte) { return byte == '\n' || byte == '\r'; }, ' ');
  lines_.push(unbroken_);
}

bool TextDecoder::next(RawFrame& frame) {
  if (read_lines(frame, 0)) return true;
  if (!has_ended_) return false;
  if (ends_last_line_ && lines_.has_open_line()) {
    lines_.push({&end_byte_, 1});
    if (read_lines(frame, 1)) return true;
  }
  has_ended_ = is_sending_ = false;
  assembly_.skip(lines_.forget_all());
  assembly_.end_frame();
  return false;
}

/// Up to the next frame. `added`: bytes of the end of the last line that are none of the file.
bool TextDecoder::read_lines(RawFrame& frame, std::size_t added) {
  for (;;) {
    const std::span<const std::uint8_t> line = lines_.next();
    if (line.empty()) return false;
    if (line.back() == end_byte_) ++line_number_;
    const bool is_frame = read(line, line.size() - added, frame);
    frame_end_ = is_frame ? lines_.position() - added : frame_end_;
    lines_.forget();
    is_sending_ = is_sending_ || is_frame;
    if (is_frame) return true;
  }
}

bool TextDecoder::read(std::span<const std::uint8_t> line, std::size_t bytes, RawFrame& frame) {
  const std::span<const std::uint8_t> text = without_end(line);
  const bool has_end = line.back() == end_byte_;
  if (has_end && ends_frame(text)) {
    assembly_.end_frame();
  } else if (has_end && !is_comment(text)) {
    const bool begins_frame = !text_.frame_begin.empty() && begins_with(text, text_.frame_begin);
    if (begins_frame) assembly_.end_frame();
    if (match_.read(text, piece_)) return add(bytes, frame);
    if (begins_frame && match_.read(text.subspan(text_.frame_begin.size()), piece_)) return add(bytes, frame);
    if (counts().frames == 0 && !text.empty()) keep_misfit();
  }
  assembly_.skip(bytes);
  return false;
}

/// The first line, and the first that fails for another reason: a head comes before the lines that matter.
void TextDecoder::keep_misfit() {
  if (misfits_.size() > 1 || (!misfits_.empty() && misfits_.front().why == match_.why())) return;
  misfits_.push_back(
      {match_.why(), "line " + std::to_string(line_number_) + " does not fit layout.line " + match_.misfit()});
}

/// The line fits. A head of a frame ends the frame before it.
bool TextDecoder::add(std::size_t bytes, RawFrame& frame) {
  if (!match_.is_head()) return assembly_.add(piece_, match_.numbers(), bytes, frame);
  if (match_.begins_frame() && piece_.array == array_) assembly_.end_frame();
  assembly_.skip(bytes);
  return false;
}

/// Without a byte order mark, too.
std::span<const std::uint8_t> TextDecoder::without_end(std::span<const std::uint8_t> line) const noexcept {
  const bool is_first = line_number_ == 1;
  if (is_first && begins_with(line, "\xEF\xBB\xBF")) line = line.subspan(3);
  while (breaks_are_blanks() && line.size() > 1 && line.front() == ' ') line = line.subspan(1);
  std::size_t size = line.size();
  if (!line.empty() && line.back() == end_byte_) --size;
  if (text_.line_end.empty()) {
    if (size > 0 && line[size - 1] == '\r') --size;
    return line.first(size);
  }
  for (std::size_t k = text_.line_end.size() - 1; k > 0 && size > 0; --k, --size) {
    if (line[size - 1] != static_cast<std::uint8_t>(text_.line_end[k - 1])) break;
  }
  return line.first(size);
}

bool TextDecoder::is_comment(std::span<const std::uint8_t> line) const noexcept {
  return !text_.comment.empty() && begins_with(line, text_.comment);
}

bool TextDecoder::ends_frame(std::span<const std::uint8_t> line) const noexcept {
  if (!text_.frame_end) return false;
  return text_.frame_end->empty() ? line.empty() : begins_with(line, *text_.frame_end);
}

std::string TextDecoder::advice() const {
  if (counts().frames > 0) return {};
  std::string text = assembly_.advice();
  if (text.empty() && misfits_.empty()) {
    return line_number_ > 0 ? "no line holds readings"
                            : "no line ends in them: give layout.line_end, the byte that ends one";
  }
  for (auto misfit = misfits_.rbegin(); misfit != misfits_.rend(); ++misfit)
    text.insert(0, misfit->text + (text.empty() ? "" : "; "));
  return text;
}

}  // namespace dermis::bytes::layouts
