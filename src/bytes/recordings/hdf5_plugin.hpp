// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "dermis/bytes/files/process_outputs.hpp"
#include "dermis/bytes/formats/matlab.hpp"
#include "dermis/bytes/recordings/frame_notes.hpp"
#include "dermis/bytes/recordings/hdf5_tables.hpp"
#include "dermis/touch/frames/frame_sink.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// The work of the plugin of HDF5, which is loaded with the first file of that format.
namespace dermis::bytes::recordings {

class NotedFrames : public FrameSource {
 public:
  [[nodiscard]] virtual const FrameNotes& notes() const noexcept = 0;
};

/// The contents of a file, by the names of its datasets.
struct Hdf5Contents {
  bool has_frames = false;    ///< As create_frames() writes them, or alike.
  bool has_wiresens = false;  ///< As the WiReSens toolkit writes them.
  std::string datasets;       ///< "; it has: '/observations/tactile' (500 x 8 x 8), ..."
};

/// Its functions; the headers in plugins/hdf5 say more of each. `shape`: fails where frames have another.
struct Hdf5Plugin {
  Result<Hdf5Contents> (*contents)(const std::string& path);
  Result<std::unique_ptr<NotedFrames>> (*open_frames)(const std::string& path, const std::optional<FrameShape>& shape);
  Result<std::unique_ptr<FrameSource>> (*open_wiresens)(const std::string& path,
                                                        const std::optional<FrameShape>& shape);
  Result<std::unique_ptr<FrameSource>> (*open_dataset)(const std::string& path, const std::string& dataset,
                                                       const std::optional<FrameShape>& shape,
                                                       const std::optional<double>& rate_hz);
  /// A file of MATLAB 7.3. The values are in its order, not in that of HDF5.
  Result<std::unique_ptr<formats::MatlabFile>> (*open_matlab)(const std::string& path);
  Result<std::unique_ptr<FrameSink>> (*create_frames)(const std::string& path, FrameShape shape,
                                                      const FrameNotes& notes);
  Result<std::unique_ptr<FrameSink>> (*create_wiresens)(const std::string& path, FrameShape shape);
  Result<std::unique_ptr<Hdf5Tables>> (*create_tables)(const std::string& path);
};

/// The function of the plugin that finds them, and its name. The plugin has the outputs of the process then.
using FindHdf5 = void (*)(const Hdf5Plugin*& found, files::ProcessOutputs& outputs);
inline constexpr const char* kFindHdf5 = "dermis_hdf5";

/// Fails where the plugin or the library of HDF5 is not there.
[[nodiscard]] Result<const Hdf5Plugin*> load_hdf5();

/// A function of the plugin: by_hdf5(&Hdf5Plugin::open_wiresens, path, shape).
template <typename Made, typename... Parameters, typename... Arguments>
[[nodiscard]] Result<Made> by_hdf5(Result<Made> (*Hdf5Plugin::*function)(Parameters...), Arguments&&... arguments) {
  const Result<const Hdf5Plugin*> plugin = load_hdf5();
  if (!plugin) return plugin.error();
  return ((*plugin)->*function)(std::forward<Arguments>(arguments)...);
}

}  // namespace dermis::bytes::recordings
