// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/evaluation_report.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "out/report/sample_evaluation.hpp"
#include "out/report/well_formed.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::report {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  return support::read_bytes(path.string());
}

class ReportTest : public testing::Test {
 protected:
  /// Writes the report, checks every file of it and returns their names.
  std::set<std::string> write(const learn::calibration::Evaluation& evaluation) {
    const Status written = write_evaluation_report(directory_.string(), evaluation, sample_model(evaluation));
    EXPECT_TRUE(written.has_value());
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(directory_)) {
      names.insert(entry.path().filename().string());
      const std::string text = read(entry.path());
      EXPECT_EQ(xml_error(text), "") << entry.path();
      EXPECT_FALSE(has_bad_number(text)) << entry.path();
    }
    page_ = read(directory_ / "index.html");
    return names;
  }

  [[nodiscard]] bool says(std::string_view words) const { return page_.find(words) != std::string::npos; }

  support::TemporaryFolder folder_;
  fs::path directory_ = folder_.file("report");  // not there yet
  std::string page_;
};

const std::set<std::string> kAllFiles = {"index.html",
                                         "calibration_vs_output.svg",
                                         "error_vs_force.svg",
                                         "error_vs_contacts.svg",
                                         "error_vs_temperature.svg",
                                         "error_vs_supply.svg",
                                         "coverage.svg",
                                         "tactile_1.svg",
                                         "tactile_2.svg"};

TEST_F(ReportTest, writes_the_page_and_every_figure) {
  EXPECT_EQ(write(sample_evaluation(16, 16, 300)), kAllFiles);
  EXPECT_TRUE(says("2,400 loaded taxels of at least 1 N, from 300 labelled frames."));
  EXPECT_TRUE(says("temperature look-up"));
  EXPECT_TRUE(says("one in 2 is drawn"));
  EXPECT_TRUE(says("9f86d081884c7d65")) << "provenance";
  EXPECT_TRUE(says("BP networks of 2-4-1 units"));
}

TEST_F(ReportTest, the_marks_of_all_estimators_stand_at_the_x_of_their_bin) {
  write(sample_evaluation(16, 16, 300));
  const std::string figure = read(directory_ / "error_vs_contacts.svg");
  constexpr std::string_view kCurve = "class=\"curve\" d=\"";
  std::set<std::string> beginnings;
  std::size_t curves = 0;
  for (std::size_t at = figure.find(kCurve); at != std::string::npos; at = figure.find(kCurve, at + 1), ++curves) {
    const std::size_t begin = at + kCurve.size();
    beginnings.insert(figure.substr(begin, figure.find(' ', begin) - begin));
  }
  EXPECT_EQ(curves, 4U);
  EXPECT_EQ(beginnings.size(), 1U);
}

TEST_F(ReportTest, shows_the_longest_touch_over_time_and_its_loop) {
  learn::calibration::Evaluation evaluation = empty_sample(2, 2);
  for (std::size_t frame = 0; frame < 60; ++frame) {
    const double newtons = frame < 20 ? 5.0 : (frame < 40 ? 10.0 : 5.0);
    const auto felt = static_cast<float>(frame < 40 ? 0.98 * newtons : 1.02 * newtons);
    learn::calibration::JudgedTaxel taxel{frame, 2, newtons, {}, {}, 1, {felt, felt, felt, felt}, 0.1F};
    taxel.touch = {0.1 * static_cast<double>(frame), frame >= 40};
    evaluation.taxels.push_back(taxel);
  }
  summarise_sample(evaluation);
  EXPECT_TRUE(write(evaluation).contains("touch_over_time.svg"));
  EXPECT_TRUE(says("A touch over time"));
  EXPECT_TRUE(says("unloading"));
  write(sample_evaluation(4, 4, 20));
  EXPECT_TRUE(says("No load was seen coming, so there is no touch over time."));
}

TEST_F(ReportTest, shows_how_sure_it_is_and_the_bound) {
  learn::calibration::Evaluation evaluation = sample_evaluation(16, 16, 300);
  evaluation.bound = {20, 160, 0.0045, 0.0061, 1.34};
  write(evaluation);
  EXPECT_TRUE(says("The true force of 2,400 taxels is within the 68 % interval of dermis in"));
  EXPECT_TRUE(
      says("Cramer-Rao bound: 0.45 % of the force (median of 160 taxels of 20 frames); dermis scatters by 0.61 %"));
  EXPECT_TRUE(says("is of all 2,400, not of these 160"));
  evaluation.bound.median_bound = 0.001;
  write(evaluation);
  EXPECT_FALSE(says("lower than the bound")) << "the median error is above it";
}

TEST_F(ReportTest, explains_the_largest_error_in_its_tile) {
  learn::calibration::Evaluation evaluation = sample_evaluation(4, 4, 20);
  learn::calibration::JudgedTaxel heavy = evaluation.taxels.back();
  heavy.frame = 20;
  heavy.true_newtons = 48.0;
  heavy.newtons.assign(4, 48.0F);
  evaluation.taxels.push_back(heavy);
  evaluation.taxels.push_back(heavy);
  evaluation.taxels.back().taxel = 6;
  evaluation.taxels.back().true_newtons = 1.0;
  evaluation.taxels.back().newtons.assign(4, 1.3F);
  summarise_sample(evaluation);
  write(evaluation);
  EXPECT_TRUE(says("r1c2 in frame 20: 1.3 N, in truth 1.0 N, beside 48 N"));
  evaluation.taxels.back().newtons.front() = std::numeric_limits<float>::quiet_NaN();
  write(evaluation);
  EXPECT_TRUE(says("r1c2 in frame 20: no force, in truth 1.0 N, beside 48 N"));
}

TEST_F(ReportTest, says_where_its_frames_come_from) {
  const learn::calibration::Evaluation evaluation = paper_sample();
  const Origin origin{"Simulated frames (sim:paper?seed=3).", {{"frames", "frames.csv, fnv1a64:0123"}}};
  const std::string page = evaluation_page(evaluation, sample_model(evaluation), origin);
  EXPECT_EQ(xml_error(page), "");
  EXPECT_NE(page.find("<p>Simulated frames (sim:paper?seed=3).</p>"), std::string::npos);
  EXPECT_NE(page.find("<th>frames</th><td>frames.csv, fnv1a64:0123</td>"), std::string::npos);
}

TEST_F(ReportTest, loads_nothing_from_elsewhere) {
  write(sample_evaluation(4, 4, 20));
  for (const char* part : {"<script", "src=", "href=", "@import", "url("}) EXPECT_FALSE(says(part)) << part;
}

TEST_F(ReportTest, shows_the_paper_levels_against_action_points) {
  write(paper_sample());
  EXPECT_TRUE(says("action point"));
  EXPECT_TRUE(says("Largest relative error at 10, 20, 50 N: dermis "));
  EXPECT_TRUE(says(">16</text>"));
}

TEST_F(ReportTest, says_what_could_not_be_judged) {
  const std::set<std::string> names = write(totals_sample());
  EXPECT_EQ(names, (std::set<std::string>{"index.html", "calibration_vs_output.svg", "error_vs_force.svg"}));
  EXPECT_TRUE(says("200 totals over several taxels"));
  EXPECT_TRUE(says("RMSE of totals"));
  EXPECT_FALSE(says("median error"));
  EXPECT_TRUE(says("No temperature is known"));
  EXPECT_TRUE(says("No supply voltage is known"));
  EXPECT_TRUE(says("No single taxels were judged"));
}

TEST_F(ReportTest, takes_an_empty_evaluation) {
  EXPECT_EQ(write({}), std::set<std::string>{"index.html"});
  EXPECT_TRUE(says("No estimator was judged."));
}

TEST_F(ReportTest, takes_estimators_that_judged_nothing) {
  EXPECT_EQ(write(empty_sample(4, 4)), std::set<std::string>{"index.html"});
  EXPECT_TRUE(says("unloaded taxels only"));
}

TEST_F(ReportTest, takes_one_taxel_judged_once) {
  learn::calibration::Evaluation evaluation = empty_sample(1, 1);
  evaluation.judged_from_n = 1.0;
  evaluation.frames = 1;
  evaluation.frames_rejected = 1;
  evaluation.taxels.push_back({0, 0, 10.0, 20.0, 5.0, 1, {10.0F, 0.0F, 1e30F, 9.0F}, 0.1F});
  summarise_sample(evaluation);
  evaluation.examples = {{0, {0.5}, {1e-3}, {10.0F}, {10.0}}};
  write(evaluation);
  EXPECT_TRUE(says("1 loaded taxel of at least 1 N, from 1 labelled frame; 1 more frame rejected."));
  EXPECT_TRUE(says("<b>0 %</b>"));
}

TEST_F(ReportTest, says_where_an_estimator_gives_no_force) {
  learn::calibration::Evaluation evaluation = sample_evaluation(32, 32, 50);
  for (auto& taxel : evaluation.taxels) {
    if (taxel.taxel % 3 == 0) taxel.newtons[0] = std::numeric_limits<float>::quiet_NaN();
    taxel.newtons[1] = std::numeric_limits<float>::infinity();
  }
  evaluation.examples[0].newtons[5] = std::numeric_limits<float>::quiet_NaN();
  summarise_sample(evaluation);
  EXPECT_EQ(write(evaluation), kAllFiles);
  EXPECT_TRUE(says("<b>no force</b>"));
  EXPECT_TRUE(says("raw look-up gives no force for 400 of 400; they are not drawn."));
  EXPECT_TRUE(says("What reaches the upper edge includes taxels without any force."));
  EXPECT_TRUE(says("0.0 %</td>")) << "within 5 %";
}

TEST_F(ReportTest, shows_one_estimator_without_another) {
  learn::calibration::Evaluation evaluation = sample_evaluation(4, 4, 20);
  evaluation.estimators.resize(1);
  for (auto& taxel : evaluation.taxels) taxel.newtons.resize(1);
  summarise_sample(evaluation);
  write(evaluation);
  EXPECT_FALSE(says("best other"));
  EXPECT_FALSE(says("class=\"best\""));
}

TEST_F(ReportTest, marks_the_best_even_where_it_is_a_baseline) {
  learn::calibration::Evaluation evaluation = sample_evaluation(4, 4, 20);
  evaluation.estimators[2].relative_error.median = 1e-4;
  write(evaluation);
  EXPECT_TRUE(says("<td class=\"best\">0.010 %</td>"));
  EXPECT_TRUE(says("best other: 0.010 %"));
}

TEST_F(ReportTest, escapes_names) {
  learn::calibration::Evaluation evaluation = sample_evaluation(4, 4, 20);
  evaluation.array.name = "</style><script>\xff";
  evaluation.estimators[1].name = "a&b<i>\"";
  write(evaluation);
  EXPECT_FALSE(says("<script>"));
  EXPECT_TRUE(says("a&amp;b&lt;i&gt;&quot;"));
}

TEST_F(ReportTest, replaces_an_earlier_report) {
  write(sample_evaluation(4, 4, 20));
  const std::string first = page_;
  write(sample_evaluation(4, 4, 20));
  EXPECT_EQ(page_, first) << "deterministic";
  EXPECT_EQ(page_, evaluation_page(sample_evaluation(4, 4, 20), sample_model(sample_evaluation(4, 4, 20))));
}

TEST_F(ReportTest, names_a_directory_that_cannot_be_made) {
  fs::create_directories(directory_);
  std::ofstream(directory_ / "file") << "text";
  const learn::calibration::Evaluation evaluation = paper_sample();
  const Status written =
      write_evaluation_report((directory_ / "file" / "report").string(), evaluation, sample_model(evaluation));
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().kind, ErrorKind::failed);
  EXPECT_NE(written.error().message.find("file/report"), std::string::npos);
  EXPECT_EQ(written.error().message.find('\n'), std::string::npos);
}

TEST_F(ReportTest, leaves_nothing_half_written) {
  fs::create_directories(directory_ / "error_vs_force.svg");  // In the way of a file.
  const learn::calibration::Evaluation evaluation = paper_sample();
  ASSERT_FALSE(write_evaluation_report(directory_.string(), evaluation, sample_model(evaluation)).has_value());
  EXPECT_FALSE(fs::exists(directory_ / "index.html"));
  for (const auto& entry : fs::directory_iterator(directory_)) {
    EXPECT_TRUE(entry.is_directory() || xml_error(read(entry.path())).empty()) << entry.path();
    EXPECT_EQ(entry.path().extension(), ".svg");
  }
}

}  // namespace
}  // namespace dermis::out::report
