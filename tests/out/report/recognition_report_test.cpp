// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/recognition_report.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "out/report/well_formed.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::report {
namespace {

namespace fs = std::filesystem;

/// Two classes on an array of 2 x 3 taxels; `mistakes` of the four examples are answered with the other class.
struct Sample {
  explicit Sample(std::size_t mistakes) {
    data.layout.arrays = {
        {.name = "skin", .rows = 2, .cols = 3, .first_column = 0, .row_pitch_mm = 5.0, .col_pitch_mm = 4.0}};
    data.layout.readings = 6;
    learned.classes.names = {"<cup>", "pen"};
    learned.classes.examples = {2, 2};
    learned.report.folds = 2;
    learned.report.confusion.assign(4, 0);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t taxel = 0; taxel < 6; ++taxel) data.frames.push_back(static_cast<float>(10 * i + taxel));
      const std::size_t truth = i / 2;
      const std::size_t answer = i < mistakes ? 1 - truth : truth;
      data.labels.push_back({"example" + std::to_string(i), i, i, learned.classes.names[truth]});
      learned.report.judgements.push_back({i, truth, answer, 0.6 + 0.1 * static_cast<double>(i)});
      ++learned.report.confusion[2 * truth + answer];
    }
    learned.report.judged = 4;
    learned.report.accuracy = 1.0 - 0.25 * static_cast<double>(mistakes);
    learned.report.calibration_error = 0.125;
  }

  learn::recognition::LabelledFrames data;
  learn::recognition::Learned learned;
  std::vector<learn::recognition::EstimatorFigures> estimators{
      {"dermis", 0.75, 0.125}, {"nearest frame", 0.5, std::nullopt}, {"BP network", 0.625, 0.25}};
};

TEST(RecognitionReport, shows_figures_estimators_and_the_worst_errors) {
  const Sample sample(2);
  const support::TemporaryFolder folder;
  const fs::path directory = folder.file("report");
  ASSERT_TRUE(write_recognition_report(directory.string(), sample.data, sample.learned, sample.estimators));
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory)) {
    names.insert(entry.path().filename().string());
    const std::string text = support::read_bytes(entry.path().string());
    EXPECT_EQ(xml_error(text), "") << entry.path();
    EXPECT_FALSE(has_bad_number(text)) << entry.path();
  }
  EXPECT_EQ(names, (std::set<std::string>{"index.html", "confusion.svg", "error_1.svg", "error_2.svg"}));
  const std::string page = support::read_bytes((directory / "index.html").string());
  for (const char* words : {"50.0 %", "12.5 %", "nearest frame", "BP network", "62.5 %", "&lt;cup&gt;",
                            "2 folds in order of time", "needs more examples"}) {
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
  EXPECT_LT(page.find("example1 is"), page.find("example0 is")) << "the surest error comes first";
}

TEST(RecognitionReport, says_that_nothing_was_wrong) {
  const Sample sample(0);
  const std::string page = recognition_page(sample.data, sample.learned, sample.estimators);
  EXPECT_NE(page.find("No example was answered wrongly."), std::string::npos);
  EXPECT_EQ(page.find("example0 is"), std::string::npos);
  EXPECT_EQ(xml_error(page), "");
}

}  // namespace
}  // namespace dermis::out::report
