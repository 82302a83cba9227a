// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <memory>

#include "dermis/acquisition/source_uri.hpp"
#include "dermis/core/array_description.hpp"
#include "dermis/core/frame_source.hpp"
#include "dermis/core/result.hpp"

namespace dermis::app {

/// The source of a URI sim:SCENE. With rate: a device that sends the frames of the scene over and over at that rate,
/// with sequence and device time; frames that are not fetched within 500 ms are lost, as they would be in the buffers
/// of a TCP connection; the scene "contacts" runs at its own speed whatever the rate. Without: the scene once, as fast
/// as it is read. The array is that of the URI, else `array`, else the reference array of examples/chest, with the rows
/// and cols of the URI; fails where they disagree.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_simulation(const acquisition::SourceUri& uri,
                                                                   const ArrayDescription* array,
                                                                   const std::atomic<bool>* stop);

}  // namespace dermis::app
