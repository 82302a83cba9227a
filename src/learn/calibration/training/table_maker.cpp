// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/table_maker.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "learn/calibration/tables/level_table.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kLeastOfKnot = 1e-30;  // N and S: floats hold it and its shares

}  // namespace

TaxelTable TableMaker::fit(const std::vector<TaxelPoint>& points) const {
  std::vector<LevelPoint> known;
  for (const TaxelPoint& point : points) {
    known.push_back({point.newtons, point.excess_siemens, temperature_offset(point)});
  }
  const double coefficient = temperature_coefficient(known);
  std::vector<Knot> knots = level_table(std::move(known), coefficient);
  pool_equal_floats(knots);
  std::erase_if(knots, [](const Knot& knot) { return !(std::min(knot.x, knot.y) >= kLeastOfKnot); });
  return {std::move(knots), coefficient};
}

touch::fusion::ForceTables assemble_tables(const std::vector<TaxelTable>& tables,
                                           const std::vector<std::size_t>& taxels) {
  touch::fusion::ForceTables assembled;
  for (const TaxelTable& table : tables) assembled.knots = std::max(assembled.knots, table.knots.size());
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const auto& [knots, per_celsius] = tables[k];
    assembled.taxels.push_back(static_cast<std::uint32_t>(taxels[k]));
    assembled.per_celsius.push_back(static_cast<float>(per_celsius));
    const std::size_t missing = assembled.knots - knots.size();
    for (std::size_t knot = 0; knot < assembled.knots; ++knot) {
      const Knot& given = knots[knot < missing ? 0 : knot - missing];
      const double share = knot < missing ? static_cast<double>(knot + 1) / static_cast<double>(missing + 1) : 1.0;
      assembled.siemens.push_back(static_cast<float>(share * given.y));
      assembled.newtons.push_back(static_cast<float>(share * given.x));
    }
  }
  return assembled;
}

std::vector<TaxelPoint> by_force(std::span<const TaxelPoint> points) {
  std::vector<TaxelPoint> sorted(points.begin(), points.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.newtons < b.newtons; });
  return sorted;
}

}  // namespace dermis::learn::calibration
