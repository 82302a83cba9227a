// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis.h"

#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/models/model_file.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/frames/version.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

using dermis::Error;
using dermis::ErrorKind;
using dermis::Result;

struct dermis_model {
  dermis::touch::pipeline::Model model;
};

struct dermis_pipeline {
  dermis::touch::pipeline::Pipeline pipeline;
  dermis::ArrayDescription array;
  dermis::RawFrame raw;
  dermis::ForceFrame force;
  std::string refusal;
};

struct dermis_tracker {
  std::size_t taxels;
  dermis::touch::contacts::ContactTracker tracker;
  dermis::ContactReport report;
  std::vector<dermis_contact> contacts;
};

struct dermis_source {
  std::atomic<bool> stop = false;
  std::unique_ptr<dermis::FrameSource> source;
  dermis::RawFrame frame;
};

namespace {

std::string& last_error() {
  thread_local std::string error;
  return error;
}

dermis_status report(const Error& error) {
  last_error() = error.message;
  return error.kind == ErrorKind::bad_input ? DERMIS_BAD_INPUT : DERMIS_FAILED;
}

/// Runs work() -> dermis_status. Whatever it throws ends here.
template <class Work>
dermis_status guarded(const Work& work) noexcept {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    last_error() = "no memory";  // short enough to need none
  } catch (const std::exception& error) {
    last_error() = "internal error";
  }
  return DERMIS_FAILED;
}

dermis_status null_argument(const char* name) {
  return report(dermis::bad_input(std::string(name) + ": is NULL"));
}

std::optional<double> there(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

dermis_contact contact_of(const dermis::Contact& contact) {
  return {.id = contact.id,
          .phase = static_cast<std::uint32_t>(contact.phase),
          .onset_ns = contact.onset.count(),
          .x_m = contact.position.x,
          .y_m = contact.position.y,
          .sigma_x_m = contact.sigma_position_m.x,
          .sigma_y_m = contact.sigma_position_m.y,
          .velocity_x_m_s = contact.velocity.x,
          .velocity_y_m_s = contact.velocity.y,
          .force_n = contact.force_n,
          .sigma_force_n = contact.sigma_force_n,
          .area_m2 = contact.area_m2,
          .peak_pressure_pa = contact.peak_pressure_pa,
          .taxels = contact.taxels};
}

}  // namespace

const char* dermis_version() {
  return DERMIS_VERSION;
}

const char* dermis_last_error() {
  return last_error().c_str();
}

dermis_status dermis_model_read(const char* path, dermis_model** model) {
  if (model == nullptr) return null_argument("model");
  *model = nullptr;
  if (path == nullptr) return null_argument("path");
  return guarded([&] {
    Result<dermis::touch::pipeline::Model> read = dermis::bytes::models::read_model(path);
    if (!read) return report(read.error());
    *model = new dermis_model{*std::move(read)};
    return DERMIS_OK;
  });
}

void dermis_model_free(dermis_model* model) {
  delete model;
}

size_t dermis_model_rows(const dermis_model* model) {
  return model == nullptr ? 0 : model->model.array.rows;
}

size_t dermis_model_cols(const dermis_model* model) {
  return model == nullptr ? 0 : model->model.array.cols;
}

const char* dermis_model_name(const dermis_model* model) {
  return model == nullptr ? "" : model->model.array.name.c_str();
}

dermis_status dermis_pipeline_create(const dermis_model* model, dermis_pipeline** pipeline) {
  if (pipeline == nullptr) return null_argument("pipeline");
  *pipeline = nullptr;
  if (model == nullptr) return null_argument("model");
  return guarded([&] {
    Result<dermis::touch::pipeline::Pipeline> created = dermis::touch::pipeline::Pipeline::create(model->model);
    if (!created) return report(created.error());
    *pipeline = new dermis_pipeline{
        .pipeline = *std::move(created), .array = model->model.array, .raw = {}, .force = {}, .refusal = {}};
    return DERMIS_OK;
  });
}

void dermis_pipeline_free(dermis_pipeline* pipeline) {
  delete pipeline;
}

dermis_status dermis_pipeline_process(dermis_pipeline* pipeline, const dermis_raw_frame* raw,
                                      dermis_force_frame* force) {
  if (pipeline == nullptr) return null_argument("pipeline");
  if (raw == nullptr || raw->counts == nullptr) return null_argument("raw");
  if (force == nullptr) return null_argument("force");
  return guarded([&] {
    dermis::RawFrame& frame = pipeline->raw;
    frame.time = dermis::Nanos(raw->time_ns);
    frame.temperature_celsius = there(raw->temperature_celsius);
    frame.supply_v = there(raw->supply_v);
    frame.counts.assign(raw->counts, raw->counts + raw->count);
    const dermis::ForceFrame& result = pipeline->force;
    pipeline->pipeline.process(frame, pipeline->force);
    static_assert(sizeof(dermis::TaxelStatus) == 1);
    *force = {.time_ns = result.time.count(),
              .status = static_cast<std::uint32_t>(result.status),
              .newtons = result.newtons.data(),
              .sigma_newtons = result.sigma_newtons.data(),
              .signal_to_noise = result.signal_to_noise.data(),
              // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): an enum of one byte
              .taxels = reinterpret_cast<const std::uint8_t*>(result.taxels.data()),
              .count = result.newtons.size()};
    return DERMIS_OK;
  });
}

dermis_status dermis_pipeline_total(const dermis_pipeline* pipeline, const std::uint8_t* mask, size_t count,
                                    dermis_total* total) {
  if (pipeline == nullptr) return null_argument("pipeline");
  if (total == nullptr) return null_argument("total");
  return guarded([&] {
    const std::size_t taxels = pipeline->force.newtons.size();
    if (mask != nullptr && count != taxels) {
      return report(dermis::bad_input("mask: has " + std::to_string(count) + " taxels, the last frame " +
                                      std::to_string(taxels)));
    }
    std::vector<std::size_t> region;
    for (std::size_t taxel = 0; mask != nullptr && taxel < count; ++taxel) {
      if (mask[taxel] != 0) region.push_back(taxel);
    }
    const dermis::TotalForce sum = mask == nullptr ? pipeline->force.total() : pipeline->force.total(region);
    *total = {.newtons = sum.newtons, .sigma_newtons = sum.sigma_newtons, .left_out = sum.left_out};
    return DERMIS_OK;
  });
}

dermis_status dermis_pipeline_tare(dermis_pipeline* pipeline) {
  if (pipeline == nullptr) return null_argument("pipeline");
  pipeline->pipeline.tare();
  return DERMIS_OK;
}

dermis_status dermis_pipeline_tare_force(dermis_pipeline* pipeline) {
  if (pipeline == nullptr) return null_argument("pipeline");
  pipeline->pipeline.tare(dermis::touch::pipeline::TareOver::any_load);
  return DERMIS_OK;
}

const char* dermis_pipeline_tare_refused(dermis_pipeline* pipeline) {
  if (pipeline == nullptr) return "";
  static_cast<void>(guarded([&] {
    const dermis::touch::pipeline::Tare& tare = pipeline->pipeline.last_tare();
    const bool is_refused = tare.state == dermis::touch::pipeline::Tare::State::refused;
    pipeline->refusal = is_refused ? dermis::touch::pipeline::describe(tare, pipeline->array) : "";
    return DERMIS_OK;
  }));
  return pipeline->refusal.c_str();
}

dermis_status dermis_pipeline_undo_tare(dermis_pipeline* pipeline) {
  if (pipeline == nullptr) return null_argument("pipeline");
  pipeline->pipeline.undo_tare();
  return DERMIS_OK;
}

dermis_status dermis_pipeline_follow_drift(dermis_pipeline* pipeline, int follow) {
  if (pipeline == nullptr) return null_argument("pipeline");
  dermis::touch::compensation::OffsetDriftOptions options = pipeline->pipeline.drift().options();
  options.track = follow != 0;
  pipeline->pipeline.drift().set_options(options);
  return DERMIS_OK;
}

dermis_status dermis_tracker_create(const dermis_model* model, dermis_tracker** tracker) {
  if (tracker == nullptr) return null_argument("tracker");
  *tracker = nullptr;
  if (model == nullptr) return null_argument("model");
  return guarded([&] {
    dermis::touch::contacts::ContactTracker created(model->model.array, {}, model->model.strip);
    *tracker = new dermis_tracker{
        .taxels = model->model.array.taxel_count(), .tracker = std::move(created), .report = {}, .contacts = {}};
    return DERMIS_OK;
  });
}

void dermis_tracker_free(dermis_tracker* tracker) {
  delete tracker;
}

dermis_status dermis_tracker_process(dermis_tracker* tracker, const dermis_pipeline* pipeline,
                                     const dermis_contact** contacts, size_t* count) {
  if (tracker == nullptr) return null_argument("tracker");
  if (pipeline == nullptr) return null_argument("pipeline");
  if (contacts == nullptr || count == nullptr) return null_argument("contacts");
  return guarded([&] {
    tracker->contacts.clear();
    *contacts = nullptr;
    *count = 0;
    const std::size_t taxels = pipeline->force.newtons.size();
    if (taxels == 0) return DERMIS_OK;  // before the first frame
    if (taxels != tracker->taxels) return report(dermis::bad_input("pipeline: is of an array with other taxels"));
    tracker->tracker.process(pipeline->force, tracker->report);
    for (const dermis::Contact& contact : tracker->report.contacts) tracker->contacts.push_back(contact_of(contact));
    *contacts = tracker->contacts.data();
    *count = tracker->contacts.size();
    return DERMIS_OK;
  });
}

dermis_status dermis_source_open(const char* uri, const dermis_model* model, dermis_source** source) {
  if (source == nullptr) return null_argument("source");
  *source = nullptr;
  if (uri == nullptr) return null_argument("uri");
  return guarded([&] {
    auto opened = std::make_unique<dermis_source>();
    dermis::live::sources::SourceOptions options;
    options.stop = &opened->stop;
    if (model != nullptr) options.array = &model->model.array;
    Result<std::unique_ptr<dermis::FrameSource>> frames = dermis::live::sources::open_source(uri, options);
    if (!frames) return report(frames.error());
    opened->source = *std::move(frames);
    *source = opened.release();
    return DERMIS_OK;
  });
}

void dermis_source_free(dermis_source* source) {
  delete source;
}

dermis_status dermis_source_next(dermis_source* source, dermis_raw_frame* raw) {
  if (source == nullptr) return null_argument("source");
  if (raw == nullptr) return null_argument("raw");
  return guarded([&] {
    const Result<bool> more = source->source->next(source->frame);
    if (!more) return report(more.error());
    if (!*more) return DERMIS_END;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    *raw = {.time_ns = source->frame.time.count(),
            .temperature_celsius = source->frame.temperature_celsius.value_or(kNone),
            .supply_v = source->frame.supply_v.value_or(kNone),
            .counts = source->frame.counts.data(),
            .count = source->frame.counts.size()};
    return DERMIS_OK;
  });
}

void dermis_source_stop(dermis_source* source) {
  if (source != nullptr) source->stop = true;
}
