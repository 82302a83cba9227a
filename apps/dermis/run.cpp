// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "dermis/live/forces/force_tables.hpp"
#include "dermis/live/forces/operation.hpp"
#include "dermis/touch/compensation/offset_drift.hpp"
#include "dermis/touch/pipeline/frame_troubles.hpp"
#include "dermis/touch/pipeline/standing_load.hpp"
#include "dermis/touch/pipeline/tare.hpp"
#include "dermis/touch/preprocessing/phase.hpp"
#include "seconds.hpp"
#include "source_options.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using live::forces::ForceTables;
using live::forces::Operation;
using touch::pipeline::FrameTroubles;

constexpr std::size_t kFramesPerLook = 32;  // at the statistics

struct RunOptions {
  std::string model;
  std::string in;
  live::forces::ForceTablePaths tables;
  double settle_s = 0.0;
  bool tare = false;
  bool tare_force = false;
  bool follow_drift = false;
};

Status check_outputs(const live::forces::ForceTablePaths& tables) {
  if (tables.forces.empty() && tables.sigmas.empty() && tables.contacts.empty() && tables.totals.empty()) {
    return bad_input(
        "name a file to write: --out FILE for the forces, --totals FILE for their sum, --contacts FILE for the "
        "contacts");
  }
  return Done{};
}

/// The watches that report on the frames at the end.
struct Watches {
  FrameTroubles troubles;
  touch::pipeline::StandingLoadWatch standing;
  std::size_t skipped = 0;  ///< While the array settled.

  explicit Watches(const Operation& operation)
      : troubles(operation.model.array, operation.from), standing(operation.model) {}
};

/// "200 frames, 3 skipped: forces in forces.csv, contacts in contacts.csv"
std::string where_frames_went(const Watches& watches, const live::forces::ForceTablePaths& tables) {
  std::vector<std::string> places;
  for (const auto& [what, path] : {std::pair("forces", &tables.forces), std::pair("sigmas", &tables.sigmas),
                                   std::pair("totals", &tables.totals), std::pair("contacts", &tables.contacts)}) {
    const bool is_stream = *path == kStandardOutput;
    if (!path->empty()) places.push_back(fmt::format("{} in {}", what, is_stream ? "the standard output" : *path));
  }
  const std::string skipped = watches.skipped > 0 ? fmt::format(", {} skipped", watches.skipped) : "";
  const std::size_t frames = watches.troubles.frames();
  return fmt::format("{} frame{}{}: {}", frames, frames == 1 ? "" : "s", skipped, fmt::join(places, ", "));
}

Status check_tare(const Operation& operation) {
  const touch::pipeline::Tare& tare = operation.pipeline.last_tare();
  if (tare.state != touch::pipeline::Tare::State::refused) return Done{};
  return failed(fmt::format("{}: not tared: {}, or say --tare-force if that is zero; nothing is written",
                            operation.from, touch::pipeline::describe(tare, operation.model.array)));
}

/// An error of the source comes in `source_status`, one of the tables is returned.
Status solve(Operation& operation, touch::preprocessing::PhaseSelector& phase, ForceTables& tables, Watches& watches,
             Status& source_status) {
  const bool is_live = operation.frames->is_live();
  std::optional<LiveLine> line;
  if (is_live) line.emplace();
  RawFrame raw;
  ForceFrame force;
  while (is_live || !stop_flag().load()) {
    const Result<bool> more = operation.frames->next(raw);
    if (!more) source_status = more.error();
    if (!more || !*more) break;
    if (phase.select(raw.time, false) != touch::preprocessing::Destination::pipeline) {
      watches.troubles.skip();
      ++watches.skipped;
      continue;
    }
    operation.pipeline.process(raw, force);
    if (Status tared = check_tare(operation); !tared) return tared;
    if (Status written = tables.write(force); !written) return written;
    watches.troubles.add(raw, force, operation.pipeline, operation.frames.get());
    watches.standing.add(operation.pipeline.conductance(), force);
    if (line && watches.troubles.frames() % kFramesPerLook == 0) {
      line->show(summary(watches.troubles.frames(), operation.frames->statistics()));
    }
  }
  return Done{};
}

Status run(const RunOptions& options) {
  const Result<Nanos> settle = nanos_from_seconds(options.settle_s, "--settle");
  if (!settle) return settle.error();
  if (Status distinct = check_outputs(options.tables); !distinct) return distinct;
  Result<std::unique_ptr<Operation>> operation =
      live::forces::open_operation(options.model, options.in, source_options());
  if (!operation) return operation.error();
  if (options.tables.surface && !(*operation)->model.array.cover) {
    return bad_input("--surface: the model knows of no cover: its taxels feel what stands on them");
  }
  Result<ForceTables> tables = ForceTables::create(options.tables, (*operation)->model);
  if (!tables) return tables.error();

  touch::compensation::OffsetDrift& drift = (*operation)->pipeline.drift();
  drift.set_options({.track = options.follow_drift});
  if (options.tare) (*operation)->pipeline.tare();
  if (options.tare_force) (*operation)->pipeline.tare(touch::pipeline::TareOver::any_load);
  touch::preprocessing::PhaseSelector phase(*settle, touch::preprocessing::Phase::operate);
  Watches watches(**operation);
  const FrameTroubles& troubles = watches.troubles;
  Status status = Done{};
  if (Status solved = solve(**operation, phase, *tables, watches, status); !solved) return solved;
  // The frames of a device until it failed are worth having; a wrong file is to be mended.
  if (!status && !(*operation)->frames->is_live()) return status;
  if (status && troubles.frames() == 0) {
    const char* const when = options.settle_s > 0.0 ? " after settling" : "";
    return failed(fmt::format("{}: no frame came{}: nothing is written", options.in, when));
  }
  if (Status committed = tables->commit(); !committed) return committed;
  if (status) status = troubles.verdict();
  if (!status) return status;
  print_notice(where_frames_went(watches, options.tables));
  const std::string tared = touch::pipeline::describe((*operation)->pipeline.last_tare(), (*operation)->model.array);
  if (!tared.empty()) print_notice(tared);
  if (const auto load = watches.standing.load())
    print_notice(describe_never_released(*load, (*operation)->model.array));
  for (const std::string& line : troubles.describe()) print_notice(line);
  return status;
}

}  // namespace

void add_run(Command& command) {
  auto options = std::make_shared<RunOptions>();
  command.input_file("--model", options->model,
                     "Model file of 'dermis calibrate', or array.toml where readings are forces; without it, the model "
                     "that the recording holds");
  command
      .input("--in", options->in,
             "Raw counts: frames.csv, a recording or another file of frames, or the URI of a device")
      .required();
  command.output("--out", options->tables.forces, "forces.csv to write");
  command.output("--sigma", options->tables.sigmas, "Also write the standard deviation of every force [N] to this CSV");
  command.output("--totals", options->tables.totals,
                 "totals.csv to write: the force on the whole array and its standard deviation [N]");
  command.output("--contacts", options->tables.contacts,
                 "contacts.csv to write: what touches the array, where and how hard");
  command.flag("--surface", options->tables.surface,
               "Forces and sigmas are those on the cover that spreads them (array.cover_spread_mm), not those of the "
               "taxels; totals and contacts stay");
  command.option("--settle", options->settle_s, "Skip the first seconds, while the array warms up [s]").shows_default();
  command.flag(
      "--tare", options->tare,
      "Take the first second (at least 10 frames) as unloaded, like the tare of 'dermis serve'; refused under a "
      "load");
  command.flag("--tare-force", options->tare_force, "The same, whatever load stands there: it reads 0 N from then on");
  command.flag("--follow-drift", options->follow_drift,
               "Follow the offsets of idle taxels slowly, as in 'dermis serve'");
  command.action([options] { return run(*options); });
}

}  // namespace dermis::app
