// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The ends of the session that a page does not have yet: recordings, what is kept in folders, and what other machines
// hear.
#include <utility>

#include "dermis/live/dds/publisher.hpp"
#include "out/serve/health/kept_zero.hpp"
#include "out/serve/recording/recorded_arrays.hpp"
#include "out/serve/recording/recordings_folder.hpp"
#include "out/serve/recording/suit_recorder.hpp"

namespace dermis {
namespace {

Error not_in_a_page() {
  return bad_input("a page cannot do this; the command dermis can");
}

}  // namespace

class bytes::recordings::SuitRecordingWriter::Implementation {};
bytes::recordings::SuitRecordingWriter::~SuitRecordingWriter() = default;

void bytes::recordings::SuitRecordingReader::seek(Nanos /*time*/) {}

namespace out::serve {

SuitRecorder::SuitRecorder(std::string wanted, Arrays arrays, Failed failed, Written written)
    : wanted_(std::move(wanted)),
      arrays_(std::move(arrays)),
      failed_(std::move(failed)),
      written_(std::move(written)) {}

SuitRecorder::~SuitRecorder() = default;

Status SuitRecorder::begin(std::string /*path*/) {
  return not_in_a_page();
}

Status SuitRecorder::end() {
  return Done{};
}

std::string SuitRecorder::path() const {
  return {};
}

void SuitRecorder::write(const bytes::recordings::RecordedEvent& /*event*/) {}

std::vector<bytes::recordings::RecordedArray> recorded_arrays(const ServedSuit& /*suit*/,
                                                              const ModelsInUse& /*models*/) {
  return {};
}

KeptZero::KeptZero(const ServedSuit& /*suit*/, const ServedArray& /*array*/) {}

std::vector<double> KeptZero::read() const {
  return {};
}

std::string KeptZero::taken_at() const {
  return {};
}

Status KeptZero::write(std::span<const double> /*offsets*/) const {
  return Done{};
}

void KeptZero::remove() const {}

std::string absolute_path(const std::string& path) {
  return path;
}

}  // namespace out::serve

namespace live::dds {

class Publisher::Implementation {};
Publisher::~Publisher() = default;

Result<std::unique_ptr<Publisher>> Publisher::create(const PublisherOptions& /*options*/) {
  return not_in_a_page();
}

Result<TopicId> Publisher::add_topic(const Topic& /*topic*/) {
  return not_in_a_page();
}

bool Publisher::has_subscribers(TopicId /*topic*/) const noexcept {
  return false;
}

void Publisher::publish(TopicId /*topic*/, std::span<const std::uint8_t> /*message*/) {}

std::uint64_t Publisher::left_out() const noexcept {
  return 0;
}

}  // namespace live::dds
}  // namespace dermis
