// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/files.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "dermis/out/report/plot.hpp"
#include "out/report/well_formed.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::report {
namespace {

namespace fs = std::filesystem;

Figure figure_of(std::string file, std::size_t panels) {
  const Drawing panel{10.0, 10.0, "a line", "<line class=\"grid\" x1=\"0\" y1=\"0\" x2=\"9\" y2=\"9\"/>\n"};
  return {std::move(file), "title", "caption", std::vector<Drawing>(panels, panel), 2};
}

TEST(ReportFiles, are_the_page_and_each_figure_that_has_panels) {
  const support::TemporaryFolder folder;
  const fs::path directory = folder.file("deep/report");
  ASSERT_TRUE(write_files(directory.string(), {figure_of("drawn.svg", 3), figure_of("empty.svg", 0)}, "<html/>"));
  EXPECT_EQ(support::read_bytes((directory / "index.html").string()), "<html/>");
  EXPECT_EQ(xml_error(support::read_bytes((directory / "drawn.svg").string())), "");
  EXPECT_FALSE(fs::exists(directory / "empty.svg"));
}

TEST(ReportFiles, without_its_figures_there_is_no_page) {
  const support::TemporaryFolder folder;
  const fs::path directory = folder.file("report");
  fs::create_directories(directory / "drawn.svg");  // in the way
  EXPECT_FALSE(write_files(directory.string(), {figure_of("drawn.svg", 1)}, "<html/>"));
  EXPECT_FALSE(fs::exists(directory / "index.html"));
}

TEST(ReportFiles, the_error_names_a_directory_that_cannot_be_made) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("file"), "text");
  const Status written = write_files(folder.file("file/report"), {}, "<html/>");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("file/report"), std::string::npos);
}

}  // namespace
}  // namespace dermis::out::report
