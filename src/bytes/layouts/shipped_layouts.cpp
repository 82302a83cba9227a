// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/shipped_layouts.hpp"

#include <string>

#include "dermis/bytes/files/config_table.hpp"

namespace dermis::bytes::layouts {
ShippedLayout read_shipped(std::string_view name, std::string_view toml) {
  ShippedLayout shipped{.name = name, .toml = toml};
  files::ConfigFile file = files::ConfigFile::parse(toml, std::string(name)).value();
  std::vector<std::vector<double>> sizes;
  file.number_rows("device.sizes", 2, sizes);
  file.count("device.baud", shipped.baud);
  for (const std::vector<double>& size : sizes) {
    shipped.sizes.push_back({static_cast<std::size_t>(size[0]), static_cast<std::size_t>(size[1])});
  }
  return shipped;
}

std::shared_ptr<const Layout> ShippedLayout::of(const FrameShape& shape) const {
  const std::string keys = "rows = " + std::to_string(shape.rows) + "\ncols = " + std::to_string(shape.cols) + "\n";
  return std::make_shared<const Layout>(layout_from_toml(std::string(toml) + keys, std::string(name)).value());
}

}  // namespace dermis::bytes::layouts
