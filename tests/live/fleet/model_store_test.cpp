// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/model_store.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "dermis/live/fleet/hub.hpp"
#include "fleet_servers.hpp"
#include "live/fleet/broker.hpp"

namespace dermis::live::fleet {
namespace {

/// Bytes of a model that differ by `seed`.
std::string bytes_of(std::size_t count, unsigned seed) {
  std::string bytes(count, '\0');
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<char>(i * 31U + i / 251U + seed);
  return bytes;
}

TEST(Sha256, is_that_of_fips_180) {
  if (!sha256("")) GTEST_SKIP() << "skipped: " << sha256("").error().message;
  EXPECT_EQ(*sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(*sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

class Models : public testing::Test {
 public:
  void SetUp() override {
    if (!support::NatsServer::is_installed()) GTEST_SKIP() << "skipped: nats-server is not installed";
    hub = std::make_unique<support::NatsServer>();
    auto connected = ModelStore::connect({hub->url()});
    if (!connected) GTEST_SKIP() << "skipped: " << connected.error().message;
    store = *std::move(connected);
  }

  /// Replaces what the hub has under a subject of anna's chest.
  void replace(const std::string& subject, const std::string& text) const {
    const auto broker = connect_broker({hub->url()});
    ASSERT_TRUE(broker);
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    ASSERT_TRUE((*broker)->store("dermis-models.anna.chest." + subject, "", bytes));
  }

  /// Messages in the stream.
  std::size_t messages() const {
    const auto broker = connect_broker({hub->url()});
    const std::string info = *(*broker)->ask("$JS.API.STREAM.INFO.dermis-models", "");
    const std::size_t place = info.find("\"messages\":");
    return std::stoul(info.substr(place + 11));
  }

  std::unique_ptr<support::NatsServer> hub;
  std::unique_ptr<ModelStore> store;
  std::vector<std::string> unreadable;
};

TEST_F(Models, come_back_bit_by_bit_though_larger_than_a_message) {
  for (const std::size_t size : {1U, 262'144U, 262'145U, 5'000'000U}) {
    const std::string model = bytes_of(size, 1);
    const auto pushed = store->push("anna", "chest", "chest.safetensors", model);
    ASSERT_TRUE(pushed) << pushed.error().message;
    const auto manifest = store->manifest("anna", "chest");
    ASSERT_TRUE(manifest && *manifest);
    EXPECT_EQ(**manifest, *pushed);
    const auto fetched = store->fetch(**manifest);
    ASSERT_TRUE(fetched) << fetched.error().message;
    EXPECT_EQ(*fetched, model);
  }
}

TEST_F(Models, of_other_arrays_are_others) {
  ASSERT_TRUE(store->push("anna", "chest", "a", bytes_of(10, 1)));
  ASSERT_TRUE(store->push("anna", "back", "b", bytes_of(10, 2)));
  const auto manifest = store->manifest("bob", "chest");
  ASSERT_TRUE(manifest) << manifest.error().message;
  EXPECT_FALSE(*manifest);
  const auto all = store->all(unreadable);
  ASSERT_TRUE(all) << all.error().message;
  ASSERT_EQ(all->size(), 2U);
  EXPECT_EQ((*all)[0].array, "back");
  EXPECT_EQ((*all)[1].array, "chest");
}

TEST_F(Models, a_list_that_cannot_be_read_costs_no_other) {
  ASSERT_TRUE(store->push("anna", "chest", "a", bytes_of(10, 1)));
  ASSERT_TRUE(store->push("anna", "back", "b", bytes_of(10, 2)));
  replace("current", "nonsense");
  EXPECT_EQ(store->all(unreadable)->size(), 1U);
  ASSERT_EQ(unreadable.size(), 1U);
  EXPECT_TRUE(unreadable.front().ends_with("a list of pushed models: is none")) << unreadable.front();
}

TEST_F(Models, a_name_that_is_no_line_is_refused) {
  EXPECT_FALSE(store->push("anna", "chest", "two\nlines", bytes_of(10, 1)));
  EXPECT_TRUE(store->all(unreadable)->empty());
  EXPECT_TRUE(unreadable.empty());
}

TEST_F(Models, are_none_before_the_first_push) {
  EXPECT_TRUE(store->all(unreadable)->empty());
  EXPECT_FALSE(store->manifest("anna", "chest"));
  EXPECT_EQ(store->roll_back("anna", "chest").error().message, "anna/chest: no model was pushed to it");
}

TEST_F(Models, older_than_the_last_ten_are_removed) {
  for (unsigned k = 1; k <= 12; ++k) ASSERT_TRUE(store->push("anna", "chest", "m", bytes_of(300'000, k)));
  EXPECT_EQ(messages(), 10U * 2U + 1U);
  for (int back = 0; back < 9; ++back) ASSERT_TRUE(store->roll_back("anna", "chest"));
  EXPECT_FALSE(store->roll_back("anna", "chest"));
  EXPECT_EQ(*store->fetch(**store->manifest("anna", "chest")), bytes_of(300'000, 3));
}

TEST_F(Models, that_are_pushed_again_share_their_pieces) {
  for (int k = 0; k < 3; ++k) ASSERT_TRUE(store->push("anna", "chest", "m", bytes_of(300'000, 1)));
  EXPECT_EQ(messages(), 2U + 1U);
  EXPECT_EQ((*store->manifest("anna", "chest"))->current, 3U);
}

TEST_F(Models, whose_pieces_are_damaged_are_refused) {
  const auto pushed = store->push("anna", "chest", "m", bytes_of(300'000, 1));
  ASSERT_TRUE(pushed);
  const std::string first = pushed->current_model().sha256 + ".0";
  replace(first, bytes_of(262'144, 2));
  EXPECT_EQ(store->fetch(*pushed).error().message, "its SHA-256 is wrong; push it again");
  replace(first, bytes_of(500'000, 1));
  EXPECT_EQ(store->fetch(*pushed).error().message, "its pieces are larger than it; push it again");
  ModelManifest longer = *pushed;
  longer.models.front().pieces = 3;
  replace(first, bytes_of(100, 1));
  EXPECT_EQ(store->fetch(longer).error().message, "a piece of it is missing on the hub; push it again");
}

TEST_F(Models, manifests_that_cannot_be_are_refused_and_a_push_mends_them) {
  ASSERT_TRUE(store->push("anna", "chest", "m", bytes_of(10, 1)));
  replace("current", "{\"models\": [1, 2]}");
  const auto damaged = store->manifest("anna", "chest");
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().kind, ErrorKind::bad_input);
  replace("current", manifest_to_json(*store->push("bob", "chest", "m", bytes_of(10, 1))));
  EXPECT_EQ(store->manifest("anna", "chest").error().message, "a list of pushed models: is of bob/chest");
  ASSERT_TRUE(store->push("anna", "chest", "m", bytes_of(10, 2)));
  EXPECT_TRUE(store->manifest("anna", "chest"));
}

TEST_F(Models, do_not_wait_for_a_server_once_stopped) {
  store->stop();
  EXPECT_EQ(store->manifest("anna", "chest").error().kind, ErrorKind::failed);
}

TEST_F(Models, bounds_and_names_are_checked) {
  EXPECT_FALSE(store->push("anna", "chest", "m", ""));
  EXPECT_FALSE(store->push("a.b", "chest", "m", "x"));
  EXPECT_FALSE(store->push("anna", "*", "m", "x"));
  EXPECT_FALSE(store->manifest("anna", ">"));
}

TEST_F(Models, reach_a_robot_through_its_own_server_while_the_hub_is_there) {
  const auto servers = support::FleetServers::start({"anna", "bob"});
  ASSERT_TRUE(servers) << servers.error().message;
  const auto of_hub = ModelStore::connect((*servers)->operator_address());
  ASSERT_TRUE(of_hub) << of_hub.error().message;
  const auto of_robot = ModelStore::connect((*servers)->robot_address("anna"));
  ASSERT_TRUE(of_robot) << of_robot.error().message;
  const auto of_other = ModelStore::connect((*servers)->robot_address("bob"));
  ASSERT_TRUE(of_other) << of_other.error().message;
  const std::string model = bytes_of(1'000'000, 1);
  ASSERT_TRUE((*of_hub)->push("anna", "chest", "m", model));
  auto manifest = (*of_robot)->manifest("anna", "chest");
  for (int look = 0; look < 200 && !manifest; ++look) {  // until the servers have found each other
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    manifest = (*of_robot)->manifest("anna", "chest");
  }
  ASSERT_TRUE(manifest && *manifest);
  EXPECT_EQ(*(*of_robot)->fetch(**manifest), model);
  EXPECT_EQ((*of_robot)->push("anna", "chest", "m", model).error().message,
            "this is the server of robot 'anna'; models are pushed to the hub");
  EXPECT_FALSE((*of_other)->manifest("anna", "chest"));
  (*servers)->hub().kill();
  const auto away = (*of_robot)->manifest("anna", "chest");
  ASSERT_FALSE(away);
  EXPECT_EQ(away.error().kind, ErrorKind::failed);
}

}  // namespace
}  // namespace dermis::live::fleet
