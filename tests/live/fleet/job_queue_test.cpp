// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/job_queue.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include "nats_server.hpp"

namespace dermis::live::fleet {
namespace {

Job job_number(int number) {
  return {"job " + std::to_string(number), {"convert", std::to_string(number) + ".mcap", "out.csv"}};
}

class Jobs : public testing::Test {
 public:
  void SetUp() override {
    if (!support::NatsServer::is_installed()) GTEST_SKIP() << "skipped: nats-server is not installed";
    server = std::make_unique<support::NatsServer>();
    auto connected = JobQueue::connect({server->url()});
    if (!connected) GTEST_SKIP() << "skipped: " << connected.error().message;
    queue = *std::move(connected);
  }

  [[nodiscard]] TakenJob take() const {
    Result<std::optional<TakenJob>> taken = queue->take();
    EXPECT_TRUE(taken && *taken);
    return taken && *taken ? **taken : TakenJob{};
  }

  std::unique_ptr<support::NatsServer> server;
  std::unique_ptr<JobQueue> queue;
};

TEST_F(Jobs, are_taken_once_each) {
  for (int number = 0; number < 20; ++number) ASSERT_TRUE(queue->submit(job_number(number)));
  const auto other = JobQueue::connect({server->url()});
  ASSERT_TRUE(other);
  std::set<std::string> names;
  for (int i = 0; i < 20; ++i) {
    const auto taken = (i % 2 == 0 ? *queue : **other).take();
    ASSERT_TRUE(taken && *taken);
    names.insert((*taken)->job.name);
    ASSERT_TRUE(queue->finish(**taken, {(*taken)->job.name, "w", 0.1, ""}));
  }
  EXPECT_EQ(names.size(), 20U);
  EXPECT_FALSE(*queue->take());
  EXPECT_EQ(queue->counts()->done, 20U);
  EXPECT_EQ(queue->counts()->waiting + queue->counts()->taken, 0U);
}

TEST_F(Jobs, that_fail_three_times_are_given_up_with_the_reason) {
  ASSERT_TRUE(queue->submit(job_number(1)));
  for (std::uint64_t tries = 1; tries <= JobQueue::kMostTries; ++tries) {
    const TakenJob taken = take();
    EXPECT_EQ(taken.tries, tries);
    ASSERT_TRUE(queue->finish(taken, {taken.job.name, "w", 0.1, "exit status 2"}));
  }
  EXPECT_FALSE(*queue->take());
  EXPECT_EQ(queue->counts()->given_up, 1U);
  const auto given_up = queue->given_up();
  ASSERT_EQ(given_up->size(), 1U);
  EXPECT_EQ(given_up->front().name, "job 1");
  EXPECT_EQ(given_up->front().error, "exit status 2");
}

TEST_F(Jobs, with_a_final_error_are_given_up_at_once) {
  ASSERT_TRUE(queue->submit(job_number(1)));
  const TakenJob taken = take();
  ASSERT_TRUE(queue->finish(taken, {taken.job.name, "w", 0.1, "exit status 2", true}));
  EXPECT_FALSE(*queue->take());
  EXPECT_EQ(queue->counts()->given_up, 1U);
}

TEST_F(Jobs, survive_a_server_that_is_killed) {
  for (int number = 0; number < 5; ++number) ASSERT_TRUE(queue->submit(job_number(number)));
  server->kill();
  server->start();
  const auto again = JobQueue::connect({server->url()});
  ASSERT_TRUE(again) << again.error().message;
  for (int number = 0; number < 5; ++number) EXPECT_TRUE(*(*again)->take());
}

TEST_F(Jobs, that_may_not_be_done_are_not_submitted) {
  EXPECT_FALSE(queue->submit({"", {"sh", "-c", "true"}}));
  EXPECT_EQ(queue->counts()->waiting, 0U);
}

TEST_F(Jobs, that_are_given_back_are_taken_at_once) {
  ASSERT_TRUE(queue->submit(job_number(1)));
  ASSERT_TRUE(queue->give_back(take()));
  const TakenJob again = take();
  EXPECT_EQ(again.job, job_number(1));
  EXPECT_EQ(again.tries, 2U);
}

TEST_F(Jobs, that_another_worker_has_done_are_not_given_up) {
  ASSERT_TRUE(queue->submit(job_number(1)));
  const TakenJob first = take();
  ASSERT_TRUE(queue->give_back(first));
  const TakenJob second = take();
  ASSERT_TRUE(queue->finish(second, {second.job.name, "w", 0.1, ""}));
  EXPECT_TRUE(queue->finish(first, {first.job.name, "v", 0.1, "exit status 2", true}));
  EXPECT_EQ(queue->counts()->done, 1U);
  EXPECT_EQ(queue->counts()->given_up, 0U);
}

TEST_F(Jobs, may_be_extended) {
  ASSERT_TRUE(queue->submit(job_number(1)));
  EXPECT_TRUE(queue->extend(take()));
  EXPECT_EQ(queue->counts()->taken, 1U);
}

}  // namespace
}  // namespace dermis::live::fleet
