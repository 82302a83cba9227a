// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/frame_sink.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace dermis {
namespace {

class Counts final : public FrameSink {
 public:
  explicit Counts(std::vector<float>& counts) : counts_(&counts) {}
  Status write(const RawFrame& frame) override {
    counts_->insert(counts_->end(), frame.counts.begin(), frame.counts.end());
    return Done{};
  }
  Status commit() override { return Done{}; }

 private:
  std::vector<float>* counts_;
};

TEST(FrameSink, is_written_to_through_the_interface) {
  std::vector<float> counts;
  const std::unique_ptr<FrameSink> sink = std::make_unique<Counts>(counts);
  RawFrame frame;
  frame.counts = {1.0F, 2.0F};
  EXPECT_TRUE(sink->write(frame));
  EXPECT_TRUE(sink->commit());
  EXPECT_EQ(counts, frame.counts);
}

}  // namespace
}  // namespace dermis
