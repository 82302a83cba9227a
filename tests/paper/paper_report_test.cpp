// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/paper_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

#include "out/report/well_formed.hpp"
#include "paper/sample_reproduction.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::paper {
namespace {

using out::report::has_bad_number;
using out::report::occurrences;
using out::report::xml_error;

namespace fs = std::filesystem;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string read(const fs::path& path) {
  return support::read_bytes(path.string());
}

class PaperReportTest : public testing::Test {
 protected:
  /// Makes the page and checks its form.
  void make(const PaperReproduction& reproduction) {
    page_ = paper_page(reproduction);
    EXPECT_EQ(xml_error(page_), "");
    EXPECT_FALSE(has_bad_number(page_));
  }

  [[nodiscard]] bool says(std::string_view words) const { return page_.find(words) != std::string::npos; }

  /// The verdict on the claim whose statement contains `said`.
  [[nodiscard]] std::string verdict(std::string_view said) const {
    const std::string opening = "<td class=\"verdict\">";
    const std::size_t at = page_.find(opening, page_.find(said));
    if (at == std::string::npos || page_.find(said) == std::string::npos) return "no such claim";
    const std::size_t start = at + opening.size();
    return page_.substr(start, page_.find('<', start) - start);
  }

  support::TemporaryFolder folder_;
  fs::path directory_ = folder_.file("report");  // not there yet
  std::string page_;
};

constexpr std::string_view kGradientDescent = "trained with traingdx";
constexpr std::string_view kSize = "The structure 2-5-1 is large enough";
constexpr std::string_view kApproximation = "With enough neurons";
constexpr std::string_view kUnknowns = "thresholds: 33,751,296";
constexpr std::string_view kStart = "give starting values";
constexpr std::string_view kConvergence = "the structured start brings it near";
constexpr std::string_view kVoltage = "The output voltage agrees";
constexpr std::string_view kBank = "The relative error of the force is within";
constexpr std::string_view kDermis = "The same for dermis";
constexpr std::string_view kVoltages = "two values for three forces";

TEST_F(PaperReportTest, writes_the_page_and_every_figure) {
  const PaperReproduction reproduction = sample_reproduction();
  ASSERT_TRUE(write_paper_report(directory_.string(), reproduction).has_value());
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory_)) {
    names.insert(entry.path().filename().string());
    const std::string text = read(entry.path());
    EXPECT_EQ(xml_error(text), "") << entry.path();
    EXPECT_FALSE(has_bad_number(text)) << entry.path();
  }
  EXPECT_EQ(names, (std::set<std::string>{"index.html", "paper_fig_05.svg", "paper_fig_06.svg", "paper_fig_08.svg",
                                          "paper_fig_10.svg", "paper_fig_11.svg", "paper_fig_12.svg",
                                          "paper_fig_13.svg", "peaks_maps.svg", "peaks_training.svg",
                                          "peaks_hidden_units.svg", "start_convergence.svg", "bank_training.svg"}));
  EXPECT_EQ(read(directory_ / "index.html"), paper_page(reproduction));
}

TEST_F(PaperReportTest, loads_nothing_from_elsewhere) {
  make(sample_reproduction());
  for (const char* part : {"<script", "src=", "href=", "@import", "url("}) EXPECT_FALSE(says(part)) << part;
}

TEST_F(PaperReportTest, numbers_its_figures_and_names_those_of_the_paper) {
  make(sample_reproduction());
  EXPECT_EQ(occurrences(page_, "<figcaption>"), 12U);
  EXPECT_TRUE(says("<b>Fig. 1. The network for Peaks (the paper&#39;s Fig. 5)."));
  EXPECT_TRUE(says("<b>Fig. 12. Output and calibration at 50 N (the paper&#39;s Fig. 13)."));
  for (const int figure : {5, 6, 8, 9, 10, 11, 12, 13}) {
    EXPECT_TRUE(says("paper&#39;s Fig. " + std::to_string(figure) + ")")) << figure;
  }
}

TEST_F(PaperReportTest, judges_peaks) {
  PaperReproduction reproduction = sample_reproduction();
  make(reproduction);
  EXPECT_EQ(verdict(kGradientDescent), "does not hold");
  EXPECT_EQ(verdict(kSize), "holds on scaled targets only");
  EXPECT_EQ(verdict(kApproximation), "holds");
  EXPECT_TRUE(says("Best E of 20 random starts with 10,000 steps each: 0.634"));
  EXPECT_TRUE(says("<b>0.634</b><span>goal 0.001: not reached</span>"));
  EXPECT_TRUE(
      says("is reached from 10 hidden units on in the units of Peaks, and from 5 hidden units on with targets"));
  EXPECT_TRUE(says("the goal is not reached."));

  reproduction.peaks.adaptive_rate_best_mse = 0.001;
  reproduction.peaks.by_hidden.front().best_mse = 0.0009;
  make(reproduction);
  EXPECT_EQ(verdict(kGradientDescent), "holds");
  EXPECT_EQ(verdict(kSize), "holds");
  EXPECT_TRUE(says("goal 0.001: reached"));
  EXPECT_TRUE(says("the goal is reached."));

  reproduction.peaks.by_hidden.front() = {5, 40, 0.07, 0.00101};
  reproduction.peaks.smallest_hidden_raw.reset();
  reproduction.peaks.smallest_hidden_normalised.reset();
  make(reproduction);
  EXPECT_EQ(verdict(kSize), "does not hold");
  EXPECT_EQ(verdict(kApproximation), "does not hold");
  EXPECT_TRUE(says("with none of the sizes tried"));
}

TEST_F(PaperReportTest, counts_the_unknowns) {
  PaperReproduction reproduction = sample_reproduction();
  make(reproduction);
  EXPECT_EQ(verdict(kUnknowns), "holds");
  for (const char* number : {"33,619,968", "131,328", "131,841", "as the paper says"}) EXPECT_TRUE(says(number));
  reproduction.unknowns = 33751295;
  make(reproduction);
  EXPECT_EQ(verdict(kUnknowns), "does not hold");
  EXPECT_FALSE(says("as the paper says"));
  reproduction.rows = reproduction.cols = 2;
  reproduction.unknowns = 180;  // 4-4-4-1: 36 connections and 9 thresholds.
  make(reproduction);
  EXPECT_EQ(verdict(kUnknowns), "holds");
  EXPECT_TRUE(says("180 unknowns counted in the bank of 4 networks 4-4-4-1; the two formulas say the same."));
}

TEST_F(PaperReportTest, judges_the_structured_start) {
  PaperReproduction reproduction = sample_reproduction();
  make(reproduction);
  EXPECT_EQ(verdict(kStart), "holds");
  EXPECT_TRUE(says("7 systems solved; largest deviation from the printed equations 4.4e-16."));
  EXPECT_TRUE(says("\u03c9<sub>B</sub> = \u03c9<sub>C</sub> = 0 throughout"));
  EXPECT_TRUE(says("<td>0.017166</td><td>-</td><td>-</td><td>-2.1972</td>")) << "eq. (15)";
  EXPECT_EQ(verdict(kConvergence), "holds");
  EXPECT_TRUE(says("structured start: 0.05 \u2192 0.00"));

  reproduction.start[3].residual = 0.1;
  reproduction.start[0].neighbour = 0.25;
  reproduction.convergence[2].value.back() = 1e-6;  // A lucky last batch is not a better start,
  make(reproduction);
  EXPECT_EQ(verdict(kConvergence), "holds");
  auto& values = reproduction.convergence[2].value;
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end(), 0.002);  // but this is.
  make(reproduction);
  EXPECT_EQ(verdict(kStart), "does not hold");
  EXPECT_FALSE(says("= 0 throughout"));
  EXPECT_EQ(verdict(kConvergence), "does not hold");
}

TEST_F(PaperReportTest, judges_the_points_against_five_percent) {
  PaperReproduction reproduction = sample_reproduction();
  make(reproduction);
  EXPECT_EQ(verdict(kVoltage), "holds");
  EXPECT_EQ(verdict(kBank), "does not hold");
  EXPECT_EQ(verdict(kDermis), "holds");
  EXPECT_EQ(verdict(kVoltages), "not judged");
  EXPECT_TRUE(says("48 of 48 points within 5\u00a0%."));
  EXPECT_TRUE(says("class=\"beyond\""));
  EXPECT_EQ(occurrences(page_, "<td>9.") + occurrences(page_, "<td>10.") + occurrences(page_, "<td>11."), 32U)
      << "two forces at each point of 10 N";

  reproduction.points.clear();
  add_sample_points(reproduction, 0.045);
  make(reproduction);
  EXPECT_EQ(verdict(kBank), "holds");
  EXPECT_FALSE(says("class=\"beyond\""));

  reproduction.points[20].bank_newtons = reproduction.points[20].true_newtons * 1.0501;
  make(reproduction);
  EXPECT_EQ(verdict(kBank), "does not hold");
  EXPECT_TRUE(says("47 of 48 points within 5\u00a0%."));
  EXPECT_TRUE(says("20\u00a0N: 5.01\u00a0%")) << "not rounded to 5 %";
}

TEST_F(PaperReportTest, counts_an_estimator_without_force_as_wrong) {
  PaperReproduction reproduction = sample_reproduction();
  reproduction.points[3].dermis_newtons = kNan;
  reproduction.points[3].bank_newtons = kInfinity;
  make(reproduction);
  EXPECT_EQ(verdict(kDermis), "does not hold");
  EXPECT_TRUE(says("10\u00a0N: no force"));
  EXPECT_TRUE(says("dermis gives no force at 1 of 16 points; they are not drawn."));
  EXPECT_TRUE(says("<td class=\"beyond\">no force</td>"));
}

TEST_F(PaperReportTest, sums_up_its_verdicts) {
  PaperReproduction reproduction = sample_reproduction();
  make(reproduction);
  EXPECT_TRUE(says("Of 10 statements, 6 hold, 1 holds on scaled targets only, 2 do not hold and 1 is not judged."));
  reproduction.peaks.adaptive_rate_best_mse = 0.0005;
  make(reproduction);
  EXPECT_TRUE(says("Of 10 statements, 7 hold, 1 holds on scaled targets only, 1 does not hold and 1 is not judged."));
}

TEST_F(PaperReportTest, says_what_is_missing) {
  make({});
  EXPECT_TRUE(says("Of 10 statements, 10 are not judged."));
  for (const std::string_view claim : {kGradientDescent, kSize, kApproximation, kUnknowns, kStart, kConvergence,
                                       kVoltage, kBank, kDermis, kVoltages}) {
    EXPECT_EQ(verdict(claim), "not judged") << claim;
  }
  EXPECT_TRUE(says("No training by gradient descent is known."));
  EXPECT_TRUE(says("No point was judged at 20 N."));
  EXPECT_FALSE(says("<h2>Times</h2>"));
  ASSERT_TRUE(write_paper_report(directory_.string(), {}).has_value());
  EXPECT_FALSE(fs::exists(directory_ / "peaks_training.svg"));
  EXPECT_TRUE(fs::exists(directory_ / "paper_fig_10.svg"));
}

TEST_F(PaperReportTest, draws_long_noisy_trainings_with_few_points) {
  PaperReproduction reproduction = sample_reproduction();
  TrainingCurve curve{"Adam", {}, {}};
  Random random(1);
  for (int step = 1; step <= 20000; ++step) {
    curve.step.push_back(step);
    curve.value.push_back(0.01 * std::exp(random.normal()));
  }
  reproduction.bank_training = std::move(curve);
  ASSERT_TRUE(write_paper_report(directory_.string(), reproduction).has_value());
  EXPECT_LT(fs::file_size(directory_ / "bank_training.svg"), 20000U);
}

TEST_F(PaperReportTest, takes_odd_numbers) {
  for (const double odd : {kNan, kInfinity, -kInfinity, 0.0, -1.0, 1e308, 1e-308}) {
    SCOPED_TRACE(odd);
    PaperReproduction reproduction = sample_reproduction();
    PeaksReproduction& peaks = reproduction.peaks;
    peaks.variance = peaks.range = peaks.adaptive_rate_best_mse = odd;
    peaks.target[100] = peaks.output[1800] = odd;
    peaks.adaptive_rate_curve.value[3] = peaks.adaptive_rate_curve.step[5] = odd;
    peaks.by_hidden[0].best_mse = peaks.by_hidden[1].best_mse_normalised = odd;
    reproduction.start[0] = {"(11)", "centre", 8, odd, odd, odd, odd, odd};
    for (TrainingCurve& curve : reproduction.convergence) curve.value.back() = curve.step.back() = odd;
    reproduction.bank_training.value.assign(reproduction.bank_training.value.size(), odd);
    for (PaperPoint* point : {&reproduction.points[0], &reproduction.points[47]}) {
      point->output_v = point->calibration_v = point->bank_newtons = point->dermis_newtons = odd;
    }
    reproduction.points[30].true_newtons = odd;
    reproduction.seconds[1].second = odd;
    make(reproduction);
  }
}

TEST_F(PaperReportTest, takes_curves_and_surfaces_that_do_not_fit) {
  PaperReproduction reproduction = sample_reproduction();
  reproduction.peaks.output.pop_back();
  reproduction.peaks.adaptive_rate_curve.value.pop_back();
  reproduction.convergence[0] = {};
  reproduction.convergence[1].step.clear();
  reproduction.bank_training = {};
  reproduction.peaks.by_hidden.resize(1);
  reproduction.points.resize(1);
  make(reproduction);
  EXPECT_EQ(verdict(kConvergence), "not judged");
  EXPECT_TRUE(says("The output of the network is not known"));
  EXPECT_TRUE(says("1 of 1 point within"));
}

TEST_F(PaperReportTest, takes_a_few_samples_of_peaks) {
  PaperReproduction reproduction = sample_reproduction();
  for (const std::size_t side : {2U, 3U, 4U, 5U}) {
    reproduction.peaks.side = side;
    reproduction.peaks.target.assign(side * side, 0.0);
    reproduction.peaks.output.assign(side * side, 0.0);
    make(reproduction);
  }
}

TEST_F(PaperReportTest, lists_the_times) {
  make(sample_reproduction());
  EXPECT_TRUE(says("<tr><th>Peaks</th><td>41.2 s</td></tr>"));
  EXPECT_TRUE(says("<tr><th>structured start</th><td>3.1 ms</td></tr>"));
  EXPECT_TRUE(says("<tr><th>together</th><td>254 s</td></tr>"));
}

TEST_F(PaperReportTest, shows_estimators_with_the_legend_of_their_model) {
  PaperReproduction reproduction = sample_reproduction();
  make(reproduction);
  EXPECT_TRUE(says("All estimators on the same points"));
  EXPECT_TRUE(says("one N-N-N-1 network a taxel"));
  reproduction.model = {};
  make(reproduction);
  EXPECT_TRUE(says("All estimators on the same points"));
  EXPECT_FALSE(says("one N-N-N-1 network a taxel"));
}

TEST_F(PaperReportTest, escapes_names) {
  PaperReproduction reproduction = sample_reproduction();
  reproduction.convergence[1].name = "<script>\xff";
  reproduction.start[0].where = "a&b";
  reproduction.points[0].taxel = "\u03c9_";  // Cut off where an index would follow.
  make(reproduction);
  EXPECT_FALSE(says("<script>"));
  EXPECT_TRUE(says("a&amp;b"));
}

TEST_F(PaperReportTest, names_a_directory_that_cannot_be_made) {
  fs::create_directories(directory_);
  std::ofstream(directory_ / "file") << "text";
  const Status written = write_paper_report((directory_ / "file" / "report").string(), {});
  ASSERT_FALSE(written.has_value());
  EXPECT_NE(written.error().message.find("file/report"), std::string::npos);
}

}  // namespace
}  // namespace dermis::paper
