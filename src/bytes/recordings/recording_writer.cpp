// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <utility>

#include "dermis/bytes/recordings/recording.hpp"

namespace dermis::bytes::recordings {

RecordingWriter::RecordingWriter(std::unique_ptr<SuitRecordingWriter> suit) : suit_(std::move(suit)) {}

RecordingWriter::~RecordingWriter() = default;

Result<std::unique_ptr<RecordingWriter>> RecordingWriter::create(const std::string& path, const FrameShape& shape,
                                                                 const RecordingOptions& options) {
  Result<std::unique_ptr<SuitRecordingWriter>> suit =
      SuitRecordingWriter::create(path,
                                  {{options.name, shape, options.array_toml, options.model_hash, options.pitch,
                                    options.simulation, options.model_file}},
                                  {options.compression, options.live});
  if (!suit) return suit.error();
  return std::unique_ptr<RecordingWriter>(new RecordingWriter(*std::move(suit)));
}

Status RecordingWriter::write(const RawFrame& frame) {
  return suit_->write(0, frame);
}

Status RecordingWriter::write(const RawFrame& frame, const ForceFrame& force) {
  return suit_->write(0, frame, force);
}

Status RecordingWriter::commit() {
  return suit_->commit();
}

}  // namespace dermis::bytes::recordings
