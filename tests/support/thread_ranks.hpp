// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <barrier>
#include <cstddef>
#include <cstring>
#include <functional>
#include <span>
#include <thread>
#include <vector>

#include "dermis/paper/ranks.hpp"

namespace dermis::support {

/// Calls body(ranks) on so many threads, which stand for the processes of a job.
inline void on_ranks(std::size_t count, const std::function<void(paper::Ranks&)>& body) {
  struct Job {
    explicit Job(std::size_t ranks) : count(ranks), meeting(static_cast<std::ptrdiff_t>(ranks)) {}
    std::size_t count;
    std::barrier<> meeting;
    std::span<const std::byte> shown;
  } job(count);

  class ThreadRanks final : public paper::Ranks {
   public:
    ThreadRanks(Job& job, std::size_t rank) : job_(job), rank_(rank) {}
    [[nodiscard]] std::size_t rank() const noexcept override { return rank_; }
    [[nodiscard]] std::size_t count() const noexcept override { return job_.count; }
    void broadcast(std::span<std::byte> bytes, std::size_t root) override {
      if (rank_ == root) job_.shown = bytes;
      job_.meeting.arrive_and_wait();
      if (rank_ != root && !bytes.empty()) std::memcpy(bytes.data(), job_.shown.data(), bytes.size());
      job_.meeting.arrive_and_wait();
    }

   private:
    Job& job_;
    std::size_t rank_;
  };

  std::vector<std::jthread> threads;
  for (std::size_t rank = 0; rank < count; ++rank) {
    threads.emplace_back([&, rank] {
      ThreadRanks ranks(job, rank);
      body(ranks);
    });
  }
}

}  // namespace dermis::support
