// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "bytes/formats/imported_frame.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/formats/imports.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::size_t kMostFileBytes = std::size_t{1} << 24U;
constexpr std::size_t kMostPictures = 1'000'000;

/// A file in memory, and what libpng finds in it. libpng leaves its functions by longjmp(): none of ours on the way has
/// anything to destroy.
struct Decoding {
  std::string_view bytes;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::size_t row_bytes = 0;
  std::size_t sample_bytes = 1;
};

void take_bytes(png_structp png, png_bytep into, png_size_t size) {
  auto& decoding = *static_cast<Decoding*>(png_get_io_ptr(png));
  if (decoding.bytes.size() < size) png_error(png, "is cut short");
  std::memcpy(into, decoding.bytes.data(), size);
  decoding.bytes.remove_prefix(size);
}

void take_error(png_structp png, png_const_charp message) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = message;
  png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

bool read_header(Decoding& decoding, FrameShape& shape) {
  if (setjmp(png_jmpbuf(decoding.png)) != 0) return false;  // NOLINT(cert-err52-cpp): libpng knows no other way
  png_set_read_fn(decoding.png, &decoding, take_bytes);
  png_set_user_limits(decoding.png, kMaxLines, kMaxLines);
  // Texts and profiles are passed over: unpacked, they may take any memory.
  png_set_keep_unknown_chunks(decoding.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_read_info(decoding.png, decoding.info);
  const int colour = png_get_color_type(decoding.png, decoding.info);
  if (colour != PNG_COLOR_TYPE_GRAY && colour != PNG_COLOR_TYPE_GRAY_ALPHA) {
    png_error(decoding.png, "is coloured; save it as grey levels");
  }
  png_set_packing(decoding.png);  // levels of 1, 2 and 4 bits: a byte each, as they are
  png_set_strip_alpha(decoding.png);
  png_set_interlace_handling(decoding.png);
  png_read_update_info(decoding.png, decoding.info);
  shape = {png_get_image_height(decoding.png, decoding.info), png_get_image_width(decoding.png, decoding.info)};
  decoding.row_bytes = png_get_rowbytes(decoding.png, decoding.info);
  decoding.sample_bytes = png_get_bit_depth(decoding.png, decoding.info) == 16 ? 2 : 1;
  return true;
}

bool read_rows(Decoding& decoding, png_bytepp rows) {
  if (setjmp(png_jmpbuf(decoding.png)) != 0) return false;  // NOLINT(cert-err52-cpp)
  png_read_image(decoding.png, rows);
  return true;
}

/// The pictures of a folder.
Result<std::vector<std::string>> pictures_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (at->path().extension() == ".png") names.push_back(at->path().filename().string());
    if (names.size() > kMostPictures) return bad_input(folder + ": has more than a million pictures");
  }
  if (error) return bad_input("cannot open " + files::in_quotes(folder) + ": " + error.message());
  if (names.empty()) return bad_input(folder + ": is a folder without .png files");
  return names;
}

std::size_t digits_at(std::string_view text) {
  return std::min(text.find_first_not_of("0123456789"), text.size());
}

/// "frame2.png" before "frame10.png".
bool is_before(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    const std::size_t in_a = digits_at(a);
    const std::size_t in_b = digits_at(b);
    if (in_a == 0 || in_b == 0) {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
      continue;
    }
    const auto number = [](std::string_view digits) {
      return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
    };
    const std::string_view one = number(a.substr(0, in_a));
    const std::string_view other = number(b.substr(0, in_b));
    if (one.size() != other.size()) return one.size() < other.size();
    if (one != other) return one < other;
    a.remove_prefix(in_a);
    b.remove_prefix(in_b);
  }
  return a.size() < b.size();
}

class PngStack final : public FrameSource {
 public:
  PngStack(std::vector<std::string> paths, const ImportOptions& options)
      : paths_(std::move(paths)), options_(options) {}

  /// Reads the first picture.
  Status open() {
    const Result<GreyPicture> first = read(0);
    if (!first) return first.error();
    shape_ = first->shape;
    return check_shape(paths_[0], shape_, options_.shape);
  }

  Result<bool> next(RawFrame& frame) override {
    if (next_ == paths_.size()) return false;
    const Result<GreyPicture> picture = read(next_);
    if (!picture) return picture.error();
    if (const Status same = check_shape(paths_[next_], picture->shape, shape_); !same) return same.error();
    const Result<Nanos> time = time_of_frame(paths_[next_], next_, *options_.rate_hz);
    if (!time) return time.error();
    begin_frame(frame, *time);
    frame.counts.assign(picture->levels.begin(), picture->levels.end());
    ++next_;
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_; }
  [[nodiscard]] std::string place() const override { return paths_[next_ == 0 ? 0 : next_ - 1]; }

 private:
  [[nodiscard]] Result<GreyPicture> read(std::size_t index) const {
    const Result<std::string> bytes = files::read_file(paths_[index], kMostFileBytes);
    if (!bytes) return bytes.error();
    return read_grey_png(*bytes, paths_[index]);
  }

  std::vector<std::string> paths_;
  ImportOptions options_;
  FrameShape shape_;
  std::size_t next_ = 0;
};

}  // namespace

Result<GreyPicture> read_grey_png(std::string_view bytes, const std::string& name) {
  std::string message;
  Decoding decoding{bytes};
  decoding.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, take_error, ignore_warning);
  if (decoding.png == nullptr) return failed("cannot read " + files::in_quotes(name) + ": libpng has no memory");
  decoding.info = png_create_info_struct(decoding.png);
  GreyPicture picture;
  std::vector<png_byte> samples;
  std::vector<png_bytep> rows;
  bool is_read = decoding.info != nullptr && read_header(decoding, picture.shape);
  if (is_read) {
    samples.resize(picture.shape.rows * decoding.row_bytes);
    for (std::size_t row = 0; row < picture.shape.rows; ++row) rows.push_back(&samples[row * decoding.row_bytes]);
    is_read = read_rows(decoding, rows.data());
  }
  png_destroy_read_struct(&decoding.png, &decoding.info, nullptr);
  if (!is_read) return bad_input(name + ": " + message);
  for (std::size_t row = 0; row < picture.shape.rows; ++row) {
    for (std::size_t col = 0; col < picture.shape.cols; ++col) {
      const png_byte* const sample = rows[row] + col * decoding.sample_bytes;
      const unsigned level = decoding.sample_bytes == 2 ? sample[0] * 256U + sample[1] : sample[0];
      picture.levels.push_back(static_cast<std::uint16_t>(level));
    }
  }
  return picture;
}

Result<std::unique_ptr<FrameSource>> open_png_stack(const std::string& path, const ImportOptions& options) {
  std::vector<std::string> paths{path};
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    Result<std::vector<std::string>> names = pictures_in(path);
    if (!names) return names.error();
    std::sort(names->begin(), names->end(), is_before);
    paths.clear();
    for (const std::string& name : *names) paths.push_back((std::filesystem::path(path) / name).string());
  }
  auto stack = std::make_unique<PngStack>(std::move(paths), options);
  if (const Status opened = stack->open(); !opened) return opened.error();
  return std::unique_ptr<FrameSource>(std::move(stack));
}

}  // namespace dermis::bytes::formats
