// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/page.hpp"

#include <gtest/gtest.h>

#include <string>

#include "out/report/well_formed.hpp"

namespace dermis::out::report {
namespace {

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST(Page, holds_what_it_was_given_as_well_formed_text) {
  Page page("window & name", "title <1>");
  page.heading("Heading");
  page.paragraph("muted words", "muted");
  page.tiles({{"error", "2 %", "of the force"}});
  page.table({"numbers", {{"", 1}, {"group", 1}}, {"name", "value"}, {{2, "row", {{"1.5", "best"}}}}});
  page.facts({{"circuit", "divider"}});
  const std::string html = std::move(page).html();
  EXPECT_EQ(xml_error(html), "");
  EXPECT_TRUE(contains(html, "<title>window &amp; name</title>"));
  EXPECT_TRUE(contains(html, "<h1>title &lt;1&gt;</h1>"));
  EXPECT_TRUE(contains(html, "<h2>Heading</h2>"));
  EXPECT_TRUE(contains(html, "<p class=\"muted\">muted words</p>"));
  EXPECT_TRUE(contains(html, "<b>2 %</b>"));
  EXPECT_TRUE(contains(html, "<td class=\"best\">1.5</td>"));
  EXPECT_TRUE(contains(html, "<th>circuit</th><td>divider</td>"));
}

TEST(Page, numbers_its_figures_and_says_why_one_is_not_drawn) {
  Page page("window", "title");
  page.figure({"a.svg", "First", "Nothing was judged.", {}, 1});
  const Drawing drawing{4.0, 4.0, "a drawing", ""};
  page.figures({{"b.svg", "Second", "", {drawing}, 1}, {"c.svg", "Third", "", {}, 1}});
  const std::string html = std::move(page).html();
  EXPECT_EQ(xml_error(html), "");
  EXPECT_TRUE(contains(html, "<b>Fig. 1. First.</b> Nothing was judged."));
  EXPECT_TRUE(contains(html, "<b>Fig. 2. Second.</b>"));
  EXPECT_TRUE(contains(html, "<b>Fig. 3. Third.</b>"));
  EXPECT_TRUE(contains(html, "aria-label=\"a drawing\""));
}

TEST(Page, sets_the_letter_after_an_omega_as_an_index) {
  Page page("window", "title");
  page.paragraph("\u03c9_A and omega_A");
  const std::string html = std::move(page).html();
  EXPECT_TRUE(contains(html, "\u03c9<sub>A</sub> and omega_A")) << html;
}

}  // namespace
}  // namespace dermis::out::report
