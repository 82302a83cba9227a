// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/hdf5_plugin.hpp"
#include "dataset_frames.hpp"
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

class Plugin final : public Hdf5Plugin {
 public:
  Result<Hdf5Contents> contents(const std::string& path) override {
    const QuietHdf5 quiet;
    const Result<Hdf5Input> file = Hdf5Input::open(path);
    if (!file) return file.error();
    return Hdf5Contents{file->contains("counts"), file->contains("pressure") && file->contains("frame_count"),
                        file->datasets_text()};
  }
  Result<std::unique_ptr<NotedFrames>> open_frames(const std::string& path,
                                                   const std::optional<FrameShape>& shape) override {
    return as<NotedFrames>(Hdf5FramesReader::open(path, shape));
  }
  Result<std::unique_ptr<FrameSource>> open_wiresens(const std::string& path,
                                                     const std::optional<FrameShape>& shape) override {
    return as<FrameSource>(WiresensHdf5Reader::open(path, shape));
  }
  Result<std::unique_ptr<FrameSource>> open_dataset(const std::string& path, const std::string& dataset,
                                                    const std::optional<FrameShape>& shape,
                                                    const std::optional<double>& rate_hz) override {
    return as<FrameSource>(Hdf5DatasetReader::open(path, dataset, shape, rate_hz));
  }
  Result<std::unique_ptr<formats::MatlabFile>> open_matlab(const std::string& path) override {
    return recordings::open_matlab(path);
  }
  Result<std::unique_ptr<FrameSink>> create_frames(const std::string& path, FrameShape shape,
                                                   const FrameNotes& notes) override {
    return as<FrameSink>(Hdf5FramesWriter::create(path, shape, notes));
  }
  Result<std::unique_ptr<FrameSink>> create_wiresens(const std::string& path, FrameShape shape) override {
    return as<FrameSink>(WiresensHdf5Writer::create(path, shape));
  }
  Result<std::unique_ptr<Hdf5Tables>> create_tables(const std::string& path) override {
    return recordings::create_tables(path);
  }
};

}  // namespace
}  // namespace dermis::bytes::recordings

extern "C" __attribute__((visibility("default"))) void dermis_hdf5(dermis::bytes::recordings::Hdf5Plugin*& found) {
  static dermis::bytes::recordings::Plugin plugin;
  found = &plugin;
}
