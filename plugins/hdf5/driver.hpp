// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <hdf5.h>

#include "dermis/bytes/files/atomic_file.hpp"

namespace dermis::bytes::recordings {

/// Lets HDF5 read and write `file` instead of a path (its "virtual file driver"); `file` must outlive the HDF5 file.
/// HDF5 always gets success from a write: errors are in file.status().
[[nodiscard]] bool set_atomic_file_driver(hid_t file_access, files::AtomicFile& file);

}  // namespace dermis::bytes::recordings
