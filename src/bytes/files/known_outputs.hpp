// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <map>
#include <mutex>
#include <set>
#include <string>

#include "dermis/bytes/files/process_outputs.hpp"
#include "dermis/bytes/files/unfinished_file.hpp"

namespace dermis::bytes::files {

struct UnfinishedFiles {
  std::mutex mutex;
  std::set<std::string> paths;
  std::set<std::string> tidied;  ///< The folders in which nothing is left over.
};

struct BegunOutput {
  std::string target;
  UnfinishedFile file;
};

/// Names that the process has taken.
struct Claims {
  std::mutex mutex;
  std::map<std::string, BegunOutput> unopened;  ///< By their names, which may be links to other targets by now.
  std::set<std::string> unread;                 ///< Targets whose earlier file must not be read.
};

struct ProcessOutputs {
  UnfinishedFiles unfinished;
  Claims claims;
};

}  // namespace dermis::bytes::files
