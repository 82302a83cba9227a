// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/report/network_diagram.hpp"

#include <gtest/gtest.h>

#include "out/report/well_formed.hpp"

namespace dermis::paper {
namespace {

using out::report::Drawing;
using out::report::occurrences;
using out::report::svg_document;
using out::report::xml_error;

/// Segments of all paths of a class.
std::size_t segments(const std::string& elements, const std::string& style) {
  std::size_t count = 0;
  const std::string opening = "class=\"" + style + "\" d=\"";
  for (std::size_t at = elements.find(opening); at != std::string::npos; at = elements.find(opening, at + 1)) {
    const std::size_t start = at + opening.size();
    count += occurrences(elements.substr(start, elements.find('"', start) - start), "L");
  }
  return count;
}

TEST(NetworkDiagram, joins_each_unit_to_the_layer_before) {
  const NetworkDiagram diagram{
      "2-5-1 <&>", {{"in", "", {"x", "y"}}, {"hidden", "log-sigmoid", {"1", "2", "3", "4", "5"}}, {"out", "", {"z"}}}};
  const Drawing drawing = network_diagram(diagram);
  EXPECT_EQ(xml_error(svg_document(drawing)), "");
  EXPECT_EQ(segments(drawing.elements, "link"), 15U);
  EXPECT_EQ(segments(drawing.elements, "own"), 0U);
  EXPECT_EQ(occurrences(drawing.elements, "class=\"unit\""), 8U);
}

TEST(NetworkDiagram, sets_off_connections_of_one_place) {
  const std::vector<std::string> units = {"1", "2", "", "9"};
  NetworkDiagram diagram{"N-N-1", {{"in", "", units}, {"first", "", units}, {"out", "", {"F"}}}, true};
  const std::string elements = network_diagram(diagram).elements;
  EXPECT_EQ(segments(elements, "own"), 3U);
  EXPECT_EQ(segments(elements, "link"), 6U + 3U) << "dots are not joined";
  diagram.shows_own = false;
  EXPECT_EQ(segments(network_diagram(diagram).elements, "link"), 12U);
}

TEST(NetworkDiagram, grows_with_the_largest_layer) {
  NetworkDiagram diagram{"1-1", {{"in", "", {"x"}}, {"out", "", {"y"}}}};
  const double small = network_diagram(diagram).height;
  diagram.layers[0].units.assign(9, "x");
  EXPECT_GT(network_diagram(diagram).height, small);
}

}  // namespace
}  // namespace dermis::paper
