// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/shipped_layouts.hpp"

#include <algorithm>
#include <iterator>
#include <string>

#include "bytes/layouts/shipped_texts.hpp"
#include "dermis/bytes/files/config_table.hpp"

namespace dermis::bytes::layouts {
namespace {

ShippedLayout read(const std::array<std::string_view, 2>& text) {
  ShippedLayout shipped{.name = text[0], .toml = text[1]};
  files::ConfigFile file = files::ConfigFile::parse(shipped.toml, std::string(shipped.name)).value();
  std::vector<std::vector<double>> sizes;
  file.number_rows("device.sizes", 2, sizes);
  file.count("device.baud", shipped.baud);
  for (const std::vector<double>& size : sizes) {
    shipped.sizes.push_back({static_cast<std::size_t>(size[0]), static_cast<std::size_t>(size[1])});
  }
  return shipped;
}

}  // namespace

std::shared_ptr<const Layout> ShippedLayout::of(const FrameShape& shape) const {
  const std::string keys = "rows = " + std::to_string(shape.rows) + "\ncols = " + std::to_string(shape.cols) + "\n";
  return std::make_shared<const Layout>(layout_from_toml(std::string(toml) + keys, std::string(name)).value());
}

const std::vector<ShippedLayout>& shipped_layouts() {
  static const std::vector<ShippedLayout> kAll = [] {
    std::vector<ShippedLayout> all;
    std::ranges::transform(shipped_texts(), std::back_inserter(all), read);
    return all;
  }();
  return kAll;
}

}  // namespace dermis::bytes::layouts
