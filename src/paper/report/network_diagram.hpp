// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/out/report/svg.hpp"

namespace dermis::paper {

/// The layers of a feed-forward network from left to right, each unit joined to all of the layer before it.
struct NetworkDiagram {
  struct Layer {
    std::string name;                ///< Below the layer: "hidden layer".
    std::string remark;              ///< Below its name: "5 log-sigmoid neurons"; may be empty.
    std::vector<std::string> units;  ///< The text in each; at least one. An empty one is drawn as dots and not joined.
  };

  std::string title;
  std::vector<Layer> layers;  ///< At least two; the first is drawn as inputs, which compute nothing.
  bool shows_own = false;     ///< Connections between units at one place of their layers, of the same size, stand out.
};

[[nodiscard]] out::report::Drawing network_diagram(const NetworkDiagram& diagram);

}  // namespace dermis::paper
