// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/hdf5_plugin.hpp"
#include "dataset_frames.hpp"
#include "dermis/bytes/files/process_outputs.hpp"
#include "frames.hpp"
#include "hdf5.hpp"
#include "matlab.hpp"
#include "tables.hpp"
#include "wiresens.hpp"

/// The plugin that dermis::recordings loads.
namespace dermis::bytes::recordings {
namespace {

template <typename Base, typename Derived>
Result<std::unique_ptr<Base>> as(Result<std::unique_ptr<Derived>> made) {
  if (!made) return made.error();
  return std::unique_ptr<Base>(*std::move(made));
}

Result<Hdf5Contents> contents_of(const std::string& path) {
  const QuietHdf5 quiet;
  const Result<Hdf5Input> file = Hdf5Input::open(path);
  if (!file) return file.error();
  return Hdf5Contents{file->contains("counts"), file->contains("pressure") && file->contains("frame_count"),
                      file->datasets_text()};
}

using Path = const std::string&;
using Shape = const std::optional<FrameShape>&;

constexpr Hdf5Plugin kPlugin{
    .contents = contents_of,
    .open_frames = [](Path path, Shape shape) { return as<NotedFrames>(Hdf5FramesReader::open(path, shape)); },
    .open_wiresens = [](Path path, Shape shape) { return as<FrameSource>(WiresensHdf5Reader::open(path, shape)); },
    .open_dataset =
        [](Path path, Path dataset, Shape shape, const std::optional<double>& rate_hz) {
          return as<FrameSource>(Hdf5DatasetReader::open(path, dataset, shape, rate_hz));
        },
    .open_matlab = open_matlab,
    .create_frames =
        [](Path path, FrameShape shape, const FrameNotes& notes) {
          return as<FrameSink>(Hdf5FramesWriter::create(path, shape, notes));
        },
    .create_wiresens = [](Path path,
                          FrameShape shape) { return as<FrameSink>(WiresensHdf5Writer::create(path, shape)); },
    .create_tables = create_tables};

}  // namespace
}  // namespace dermis::bytes::recordings

extern "C" __attribute__((visibility("default"))) void dermis_hdf5(const dermis::bytes::recordings::Hdf5Plugin*& found,
                                                                   dermis::bytes::files::ProcessOutputs& outputs) {
  dermis::bytes::files::share_process_outputs(outputs);
  H5dont_atexit();  // all is closed by then; of a damaged file it would print what it could not close
  found = &dermis::bytes::recordings::kPlugin;
}
