// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/live/sources/open_source.hpp"
#include "dermis/live/sources/source_name.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::sources {

/// All that is known of an array, in one folder (docs/file-formats.md): its description, models and recordings, and
/// source.toml, by which its device is found again.
struct ArrayFolder {
  std::string path;   ///< "mat"
  std::string model;  ///< Its newest model; without one its array.toml, or its array.suit.toml where it has places.
  std::string from;   ///< Name of its source as it was last time; empty: not known.

  [[nodiscard]] bool is_calibrated() const { return model.ends_with(".safetensors"); }
  [[nodiscard]] bool is_suit() const { return model.ends_with(".suit.toml"); }
};

/// Whether a folder of that name holds an array.toml.
[[nodiscard]] bool is_array_folder(const std::string& path);

/// Fails where the folder has no array.toml, or its source.toml cannot be read.
[[nodiscard]] Result<ArrayFolder> read_array_folder(const std::string& path);

/// Writes source.toml: the URI without its layout, which is named beside it. A serial port is written by its lasting
/// name, which holds the serial number of the board, if it has one.
[[nodiscard]] Status write_array_source(const std::string& folder, const SourceName& from);

/// Where the device of the folder is now, by frames of that shape, as they are sent. It is looked for at its place of
/// last time and, at a serial port, at the others: first at boards of the same name. Waits 2.5 s at each for the first
/// frame. Fails where it is at none.
[[nodiscard]] Result<SourceName> find_source(const ArrayFolder& folder, FrameShape sent, const SourceOptions& options);

}  // namespace dermis::live::sources
