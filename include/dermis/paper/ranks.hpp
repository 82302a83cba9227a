// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::paper {

/// The processes that do one job together, of which this is one. All call the same functions in the same order.
class Ranks {
 public:
  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  /// 0 ... count() - 1
  [[nodiscard]] virtual std::size_t rank() const noexcept = 0;
  [[nodiscard]] virtual std::size_t count() const noexcept = 0;
  /// The bytes of `root` become those of all.
  virtual void broadcast(std::span<std::byte> bytes, std::size_t root) = 0;
};

/// This process alone.
[[nodiscard]] Ranks& one_process() noexcept;

/// The job of Open MPI that this process belongs to; where mpirun did not start it, the process alone. Errors: the
/// plugin of MPI cannot be loaded. Call it once.
[[nodiscard]] Result<std::unique_ptr<Ranks>> open_ranks();

/// Items that one rank has of those of a job.
struct Part {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// Equal parts, but for one item.
[[nodiscard]] Part part_of(std::size_t items, std::size_t rank, std::size_t ranks) noexcept;
[[nodiscard]] inline Part own_part(const Ranks& ranks, std::size_t items) noexcept {
  return part_of(items, ranks.rank(), ranks.count());
}

template <typename T>
void broadcast(Ranks& ranks, std::span<T> values, std::size_t root = 0) {
  static_assert(std::is_trivially_copyable_v<T>);
  ranks.broadcast(std::as_writable_bytes(values), root);
}

template <typename T>
void broadcast_value(Ranks& ranks, T& value, std::size_t root = 0) {
  broadcast(ranks, std::span(&value, 1), root);
}

/// A string or a vector, of any size on rank `root`.
template <typename List>
void broadcast_list(Ranks& ranks, List& list, std::size_t root = 0) {
  std::size_t size = list.size();
  broadcast_value(ranks, size, root);
  list.resize(size);
  broadcast(ranks, std::span(list.data(), size), root);
}

/// Each rank brings its part of the values, and all get them all.
template <typename T>
void gather(Ranks& ranks, std::span<T> values) {
  for (std::size_t root = 0; root < ranks.count(); ++root) {
    const Part part = part_of(values.size(), root, ranks.count());
    broadcast(ranks, values.subspan(part.first, part.count), root);
  }
}

/// Done where it is on all ranks; else the error of the first that has one, on all.
[[nodiscard]] Status agreed(Ranks& ranks, const Status& own);

}  // namespace dermis::paper
