// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "circuit/advise.hpp"
#include "circuit/known_circuit.hpp"
#include "commands.hpp"
#include "dermis/compensation/crosstalk.hpp"
#include "dermis/files/taxel_tables_csv.hpp"
#include "dermis/simulation/readout_circuit.hpp"

namespace dermis::app {
namespace {

using files::TableValues;
using files::TaxelTablesReader;
using files::TaxelTablesWriter;

struct ForwardOptions {
  std::string array;
  std::string conductance;
  std::string out;
};

struct InvertOptions {
  std::string array;
  std::string readings;
  std::string out;
  std::string sigma;  ///< Empty: not written.
  std::optional<double> noise_ratio;
};

/// Conductances and their 1-sigma of one frame after another.
class Inverter {
 public:
  static Result<Inverter> create(const ArrayDescription& array, double noise_ratio) {
    auto inversion = compensation::make_crosstalk_inversion(array, {.tolerance_ratio = 0.0});
    if (!inversion) return inversion.error();
    return Inverter(array, *std::move(inversion), noise_ratio);
  }

  /// False where the frame has no solution: all is NaN then.
  [[nodiscard]] bool invert(std::vector<double>& reading) {
    if (falls_with_pressure_) {
      for (double& value : reading) value = 1.0 - value;
    }
    inversion_->forget();  // a frame does not depend on the one before
    const bool solved = inversion_->invert(reading, siemens).solved;
    if (solved) {
      inversion_->propagate_noise(noise_ratio_, sigma);
    } else {
      std::fill(siemens.begin(), siemens.end(), std::numeric_limits<double>::quiet_NaN());
      std::fill(sigma.begin(), sigma.end(), std::numeric_limits<double>::quiet_NaN());
    }
    return solved;
  }

  std::vector<double> siemens;
  std::vector<double> sigma;

 private:
  Inverter(const ArrayDescription& array, std::unique_ptr<compensation::CrosstalkInversion> inversion,
           double noise_ratio)
      : siemens(array.taxel_count()),
        sigma(array.taxel_count()),
        inversion_(std::move(inversion)),
        noise_ratio_(noise_ratio),
        falls_with_pressure_(!array.readout.pressure_raises_reading) {}

  std::unique_ptr<compensation::CrosstalkInversion> inversion_;
  double noise_ratio_;
  bool falls_with_pressure_;
};

Result<double> noise_ratio(const InvertOptions& options, const ArrayDescription& array) {
  if (!options.noise_ratio) {
    const Result<double> noise = adc_noise_ratio(array);
    return noise ? *noise : Result<double>(in_file(options.array, noise.error()));
  }
  if (std::isfinite(*options.noise_ratio) && *options.noise_ratio > 0.0) return *options.noise_ratio;
  return bad_input("--noise: must be more than 0; it is the standard deviation of a reading over the supply");
}

Status circuit_forward(const ForwardOptions& options) {
  const Result<ArrayDescription> array = read_known_circuit(options.array);
  if (!array) return array.error();
  const Result<simulation::ReadoutCircuit> circuit = simulation::ReadoutCircuit::create(*array);
  if (!circuit) return in_file(options.array, circuit.error());
  Result<TaxelTablesReader> in =
      TaxelTablesReader::open(options.conductance, array->rows, array->cols, TableValues::not_negative);
  if (!in) return in.error();
  Result<TaxelTablesWriter> out = TaxelTablesWriter::create(options.out, array->rows, array->cols);
  if (!out) return out.error();
  std::vector<double> siemens(array->taxel_count());
  std::vector<double> ratio(array->taxel_count());
  for (;;) {
    const Result<bool> more = in->next(siemens);
    if (!more) return more.error();
    if (!*more) return out->commit();
    circuit->ratios(siemens, ratio);
    if (Status written = out->write(ratio); !written) return written;
  }
}

Status circuit_invert(const InvertOptions& options) {
  if (options.sigma == options.out) return bad_input("--sigma: is the file of --out; name another");
  const Result<ArrayDescription> array = read_known_circuit(options.array);
  if (!array) return array.error();
  const Result<double> noise = noise_ratio(options, *array);
  if (!noise) return noise.error();
  Result<Inverter> inverter = Inverter::create(*array, *noise);
  if (!inverter) return in_file(options.array, inverter.error());
  Result<TaxelTablesReader> in =
      TaxelTablesReader::open(options.readings, array->rows, array->cols, TableValues::finite);
  if (!in) return in.error();
  Result<TaxelTablesWriter> out = TaxelTablesWriter::create(options.out, array->rows, array->cols);
  if (!out) return out.error();
  std::optional<TaxelTablesWriter> sigma;
  if (!options.sigma.empty()) {
    Result<TaxelTablesWriter> created = TaxelTablesWriter::create(options.sigma, array->rows, array->cols);
    if (!created) return created.error();
    sigma.emplace(*std::move(created));
  }

  std::size_t frames = 0;
  std::size_t unsolved = 0;
  std::size_t first_unsolved_line = 0;
  std::vector<double> reading(array->taxel_count());
  for (;; ++frames) {
    const Result<bool> more = in->next(reading);
    if (!more) return more.error();
    if (!*more) break;
    if (!inverter->invert(reading) && unsolved++ == 0) first_unsolved_line = in->line();
    if (Status written = out->write(inverter->siemens); !written) return written;
    if (!sigma) continue;
    if (Status written = sigma->write(inverter->sigma); !written) return written;
  }
  if (Status written = out->commit(); !written) return written;
  if (sigma) {
    if (Status written = sigma->commit(); !written) return written;
  }
  if (unsolved == 0) return Done{};
  return failed(
      fmt::format("{}:{}: no conductances give these readings; {} of {} frames are nan in {}: check the "
                  "circuit and its resistances",
                  options.readings, first_unsolved_line, unsolved, frames, options.out));
}

}  // namespace

void add_circuit(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("circuit", "Compute a readout circuit: for people who design one");
  command->require_subcommand(1);

  auto forward_options = std::make_shared<ForwardOptions>();
  CLI::App* forward = command->add_subcommand("forward", "Conductances (siemens) -> readings over the supply");
  forward->add_option("--array", forward_options->array, "array.toml: size and readout circuit")->required();
  forward->add_option("--conductance", forward_options->conductance, "CSV of siemens, rows x columns")->required();
  forward->add_option("--out", forward_options->out, "CSV of readings to write")->required();
  forward->callback(
      [&action, forward_options] { action = [forward_options] { return circuit_forward(*forward_options); }; });

  auto invert_options = std::make_shared<InvertOptions>();
  CLI::App* invert = command->add_subcommand("invert", "Readings over the supply -> conductances (siemens)");
  invert->add_option("--array", invert_options->array, "array.toml: size and readout circuit")->required();
  invert->add_option("--readings", invert_options->readings, "CSV of readings, rows x columns")->required();
  invert->add_option("--out", invert_options->out, "CSV of siemens to write")->required();
  invert->add_option("--sigma", invert_options->sigma, "CSV of the 1-sigma of each conductance to write [S]");
  invert->add_option("--noise", invert_options->noise_ratio,
                     "Standard deviation of a reading over the supply (default: that of the array's ADC)");
  invert->callback(
      [&action, invert_options] { action = [invert_options] { return circuit_invert(*invert_options); }; });

  auto advise_options = std::make_shared<AdviseOptions>();
  CLI::App* advise = command->add_subcommand("advise", "Load and drive resistances that give the smallest error");
  advise->add_option("--array", advise_options->array, "array.toml: size, readout circuit and ADC")->required();
  advise->add_option("--range", advise_options->range_ohm, "Least and greatest resistance of a taxel [ohm]")
      ->expected(2)
      ->required();
  advise->add_flag("--json", advise_options->json, "Print the result as JSON");
  advise->callback(
      [&action, advise_options] { action = [advise_options] { return circuit_advise(*advise_options); }; });
}

}  // namespace dermis::app
