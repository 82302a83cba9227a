// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "gif.hpp"

#include <gif_lib.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>
#include <utility>

namespace dermis::out::report {
namespace {

constexpr std::size_t kColours = 256;

/// giflib writes to memory: nothing fails.
void expect([[maybe_unused]] int result) {
  assert(result == GIF_OK);
}

}  // namespace

Gif::Gif(std::size_t width, std::size_t height, const Film& film)
    : palette_(film.palette), time_cs_(static_cast<int>(film.time.count() / 10)) {
  assert(palette_.size() <= kColours);
  const auto append = [](GifFileType* file, const GifByteType* bytes, int size) {
    static_cast<std::string*>(file->UserData)
        ->append(reinterpret_cast<const char*>(bytes), static_cast<unsigned>(size));
    return size;
  };
  file_ = EGifOpen(&bytes_, append, nullptr);
  EGifSetGifVersion(file_, true);
  std::array<GifColorType, kColours> colours{};
  std::transform(palette_.begin(), palette_.end(), colours.begin(), [](Colour colour) {
    return GifColorType{colour.red, colour.green, colour.blue};
  });
  const std::unique_ptr<ColorMapObject, void (*)(ColorMapObject*)> map(GifMakeMapObject(kColours, colours.data()),
                                                                       GifFreeMapObject);
  expect(EGifPutScreenDesc(file_, static_cast<int>(width), static_cast<int>(height), 8, 0, map.get()));
  expect(EGifPutExtensionLeader(file_, APPLICATION_EXT_FUNC_CODE));
  expect(EGifPutExtensionBlock(file_, 11, "NETSCAPE2.0"));
  expect(EGifPutExtensionBlock(file_, 3, "\1\0\0"));  // for ever
  expect(EGifPutExtensionTrailer(file_));
}

Gif::~Gif() {
  if (file_ != nullptr) EGifCloseFile(file_, nullptr);
}

void Gif::add(const PixelBrush& picture) {
  const GraphicsControlBlock control{DISPOSE_DO_NOT, false, time_cs_, NO_TRANSPARENT_COLOR};
  std::array<GifByteType, 4> extension{};
  EGifGCBToExtension(&control, extension.data());
  expect(EGifPutExtension(file_, GRAPHICS_EXT_FUNC_CODE, extension.size(), extension.data()));
  expect(EGifPutImageDesc(file_, 0, 0, file_->SWidth, file_->SHeight, false, nullptr));
  std::vector<GifPixelType> places(picture.width());
  for (std::size_t y = 0; y < picture.height(); ++y) {
    const auto pixels = picture.line(y);
    std::transform(pixels.begin(), pixels.end(), places.begin(),
                   [this](std::uint32_t pixel) { return nearest(pixel); });
    expect(EGifPutLine(file_, places.data(), static_cast<int>(places.size())));
  }
}

std::string Gif::take() && {
  expect(EGifCloseFile(std::exchange(file_, nullptr), nullptr));
  return std::move(bytes_);
}

std::uint8_t Gif::nearest(std::uint32_t pixel) {
  const auto [found, is_new] = places_.try_emplace(pixel & 0xFFFFFFU);
  if (is_new) {
    const auto distance = [pixel](Colour colour) {
      const int red = static_cast<int>(pixel >> 16U & 0xFFU) - colour.red;
      const int green = static_cast<int>(pixel >> 8U & 0xFFU) - colour.green;
      const int blue = static_cast<int>(pixel & 0xFFU) - colour.blue;
      return red * red + green * green + blue * blue;
    };
    const auto closest = std::min_element(palette_.begin(), palette_.end(),
                                          [&](Colour a, Colour b) { return distance(a) < distance(b); });
    found->second = static_cast<std::uint8_t>(closest - palette_.begin());
  }
  return found->second;
}

}  // namespace dermis::out::report
