// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/name_lease.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <thread>

#include "nats_server.hpp"

namespace dermis::live::fleet {
namespace {

using State = NameLease::State;
using std::chrono::milliseconds;

/// Of another machine, so that nobody knows whether it lives.
PublishingProcess elsewhere(const std::string& token) {
  return {.token = token, .host = "bob.local", .kernel = "another", .pid = 1};
}

class Leases : public testing::Test {
 public:
  void SetUp() override {
    if (!support::NatsServer::is_installed()) GTEST_SKIP() << "skipped: nats-server is not installed";
    server = std::make_unique<support::NatsServer>();
    auto connected = connect_broker({server->url()});
    if (!connected) GTEST_SKIP() << "skipped: " << connected.error().message;
    broker = *std::move(connected);
    for (int look = 0; look < 600 && !make_leases(*broker); ++look) std::this_thread::sleep_for(milliseconds(100));
  }
  [[nodiscard]] State taken(NameLease& lease) const {
    const Status asked = lease.take(*broker);
    EXPECT_TRUE(asked) << asked.error().message;
    return lease.state();
  }

  std::unique_ptr<support::NatsServer> server;
  std::unique_ptr<Broker> broker;
};

TEST_F(Leases, the_first_has_the_name_and_the_second_is_told_who) {
  NameLease first("anna", elsewhere("1"), "", false);
  NameLease second("anna", elsewhere("2"), "", false);
  EXPECT_EQ(taken(first), State::held);
  EXPECT_EQ(taken(second), State::taken);
  EXPECT_EQ(second.holder().shown(), "process 1 on bob.local");
  const std::uint64_t seen = second.holder_revision();
  EXPECT_EQ(taken(first), State::held);
  EXPECT_EQ(taken(second), State::taken);
  EXPECT_GT(second.holder_revision(), seen);
  NameLease other("bob", elsewhere("3"), "", false);
  EXPECT_EQ(taken(other), State::held);
}

TEST_F(Leases, who_takes_over_has_the_later_session_and_the_other_knows_for_good) {
  NameLease first("anna", elsewhere("1"), "", false);
  NameLease second("anna", elsewhere("2"), "", true);
  EXPECT_EQ(taken(first), State::held);
  EXPECT_EQ(taken(second), State::held);
  EXPECT_GT(second.session(), first.session());
  EXPECT_EQ(taken(first), State::replaced);
  second.give_back(*broker);
  EXPECT_EQ(taken(first), State::replaced);
}

TEST_F(Leases, a_name_is_free_when_it_is_given_back_or_not_renewed) {
  NameLease first("anna", elsewhere("1"), "", false);
  NameLease second("anna", elsewhere("2"), "", false);
  EXPECT_EQ(taken(first), State::held);
  first.give_back(*broker);
  EXPECT_EQ(taken(second), State::held);
  NameLease third("anna", elsewhere("3"), "", false);
  EXPECT_EQ(taken(third), State::taken);
  for (int look = 0; look < 600 && taken(third) != State::held; ++look) std::this_thread::sleep_for(milliseconds(100));
  EXPECT_EQ(third.state(), State::held);
  EXPECT_EQ(taken(second), State::taken);  // it slept too long
}

TEST_F(Leases, the_name_of_a_process_of_this_machine_that_was_killed_is_free_at_once) {
  PublishingProcess dead = this_process();
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  dead.pid = child;
  ::waitpid(child, nullptr, 0);
  NameLease first("anna", dead, "", false);
  NameLease second("anna", this_process(), "", false);
  NameLease third("anna", this_process(), "", false);
  EXPECT_EQ(taken(first), State::held);
  EXPECT_EQ(taken(second), State::held);
  EXPECT_EQ(taken(third), State::taken);  // this process lives
}

TEST_F(Leases, a_server_that_was_away_costs_nobody_the_name) {
  NameLease first("anna", elsewhere("1"), "", false);
  EXPECT_EQ(taken(first), State::held);
  const std::uint64_t session = first.session();
  server->kill();
  EXPECT_FALSE(first.take(*broker));
  EXPECT_EQ(first.state(), State::held);
  server->start();
  for (int look = 0; look < 600 && !first.take(*broker); ++look) std::this_thread::sleep_for(milliseconds(100));
  EXPECT_EQ(first.state(), State::held);
  EXPECT_EQ(first.session(), session);
}

TEST(PublishingProcess, anything_is_read_and_what_is_shown_is_plain) {
  EXPECT_FALSE(process_from_json(""));
  EXPECT_FALSE(process_from_json("{}"));
  EXPECT_FALSE(process_from_json("[1]"));
  EXPECT_FALSE(process_from_json(std::string(5000, '[')));
  const auto process = process_from_json(R"({"token":"a","host":"\u001b[31mx\n","pid":99999999999})");
  ASSERT_TRUE(process);
  EXPECT_EQ(process->shown(), "process 0 on 31mx");
  EXPECT_FALSE(process->is_gone());
  const PublishingProcess self = this_process();
  const auto read = process_from_json(to_json(self));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->token, self.token);
  EXPECT_FALSE(read->is_gone());
}

}  // namespace
}  // namespace dermis::live::fleet
