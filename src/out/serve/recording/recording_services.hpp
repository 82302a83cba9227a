// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/live/suits/live_suit.hpp"
#include "dermis/out/websocket/server.hpp"
#include "out/serve/parts/part.hpp"
#include "out/serve/recording/last_minute.hpp"
#include "out/serve/recording/played_recording.hpp"
#include "out/serve/recording/recordings_folder.hpp"
#include "out/serve/recording/saved_minute.hpp"
#include "out/serve/recording/suit_recorder.hpp"
#include "out/serve/requests/json_request.hpp"
#include "out/serve/suit/models_in_use.hpp"

namespace dermis::out::serve {

/// The services /recordings/... of docs/stream.md: what clients record, save, play and take away. Services are called
/// by one thread, as websocket::Server promises; the rest by any.
class RecordingServices final : public Part {
 public:
  /// `options`: of the session; the folder is that of its recording. `arrays`: how they are recorded now. `played`:
  /// empty where nothing may be played. `models`, `recorder` and `server` must outlive it.
  RecordingServices(const ServedSuit& suit, const SessionOptions& options, SuitRecorder::Arrays arrays,
                    const ModelsInUse& models, SuitRecorder& recorder, websocket::Server& server,
                    std::optional<PlayedRecording::PlayedSuit> played);

  /// "/recordings/begin", ... Errors: a request that is wrong; those of a recording.
  [[nodiscard]] std::vector<websocket::Service> services() override;
  [[nodiscard]] std::vector<LiveParameter> parameters() override;
  void keep(std::size_t array, const RawFrame& frame) override;

 private:
  [[nodiscard]] Result<std::string> begin(const JsonRequest& request);
  [[nodiscard]] Result<std::string> list(const JsonRequest& request);
  [[nodiscard]] Result<std::string> play(const JsonRequest& request);
  [[nodiscard]] Result<std::string> save(const JsonRequest& request);
  [[nodiscard]] Result<std::string> save_array(std::size_t array, const bytes::recordings::RecordedArray& recorded,
                                               const Selection& selection);
  [[nodiscard]] std::string path_of(const std::string& wanted) const;
  [[nodiscard]] Status switch_recorder(bool on);
  void give(const std::string& path);

  const RecordingsFolder folder_;
  const SuitRecorder::Arrays arrays_;
  const ModelsInUse& models_;
  SuitRecorder& recorder_;
  websocket::Server& server_;
  LastMinute last_minute_;
  std::optional<PlayedRecording> player_;
};

}  // namespace dermis::out::serve
