// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <unistd.h>

#include <memory>
#include <string>

#include "bindings.hpp"

namespace dermis::python {

/// The process that made an object: its threads and the state of its files are not in a process that fork() made.
class OwnProcess {
 public:
  [[nodiscard]] bool is_this() const { return ::getpid() == process_; }
  /// Raises in any other process. `what`: "the source".
  void require(const std::string& what) const {
    if (!is_this()) raise(failed(what + " is that of the process before fork(): make one in this process"));
  }

 private:
  pid_t process_ = ::getpid();
};

/// In any other process the object is left as it is: its end would wait for threads that are not there.
class EndsInOwnProcess {
 public:
  template <typename Owned>
  void operator()(Owned* owned) const {
    if (process_.is_this()) std::default_delete<Owned>()(owned);
  }

 private:
  OwnProcess process_;
};
template <typename Owned>
using HeldByItsProcess = std::unique_ptr<Owned, EndsInOwnProcess>;

}  // namespace dermis::python
