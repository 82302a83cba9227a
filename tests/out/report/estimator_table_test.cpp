// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/estimator_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "out/report/sample_evaluation.hpp"
#include "out/report/well_formed.hpp"

namespace dermis::out::report {
namespace {

TEST(EstimatorTable, has_a_row_for_each_estimator_and_one_best_cell_a_column) {
  const learn::calibration::Evaluation evaluation = sample_evaluation(4, 4, 20);
  const Table table = estimator_table(evaluation);
  ASSERT_EQ(table.rows.size(), evaluation.estimators.size());
  for (std::size_t column = 0; column + 1 < table.heads.size(); ++column) {
    const auto best = std::count_if(table.rows.begin(), table.rows.end(),
                                    [&](const Row& row) { return row.cells.at(column).style == "best"; });
    EXPECT_EQ(best, 1) << table.heads[column + 1];
  }
  std::size_t grouped_columns = 0;
  for (const Table::Group& group : table.groups) grouped_columns += group.columns;
  EXPECT_EQ(grouped_columns + 1, table.heads.size());
}

TEST(EstimatorTable, counts_the_taxels_within_the_papers_tolerance) {
  learn::calibration::Evaluation evaluation = empty_sample(4, 4);
  evaluation.estimators.resize(1);
  for (const float newtons : {10.4F, 10.6F, 9.6F, 9.4F}) {
    evaluation.taxels.push_back({0, 0, 10.0, 20.0, 5.0, 1, {newtons}, 0.1F});
  }
  const Table table = estimator_table(evaluation);
  ASSERT_EQ(table.heads, (std::vector<std::string>{"estimator", "within 5 %"}));
  EXPECT_EQ(table.rows.at(0).cells.at(0).words, "50.0 %");
}

TEST(EstimatorTable, has_no_rows_where_nothing_was_judged) {
  EXPECT_TRUE(estimator_table(empty_sample(4, 4)).rows.empty());
  EXPECT_TRUE(headline_tiles(empty_sample(4, 4)).empty());
}

TEST(EstimatorTable, the_headline_is_the_first_estimator_beside_the_best_other) {
  learn::calibration::Evaluation evaluation = sample_evaluation(4, 4, 20);
  evaluation.estimators[0].relative_error.median = 0.02;
  evaluation.estimators[2].relative_error.median = 0.0001;
  const std::vector<Tile> tiles = headline_tiles(evaluation);
  const auto median =
      std::find_if(tiles.begin(), tiles.end(), [](const Tile& tile) { return tile.name == "median error"; });
  ASSERT_NE(median, tiles.end());
  EXPECT_EQ(median->value, "2.0 %");
  EXPECT_EQ(median->note, "best other: 0.010 %");
}

TEST(EstimatorTable, the_legend_describes_further_estimators_after_the_baselines) {
  learn::calibration::Evaluation evaluation = sample_evaluation(4, 4, 20);
  evaluation.estimators.emplace_back().name = "oracle";
  evaluation.estimators.back().description = "knows the force";
  Page page("window", "title");
  add_estimator_legend(page, evaluation, sample_model(evaluation));
  const std::string html = std::move(page).html();
  EXPECT_EQ(xml_error(html), "");
  const std::size_t oracle = html.find("<th>oracle</th><td>knows the force</td>");
  ASSERT_NE(oracle, std::string::npos);
  EXPECT_GT(oracle, html.find("<th>crosstalk look-up</th>"));
}

}  // namespace
}  // namespace dermis::out::report
