// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/paper_bank_file.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dermis/bytes/files/safetensors.hpp"
#include "paper/bank/bank_rows_file.hpp"

namespace dermis::paper {
namespace {

using bytes::files::SafetensorsFile;

/// The weights and, by far, all else.
constexpr std::size_t kMostBytes = kMostUnknowns * sizeof(float) + (std::size_t{1} << 24U);

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

/// Wide enough to divide by in single precision, and not too wide.
bool is_range(double low, double high) {
  constexpr double kNarrowest = 1e-9;
  constexpr double kFarthest = 1e9;
  return std::abs(low) <= kFarthest && std::abs(high) <= kFarthest && high - low >= kNarrowest;
}

/// Everything but the parameters; the bank's parameters are 0.
Result<PaperBank> read_ranges(const SafetensorsFile& file, std::size_t taxels) {
  const Result<std::span<const double>> ratio = file.view<double>("ratio", {taxels, 2});
  if (!ratio) return ratio.error();
  std::vector<PaperBank::Range> ranges;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    ranges.push_back({(*ratio)[2 * taxel], (*ratio)[2 * taxel + 1]});
    if (!is_range(ranges.back().low, ranges.back().high)) return bad_input("ratio: a range is empty or too wide");
  }
  std::optional<PaperBank::Range> celsius;
  if (file.tensors.contains("celsius")) {
    const Result<std::span<const double>> values = file.view<double>("celsius", {2});
    if (!values) return values.error();
    celsius = PaperBank::Range{values->front(), values->back()};
    if (!is_range(celsius->low, celsius->high)) return bad_input("celsius: the range is empty or too wide");
  }
  const Result<std::span<const double>> heaviest = file.view<double>("heaviest_newtons", {1});
  if (!heaviest) return heaviest.error();
  if (!is_range(0.0, heaviest->front())) return bad_input("heaviest_newtons: must be above 0 and at most 1e9");
  return PaperBank(std::move(ranges), celsius, heaviest->front());
}

Result<PaperBank> bank_from(const SafetensorsFile& file) {
  const auto ratio = file.tensors.find("ratio");
  const std::size_t taxels =
      ratio != file.tensors.end() && !ratio->second.shape.empty() ? ratio->second.shape.front() : 0;
  // The whole file is bounded, but not the product of sizes that a short tensor claims.
  if (taxels == 0 || taxels > 65'536 || paper_bank_unknowns(taxels) > kMostUnknowns) {
    return bad_input("ratio: is missing, or too large for a bank");
  }
  const std::size_t parameters = paper_network_shape(taxels, file.tensors.contains("celsius")).parameter_count();
  const Result<std::span<const float>> values = file.view<float>("parameters", {taxels, parameters});
  if (!values) return values.error();
  if (!all_finite(*values)) return bad_input("parameters: a value is not a finite number");
  Result<PaperBank> bank = read_ranges(file, taxels);
  if (!bank) return bank.error();
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    bank->networks().set_parameters(taxel, values->subspan(taxel * parameters, parameters));
  }
  return bank;
}

}  // namespace

Status write_paper_bank(const std::string& path, const PaperBank& bank, Ranks& ranks) {
  const std::size_t taxels = bank.taxel_count();
  SafetensorsFile first;
  first.metadata["format"] = kPaperBankFormat.name;
  std::vector<double> ratio;
  for (const PaperBank::Range& range : bank.ratio()) ratio.insert(ratio.end(), {range.low, range.high});
  first.tensors["ratio"] = {{taxels, 2}, std::move(ratio)};
  if (bank.celsius()) first.tensors["celsius"] = {{2}, std::vector<double>{bank.celsius()->low, bank.celsius()->high}};
  first.tensors["heaviest_newtons"] = {{1}, std::vector<double>{bank.heaviest_newtons()}};
  const BankRowsFile file(first, {{"parameters"}, taxels, bank.networks().shape().parameter_count()}, ranks);
  return file.write(path, [&](std::size_t /*tensor*/, std::size_t network, std::span<float> values) {
    bank.networks().parameters(network, values);
  });
}

Result<PaperBank> read_paper_bank(const std::string& path) {
  const Result<SafetensorsFile> file = bytes::files::read_safetensors(path, kMostBytes);
  if (!file) return file.error();
  if (const Status right = bytes::files::check_format(*file, kPaperBankFormat); !right) {
    return bad_input(path + ": " + right.error().message);
  }
  Result<PaperBank> bank = bank_from(*file);
  if (!bank) return bad_input(path + ": " + bank.error().message);
  return bank;
}

}  // namespace dermis::paper
