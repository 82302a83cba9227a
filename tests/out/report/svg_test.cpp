// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/svg.hpp"

#include <gtest/gtest.h>

#include "out/report/well_formed.hpp"

namespace dermis::out::report {
namespace {

TEST(EscapeXml, escapes_markup_in_elements_and_attributes) {
  EXPECT_EQ(escape_xml("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
  EXPECT_EQ(escape_xml(""), "");
}

TEST(EscapeXml, keeps_utf8_and_replaces_what_xml_forbids) {
  const std::string replaced = "\xEF\xBF\xBD";
  EXPECT_EQ(escape_xml("20 \u00b0C \u2264 \U0001F600\n"), "20 \u00b0C \u2264 \U0001F600\n");
  EXPECT_EQ(escape_xml(std::string("a\0b\x1b", 4)), "a" + replaced + "b" + replaced);
  EXPECT_EQ(escape_xml("\xff"), replaced);
  EXPECT_EQ(escape_xml("\xc3"), replaced) << "cut off";
  EXPECT_EQ(escape_xml("\xc0\xaf"), replaced + replaced) << "overlong";
  EXPECT_EQ(escape_xml("\xed\xa0\x80"), replaced + replaced + replaced) << "surrogate";
}

TEST(WellFormedChecker, finds_what_is_wrong) {
  EXPECT_EQ(xml_error("<?xml version=\"1.0\"?>\n<a><b x=\"1\"/>t</a>\n"), "");
  for (const char* bad : {"<a>", "<a></b>", "<a x=1/>", "<a x=\"<\"/>", "<a>&nbsp;</a>", "<a/><a/>",
                          "<a x=\"1\" x=\"2\"/>", "text", "<a>></a>", "<a x=\"1\"y=\"2\"/>"}) {
    EXPECT_NE(xml_error(bad), "") << bad;
  }
  EXPECT_TRUE(has_bad_number("x=\"-nan\""));
  EXPECT_TRUE(has_bad_number("inf"));
  EXPECT_FALSE(has_bad_number("information, nano"));
}

const Drawing kBox{10.0, 20.0, "a <box>", "<rect width=\"10\" height=\"20\"/>\n"};

TEST(SvgDocument, is_well_formed_and_carries_its_style) {
  const std::string document = svg_document(kBox);
  EXPECT_EQ(xml_error(document), "");
  EXPECT_NE(document.find("viewBox=\"0 0 10 20\""), std::string::npos);
  EXPECT_NE(document.find("aria-label=\"a &lt;box&gt;\""), std::string::npos);
  EXPECT_NE(document.find("prefers-color-scheme:dark"), std::string::npos);
  EXPECT_EQ(svg_element(kBox).find("<style>"), std::string::npos);
}

TEST(SideBySide, fills_rows_and_grows_around_them) {
  const std::vector<Drawing> three = {kBox, {30.0, 5.0, "wide", ""}, kBox};
  const Drawing sheet = side_by_side(three, 2);
  EXPECT_EQ(sheet.width, 40.0);
  EXPECT_EQ(sheet.height, 40.0);
  EXPECT_NE(sheet.elements.find("translate(10 0)"), std::string::npos);
  EXPECT_NE(sheet.elements.find("translate(0 20)"), std::string::npos);
  EXPECT_EQ(xml_error(svg_document(sheet)), "");
}

}  // namespace
}  // namespace dermis::out::report
