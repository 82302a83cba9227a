// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "dermis/compensation/offset_drift.hpp"
#include "dermis/files/contacts_csv.hpp"
#include "dermis/files/forces_csv.hpp"
#include "dermis/fusion/contact.hpp"
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
  std::string contacts;
  double settle_s = 0.0;
  bool tare = false;
  bool follow_drift = false;
};

/// Where the source does not tell it, by the number of the frame.
std::string place_of(const std::string& in, const FrameSource& source, std::size_t frame) {
  const std::string place = source.place();
  return place.empty() ? fmt::format("{}: frame {}", in, frame) : place;
}

/// What touches the array, as contacts.csv.
class ContactTable {
 public:
  static Result<ContactTable> create(const std::string& path, const pipeline::Model& model) {
    Result<files::ContactsCsvWriter> contacts = files::ContactsCsvWriter::create(path);
    if (!contacts) return contacts.error();
    return ContactTable(model, std::move(*contacts));
  }

  Status write(const ForceFrame& force) {
    tracker_.process(force, report_);
    return contacts_.write(report_);
  }
  Status commit() { return contacts_.commit(); }

 private:
  ContactTable(const pipeline::Model& model, files::ContactsCsvWriter contacts)
      : tracker_(model.array, {}, model.strip), contacts_(std::move(contacts)) {}

  fusion::ContactTracker tracker_;
  ContactReport report_;
  files::ContactsCsvWriter contacts_;
};

/// Those of forces.csv, of the standard deviations of the forces and of the contacts that are asked for.
class Tables {
 public:
  static Result<Tables> create(const RunOptions& options, const pipeline::Model& model) {
    const ArrayDescription& array = model.array;
    Tables tables;
    const Status forces = create_forces(tables.forces_, options.out, array, files::ForceColumn::newtons);
    if (!forces) return forces.error();
    const Status sigmas = create_forces(tables.sigmas_, options.sigma, array, files::ForceColumn::sigma_newtons);
    if (!sigmas) return sigmas.error();
    if (options.contacts.empty()) return tables;
    Result<ContactTable> contacts = ContactTable::create(options.contacts, model);
    if (!contacts) return contacts.error();
    tables.contacts_.emplace(std::move(*contacts));
    return tables;
  }

  Status write(const ForceFrame& force) {
    return for_each([&](auto& table) { return table.write(force); });
  }
  Status commit() {
    return for_each([](auto& table) { return table.commit(); });
  }

 private:
  static Status create_forces(std::optional<files::ForcesCsvWriter>& table, const std::string& path,
                              const ArrayDescription& array, files::ForceColumn column) {
    if (path.empty()) return Done{};
    Result<files::ForcesCsvWriter> created = files::ForcesCsvWriter::create(path, array.rows, array.cols, column);
    if (!created) return created.error();
    table.emplace(std::move(*created));
    return Done{};
  }

  /// Until one fails.
  template <typename Work>
  Status for_each(Work work) {
    Status status = Done{};
    if (forces_) status = work(*forces_);
    if (status && sigmas_) status = work(*sigmas_);
    if (status && contacts_) status = work(*contacts_);
    return status;
  }

  std::optional<files::ForcesCsvWriter> forces_;
  std::optional<files::ForcesCsvWriter> sigmas_;
  std::optional<ContactTable> contacts_;
};

Status check_outputs(const RunOptions& options) {
  if (options.out.empty() && options.sigma.empty() && options.contacts.empty()) {
    return bad_input("name a file to write: --out FILE for the forces, --contacts FILE for the contacts");
  }
  const auto same = [](const std::string& a, const std::string& b) { return !a.empty() && a == b; };
  if (same(options.sigma, options.out)) return bad_input("--sigma: is the file of --out; name another");
  if (same(options.contacts, options.out)) return bad_input("--contacts: is the file of --out; name another");
  if (same(options.contacts, options.sigma)) return bad_input("--contacts: is the file of --sigma; name another");
  return Done{};
}

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
Status solve(const RunOptions& options, Operation& operation, preprocessing::PhaseSelector& phase, Tables& tables,
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
  if (Status distinct = check_outputs(options); !distinct) return distinct;
  Result<std::unique_ptr<Operation>> operation = open_operation(options.model, options.in);
  if (!operation) return operation.error();
  Result<Tables> tables = Tables::create(options, (*operation)->model);
  if (!tables) return tables.error();

  compensation::OffsetDrift& drift = (*operation)->pipeline.drift();
  drift.set_options({.track = options.follow_drift});
  if (options.tare) drift.tare();
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
  command.option("--model", options->model, "Model file of 'dermis calibrate', or array.toml where readings are forces")
      .required();
  command
      .option("--in", options->in,
              "Raw counts: frames.csv, a recording or another file of frames, or the URI of a device")
      .required();
  command.option("--out", options->out, "forces.csv to write");
  command.option("--sigma", options->sigma, "Also write the standard deviation of every force [N] to this CSV");
  command.option("--contacts", options->contacts, "contacts.csv to write: what touches the array, where and how hard");
  command.option("--settle", options->settle_s, "Leave out the first seconds, while the array warms up [s]")
      .shows_default();
  command.flag("--tare", options->tare,
               "Take the first second (at least 10 frames) for unloaded, as tare in 'dermis serve' does");
  command.flag("--follow-drift", options->follow_drift,
               "Follow the offsets of idle taxels slowly, as in 'dermis serve'");
  command.action([options] { return run(*options); });
}

}  // namespace dermis::app
