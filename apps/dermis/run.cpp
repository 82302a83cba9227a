// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <optional>

#include "commands.hpp"
#include "dermis/pipeline/model.hpp"
#include "dermis/pipeline/pipeline.hpp"
#include "dermis/preprocessing/phase.hpp"
#include "dermis/store/forces_csv.hpp"
#include "dermis/store/frames_csv.hpp"
#include "seconds.hpp"

namespace dermis::app {
namespace {

struct RunOptions {
  std::string model;
  std::string in;
  std::string out;
  std::string sigma;
  double settle_s = 0.0;
};

Status run(const RunOptions& options) {
  const Result<Nanos> settle = nanos_from_seconds(options.settle_s, "--settle");
  if (!settle) return settle.error();
  if (options.sigma == options.out) return bad_input("--sigma: is the file of --out; name another");
  const Result<pipeline::Model> model = pipeline::read_model(options.model);
  if (!model) return model.error();
  Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(*model);
  if (!pipeline) return pipeline.error();
  Result<std::unique_ptr<store::FramesCsvReader>> source =
      store::FramesCsvReader::open(options.in, model->array.rows, model->array.cols);
  if (!source) return source.error();
  Result<store::ForcesCsvWriter> forces =
      store::ForcesCsvWriter::create(options.out, model->array.rows, model->array.cols);
  if (!forces) return forces.error();
  std::optional<store::ForcesCsvWriter> sigmas;
  if (!options.sigma.empty()) {
    Result<store::ForcesCsvWriter> created = store::ForcesCsvWriter::create(
        options.sigma, model->array.rows, model->array.cols, store::ForceColumn::sigma_newtons);
    if (!created) return created.error();
    sigmas.emplace(std::move(*created));
  }

  preprocessing::PhaseSelector phase(*settle, preprocessing::Phase::operate);
  std::size_t frames = 0;
  std::size_t rejected = 0;
  std::size_t unsolved = 0;
  std::size_t faulty = 0;
  std::string first_rejection;
  RawFrame raw;
  ForceFrame force;
  for (;;) {
    const Result<bool> more = (*source)->next(raw);
    if (!more) return more.error();
    if (!*more) break;
    if (phase.select(raw.time, false) != preprocessing::Destination::pipeline) continue;
    pipeline->process(raw, force);
    if (Status written = forces->write(force); !written) return written;
    if (sigmas) {
      if (Status written = sigmas->write(force); !written) return written;
    }
    ++frames;
    if (has(force.status, FrameStatus::not_converged)) ++unsolved;
    if (has(force.status, FrameStatus::line_fault)) ++faulty;
    if (!has(force.status, FrameStatus::rejected)) continue;
    if (rejected++ == 0) {
      first_rejection =
          fmt::format("{}:{}: {}", options.in, (*source)->line(), preprocessing::to_string(pipeline->rejection()));
    }
  }
  if (Status written = forces->commit(); !written) return written;
  if (sigmas) {
    if (Status written = sigmas->commit(); !written) return written;
  }
  if (rejected > 0) {
    fmt::print(stderr, "{} of {} frames rejected, the first: {}\n", rejected, frames, first_rejection);
  }
  if (unsolved > 0) {
    fmt::print(stderr, "{} of {} frames without forces: their readings do not fit the circuit of the array\n", unsolved,
               frames);
  }
  if (faulty > 0) {
    fmt::print(stderr, "{} of {} frames with faulty lines or taxels, which are masked: 'dermis doctor' tells which\n",
               faulty, frames);
  }
  return Done{};
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Raw counts -> newtons per taxel");
  command->add_option("--model", options->model, "Model file of 'dermis calibrate'")->required();
  command->add_option("--in", options->in, "frames.csv: raw counts")->required();
  command->add_option("--out", options->out, "forces.csv to write")->required();
  command->add_option("--sigma", options->sigma, "Also write the standard deviation of every force [N] to this CSV");
  command->add_option("--settle", options->settle_s, "Leave out the first seconds, while the array warms up [s]")
      ->capture_default_str();
  command->callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace dermis::app
