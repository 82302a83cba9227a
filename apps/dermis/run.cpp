// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "dermis/files/forces_csv.hpp"
#include "dermis/preprocessing/missing_readings.hpp"
#include "dermis/preprocessing/phase.hpp"
#include "open_source.hpp"
#include "seconds.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

constexpr std::size_t kFramesPerLook = 32;  // at the statistics

struct RunOptions {
  std::string model;
  std::string in;
  std::string out;
  std::string sigma;
  double settle_s = 0.0;
};

/// Where the source does not tell it, by the number of the frame.
std::string place_of(const std::string& in, const FrameSource& source, std::size_t frame) {
  const std::string place = source.place();
  return place.empty() ? fmt::format("{}: frame {}", in, frame) : place;
}

/// forces.csv and, where it is asked for, the table of their standard deviations.
class ForceTables {
 public:
  static Result<ForceTables> create(const RunOptions& options, const ArrayDescription& array) {
    Result<files::ForcesCsvWriter> forces = files::ForcesCsvWriter::create(options.out, array.rows, array.cols);
    if (!forces) return forces.error();
    ForceTables tables(std::move(*forces));
    if (options.sigma.empty()) return tables;
    Result<files::ForcesCsvWriter> sigmas =
        files::ForcesCsvWriter::create(options.sigma, array.rows, array.cols, files::ForceColumn::sigma_newtons);
    if (!sigmas) return sigmas.error();
    tables.sigmas_.emplace(std::move(*sigmas));
    return tables;
  }

  Status write(const ForceFrame& force) {
    const Status written = forces_.write(force);
    return written && sigmas_ ? sigmas_->write(force) : written;
  }
  Status commit() {
    const Status committed = forces_.commit();
    return committed && sigmas_ ? sigmas_->commit() : committed;
  }

 private:
  explicit ForceTables(files::ForcesCsvWriter forces) : forces_(std::move(forces)) {}

  files::ForcesCsvWriter forces_;
  std::optional<files::ForcesCsvWriter> sigmas_;
};

/// Frames whose forces are not what a user expects.
class Troubles {
 public:
  explicit Troubles(const ArrayDescription& array) : missing_(array) {}

  /// `place` says where the frame is from.
  template <typename Place>
  void count(const ForceFrame& force, const pipeline::Pipeline& pipeline, Place place) {
    ++frames_;
    missing_.add(pipeline.conditioned());
    if (has(force.status, FrameStatus::not_converged)) ++unsolved_;
    if (has(force.status, FrameStatus::line_fault)) ++faulty_;
    if (!has(force.status, FrameStatus::rejected)) return;
    if (rejected_++ == 0)
      first_rejection_ = fmt::format("{}: {}", place(), preprocessing::to_string(pipeline.rejection()));
  }

  [[nodiscard]] std::size_t frames() const { return frames_; }

  void report() const {
    if (rejected_ > 0) {
      say(fmt::format("{} of {} frames rejected, the first: {}", rejected_, frames_, first_rejection_));
    }
    if (missing_.any()) say(missing_.describe());
    if (unsolved_ > 0) {
      say(fmt::format("{} of {} frames without forces: their readings do not fit the circuit of the array", unsolved_,
                      frames_));
    }
    if (faulty_ > 0) {
      say(fmt::format("{} of {} frames with faulty lines or taxels, which are masked: 'dermis doctor' tells which",
                      faulty_, frames_));
    }
  }

 private:
  preprocessing::MissingReadings missing_;
  std::size_t frames_ = 0;
  std::size_t rejected_ = 0;
  std::size_t unsolved_ = 0;
  std::size_t faulty_ = 0;
  std::string first_rejection_;
};

/// An error of the source comes in `source_status`, one of the tables is returned.
Status solve(const RunOptions& options, Operation& operation, preprocessing::PhaseSelector& phase, ForceTables& tables,
             Troubles& troubles, Status& source_status) {
  const bool is_live = operation.frames->is_live();
  std::optional<LiveLine> line;
  if (is_live) line.emplace();
  RawFrame raw;
  ForceFrame force;
  for (std::size_t read = 1; is_live || !stop_flag().load(); ++read) {
    const Result<bool> more = operation.frames->next(raw);
    if (!more) source_status = more.error();
    if (!more || !*more) break;
    if (phase.select(raw.time, false) != preprocessing::Destination::pipeline) continue;
    operation.pipeline.process(raw, force);
    if (Status written = tables.write(force); !written) return written;
    troubles.count(force, operation.pipeline, [&] { return place_of(options.in, *operation.frames, read); });
    if (line && troubles.frames() % kFramesPerLook == 0) {
      line->show(summary(troubles.frames(), operation.frames->statistics()));
    }
  }
  return Done{};
}

Status run(const RunOptions& options) {
  const Result<Nanos> settle = nanos_from_seconds(options.settle_s, "--settle");
  if (!settle) return settle.error();
  if (options.sigma == options.out) return bad_input("--sigma: is the file of --out; name another");
  Result<std::unique_ptr<Operation>> operation = open_operation(options.model, options.in);
  if (!operation) return operation.error();
  Result<ForceTables> tables = ForceTables::create(options, (*operation)->model.array);
  if (!tables) return tables.error();

  preprocessing::PhaseSelector phase(*settle, preprocessing::Phase::operate);
  Troubles troubles((*operation)->model.array);
  Status status = Done{};
  if (Status solved = solve(options, **operation, phase, *tables, troubles, status); !solved) return solved;
  // What a device gave until it failed is worth having; a file that is wrong is to be mended.
  if (!status && !(*operation)->frames->is_live()) return status;
  if (Status committed = tables->commit(); !committed) return committed;
  troubles.report();
  return status;
}

}  // namespace

void add_run(Command& command) {
  auto options = std::make_shared<RunOptions>();
  command.option("--model", options->model, "Model file of 'dermis calibrate'").required();
  command.option("--in", options->in, "Raw counts: frames.csv, a recording, or the URI of a device").required();
  command.option("--out", options->out, "forces.csv to write").required();
  command.option("--sigma", options->sigma, "Also write the standard deviation of every force [N] to this CSV");
  command.option("--settle", options->settle_s, "Leave out the first seconds, while the array warms up [s]")
      .shows_default();
  command.action([options] { return run(*options); });
}

}  // namespace dermis::app
