// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/taxel_tables_csv.hpp"
#include "dermis/learn/health/circuit_advice.hpp"
#include "dermis/learn/health/circuit_inversion.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using bytes::files::TableValues;
using bytes::files::TaxelTablesReader;
using bytes::files::TaxelTablesWriter;

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

struct AdviseOptions {
  std::string array;
  std::vector<double> range_ohm;  ///< Least and greatest resistance of a taxel.
  bool json = false;
};

/// The error with the name of the file before it.
Error in_file(const std::string& path, const Error& error) {
  return {error.kind, path + ": " + error.message};
}

/// An array with a circuit that can be computed.
Result<ArrayDescription> read_known_circuit(const std::string& path) {
  Result<ArrayDescription> array = bytes::files::read_array(path);
  if (!array) return array;
  if (array->readout.circuit == Circuit::none) {
    return bad_input(path + ": circuit = \"none\" has nothing to compute; name the circuit and its resistances");
  }
  if (array->has_unknown_circuit()) {
    return bad_input(path + ": a circuit that is to be fitted cannot be computed; give its resistances in ohm");
  }
  return array;
}

Result<double> noise_ratio(const InvertOptions& options, const ArrayDescription& array) {
  if (!options.noise_ratio) {
    const Result<double> noise = learn::health::adc_noise_ratio(array);
    return noise ? *noise : Result<double>(in_file(options.array, noise.error()));
  }
  if (std::isfinite(*options.noise_ratio) && *options.noise_ratio > 0.0) return *options.noise_ratio;
  return bad_input("--noise: must be more than 0; it is the standard deviation of a reading over the supply");
}

Status circuit_forward(const ForwardOptions& options) {
  const Result<ArrayDescription> array = read_known_circuit(options.array);
  if (!array) return array.error();
  const Result<learn::simulation::ReadoutCircuit> circuit = learn::simulation::ReadoutCircuit::create(*array);
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

Result<std::optional<TaxelTablesWriter>> create_sigma(const InvertOptions& options, const ArrayDescription& array) {
  if (options.sigma.empty()) return std::optional<TaxelTablesWriter>();
  Result<TaxelTablesWriter> created = TaxelTablesWriter::create(options.sigma, array.rows, array.cols);
  if (!created) return created.error();
  return std::optional(*std::move(created));
}

Status circuit_invert(const InvertOptions& options) {
  const Result<ArrayDescription> array = read_known_circuit(options.array);
  if (!array) return array.error();
  const Result<double> noise = noise_ratio(options, *array);
  if (!noise) return noise.error();
  Result<learn::health::CircuitInversion> inversion = learn::health::CircuitInversion::create(*array, *noise);
  if (!inversion) return in_file(options.array, inversion.error());
  Result<TaxelTablesReader> in =
      TaxelTablesReader::open(options.readings, array->rows, array->cols, TableValues::finite);
  if (!in) return in.error();
  Result<TaxelTablesWriter> out = TaxelTablesWriter::create(options.out, array->rows, array->cols);
  if (!out) return out.error();
  Result<std::optional<TaxelTablesWriter>> sigma_out = create_sigma(options, *array);
  if (!sigma_out) return sigma_out.error();
  std::optional<TaxelTablesWriter>& sigma = *sigma_out;

  std::size_t frames = 0;
  std::size_t unsolved = 0;
  std::size_t first_unsolved_line = 0;
  std::vector<double> reading(array->taxel_count());
  for (;; ++frames) {
    const Result<bool> more = in->next(reading);
    if (!more) return more.error();
    if (!*more) break;
    if (!inversion->invert(reading) && unsolved++ == 0) first_unsolved_line = in->line();
    if (Status written = out->write(inversion->siemens()); !written) return written;
    if (!sigma) continue;
    if (Status written = sigma->write(inversion->sigma_siemens()); !written) return written;
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

nlohmann::ordered_json precision_json(const std::optional<learn::health::Precision>& precision) {
  if (!precision) return nullptr;
  return {
      {"mean", precision->mean}, {"median", precision->median}, {"p95", precision->p95}, {"worst", precision->worst}};
}

void print_json(const learn::health::CircuitAdvice& advice) {
  nlohmann::ordered_json json = {{"noise_ratio", advice.noise_ratio},
                                 {"best_load_ohm", advice.loads[advice.best].load_ohm},
                                 {"best", precision_json(advice.loads[advice.best].precision)},
                                 {"present", precision_json(advice.present)},
                                 {"ideal_drivers", precision_json(advice.ideal_drivers)},
                                 {"most_drive_ohm", nullptr},
                                 {"loads", nlohmann::ordered_json::array()}};
  if (advice.ideal_drivers) json["most_drive_ohm"] = advice.most_drive_ohm;
  for (const learn::health::ResistorChoice& choice : advice.loads) {
    json["loads"].push_back({{"load_ohm", choice.load_ohm}, {"precision", precision_json(choice.precision)}});
  }
  fmt::print("{}\n", json.dump(2));
}

Status circuit_advise(const AdviseOptions& options) {
  const learn::health::TaxelRange taxels{options.range_ohm[0], options.range_ohm[1]};
  constexpr double kMostOhm = 1e12;
  if (!(taxels.least_ohm > 0.0 && taxels.least_ohm < taxels.most_ohm && taxels.most_ohm <= kMostOhm)) {
    return bad_input("--range: must be two resistances of a taxel in ohm, more than 0, the least first");
  }
  const Result<ArrayDescription> array = read_known_circuit(options.array);
  if (!array) return array.error();
  Progress progress;
  const Result<learn::health::CircuitAdvice> advice =
      learn::health::advise_circuit(*array, taxels, [&](double share) { progress.show("advice", share); });
  if (!advice) return in_file(options.array, advice.error());
  progress.show("advice", 1.0);
  options.json ? print_json(*advice) : fmt::print("{}", learn::health::describe(*advice, *array));
  return Done{};
}

}  // namespace

void add_circuit(Command& command) {
  auto forward_options = std::make_shared<ForwardOptions>();
  Command forward = command.subcommand("forward", "Compute readings over the supply from conductances (siemens)");
  forward.input("--array", forward_options->array, "array.toml: size and readout circuit").required();
  forward.input("--conductance", forward_options->conductance, "CSV of siemens, rows x columns").required();
  forward.output("--out", forward_options->out, "CSV of readings to write").required();
  forward.action([forward_options] { return circuit_forward(*forward_options); });

  auto invert_options = std::make_shared<InvertOptions>();
  Command invert = command.subcommand("invert", "Compute conductances (siemens) from readings over the supply");
  invert.input("--array", invert_options->array, "array.toml: size and readout circuit").required();
  invert.input("--readings", invert_options->readings, "CSV of readings, rows x columns").required();
  invert.output("--out", invert_options->out, "CSV of siemens to write").required();
  invert.output("--sigma", invert_options->sigma, "CSV of the 1-sigma of each conductance to write [S]");
  invert.option("--noise", invert_options->noise_ratio,
                "Standard deviation of a reading over the supply (default: that of the array's ADC)");
  invert.action([invert_options] { return circuit_invert(*invert_options); });

  auto advise_options = std::make_shared<AdviseOptions>();
  Command advise = command.subcommand("advise", "Find the load and drive resistances with the smallest error");
  advise.input("--array", advise_options->array, "array.toml: size, readout circuit and ADC").required();
  advise.option("--range", advise_options->range_ohm, "Least and greatest resistance of a taxel [ohm]")
      .takes(2)
      .required();
  advise.flag("--json", advise_options->json, "Print the result as JSON");
  advise.action([advise_options] { return circuit_advise(*advise_options); });
}

}  // namespace dermis::app
