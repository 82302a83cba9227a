// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <thread>

#include "dermis/live/fleet/hub.hpp"
#include "fleet_servers.hpp"
#include "live/fleet/broker.hpp"
#include "live/fleet/name_lease.hpp"
#include "support/places.hpp"

namespace dermis::live::fleet {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

std::map<std::string, std::string> files_in(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).string()] = support::read_bytes(entry.path().string());
  }
  return files;
}

class MakeFleet : public testing::Test {
 public:
  void SetUp() override { ASSERT_EQ(support::make_fleet(fleet, "anna bob", "hub.local"), 0) << said(); }
  [[nodiscard]] std::string said() const { return support::read_bytes(fleet + ".said"); }

  support::TemporaryFolder folder;
  const std::string fleet = folder.file("fleet");
};

TEST_F(MakeFleet, writes_files_for_their_owner_alone) {
  ASSERT_EQ(files_in(fleet).size(), 13U);
  for (const auto& entry : fs::recursive_directory_iterator(fleet)) {
    EXPECT_EQ(entry.status().permissions() & (fs::perms::group_all | fs::perms::others_all), fs::perms::none)
        << entry.path();
  }
}

TEST_F(MakeFleet, keeps_what_is_there_when_a_robot_comes) {
  auto before = files_in(fleet);
  ASSERT_EQ(support::make_fleet(fleet, "anna bob carl", "hub.local"), 0) << said();
  auto after = files_in(fleet);
  EXPECT_EQ(after.size(), before.size() + 3);
  const std::string hub = after["hub/nats.conf"];
  for (const char* robot : {"anna@robots", "bob@robots", "carl@robots"}) {
    EXPECT_NE(hub.find(robot), std::string::npos) << robot;
  }
  before.erase("hub/nats.conf");
  for (const auto& [name, text] : before) EXPECT_EQ(after[name], text) << name;
}

TEST_F(MakeFleet, makes_what_is_missing) {
  auto before = files_in(fleet);
  fs::remove(fleet + "/robots/bob/bob.pem");
  ASSERT_EQ(support::make_fleet(fleet, "anna bob", "hub.local"), 0) << said();
  auto after = files_in(fleet);
  EXPECT_NE(after["robots/bob/bob.pem"], before["robots/bob/bob.pem"]);
  after["robots/bob/bob.pem"] = before["robots/bob/bob.pem"];
  EXPECT_EQ(after, before);
}

TEST_F(MakeFleet, refuses_what_cannot_be) {
  EXPECT_EQ(support::make_fleet(fleet, ""), 2);
  EXPECT_EQ(said(), "make_fleet: give FOLDER HUB ROBOT...\n");
  EXPECT_EQ(support::make_fleet(fleet, "'a b'"), 2);
  EXPECT_EQ(said(), "make_fleet: robot 'a b' must be 1 to 64 letters, digits, '_' or '-', a letter or digit first\n");
  EXPECT_EQ(support::make_fleet(fleet, "hub"), 2);
  EXPECT_EQ(said(), "make_fleet: 'hub' is the name of the hub; a robot needs another\n");
  EXPECT_EQ(support::make_fleet(fleet, "a", "a,DNS:b"), 2);
  EXPECT_EQ(said(), "make_fleet: 'a,DNS:b' must be the name or the IPv4 address of a machine\n");
}

/// Two robots, a hub that has their frames, and a model for each.
class Accounts : public testing::Test {
 public:
  void SetUp() override {
    if (!support::NatsServer::is_installed()) GTEST_SKIP() << "skipped: nats-server is not installed";
    auto made = support::FleetServers::start({"anna", "bob"});
    if (!made) GTEST_SKIP() << "skipped: " << made.error().message;
    servers = *std::move(made);
    hub = connected(servers->operator_address());
    anna = connected(servers->robot_address("anna"));
    ASSERT_TRUE(hub->ask("$JS.API.STREAM.CREATE.dermis-models",
                         R"({"name":"dermis-models","subjects":["dermis-models.>"],"storage":"file",
                             "retention":"limits","allow_direct":true})"));
    for (const std::string robot : {"anna", "bob"}) {
      ASSERT_TRUE(hub->store("dermis-models." + robot + ".chest.hash", "", kBytes));
      publish(robot);
      add(robot);
    }
    ASSERT_TRUE(hub_has("anna", 1) && hub_has("bob", 1));
  }

  /// A message to the robot's own server.
  void publish(const std::string& robot) const {
    const auto own = connected(servers->robot_address(robot));
    ASSERT_TRUE(own->ask("$JS.API.STREAM.CREATE.dermis_" + robot,
                         R"({"name":"dermis_)" + robot + R"(","subjects":["dermis.)" + robot +
                             R"(.>"],"storage":"file","retention":"limits","allow_direct":true})"));
    ASSERT_TRUE(own->store("dermis." + robot + ".chest.frames", "", kBytes));
  }

  void add(const std::string& robot) const {
    const auto keeper = Hub::connect(servers->operator_address());
    ASSERT_TRUE(keeper && (*keeper)->add_robot(robot));
  }

  /// Waits for a line in the hub's log.
  [[nodiscard]] bool hub_says(const std::string& line) const {
    for (int look = 0; look < 400; ++look) {
      if (servers->hub().log().find(line) != std::string::npos) return true;
      std::this_thread::sleep_for(milliseconds(50));
    }
    return false;
  }

  [[nodiscard]] static std::unique_ptr<Broker> connected(const BrokerAddress& address) {
    auto broker = connect_broker(address);
    EXPECT_TRUE(broker) << broker.error().message;
    return broker ? *std::move(broker) : nullptr;
  }

  /// Waits until the hub's copy has so many messages, and no more.
  [[nodiscard]] bool hub_has(const std::string& robot, std::uint64_t messages) const {
    const std::string subject = "dermis." + robot + ".chest.frames";
    for (int look = 0; look < 400; ++look) {
      const auto last = hub->last("dermis_" + robot, subject);
      if (last && *last && (*last)->sequence == messages) return true;
      std::this_thread::sleep_for(milliseconds(50));
    }
    return false;
  }

  static constexpr std::array<std::uint8_t, 3> kBytes = {1, 2, 3};
  std::unique_ptr<support::FleetServers> servers;
  std::unique_ptr<Broker> hub;   ///< As the operator.
  std::unique_ptr<Broker> anna;  ///< As the robot, by its own server.
};

TEST_F(Accounts, a_robot_reads_its_own_models_alone) {
  const std::string get = "$JS.hub.API.DIRECT.GET.dermis-models.dermis-models.";
  const auto own = anna->ask(get + "anna.chest.hash", "");
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_EQ(*own, "\x01\x02\x03");
  EXPECT_FALSE(anna->ask(get + "bob.chest.hash", ""));
  EXPECT_FALSE(anna->ask("$JS.hub.API.DIRECT.GET.dermis-models", R"({"seq":2})"));
}

TEST_F(Accounts, a_robot_claims_its_own_name_alone) {
  ASSERT_TRUE(make_leases(*hub));
  EXPECT_TRUE(anna->store_after(0, "$JS.hub.API.$KV.dermis-names.anna", "anna"));
  EXPECT_TRUE(*anna->last("KV_dermis-names", "$KV.dermis-names.anna", "hub"));
  EXPECT_FALSE(anna->store_after(0, "$JS.hub.API.$KV.dermis-names.bob", "anna"));
  EXPECT_FALSE(anna->last("KV_dermis-names", "$KV.dermis-names.bob", "hub"));
}

TEST_F(Accounts, a_robot_reads_no_frames_of_another) {
  for (const std::string subject : {"$JS.hub.API.DIRECT.GET.dermis_bob", "$JS.bob.API.DIRECT.GET.dermis_bob",
                                    "$JS.hub.API.STREAM.MSG.GET.dermis_bob", "$JS.API.DIRECT.GET.dermis_bob",
                                    "$JS.API.STREAM.MSG.GET.dermis_bob"}) {
    const auto answer = anna->ask(subject, R"({"seq":1})");
    EXPECT_TRUE(!answer || answer->find("error") != std::string::npos) << subject;
  }
}

TEST_F(Accounts, a_robot_neither_publishes_as_another_nor_takes_away) {
  for (const std::string subject : {"dermis.bob.chest.frames", "dermis-mirror.bob.M.x", "dermis-models.anna.chest.hash",
                                    "dermis-models.bob.chest.hash"}) {
    ASSERT_TRUE(anna->send(subject, "forged"));
  }
  for (const std::string request :
       {"hub.API.STREAM.DELETE.dermis_bob", "hub.API.STREAM.PURGE.dermis_bob", "hub.API.STREAM.DELETE.dermis_anna",
        "hub.API.STREAM.PURGE.dermis_anna", "hub.API.STREAM.DELETE.dermis-models", "bob.API.STREAM.DELETE.dermis_bob",
        "bob.API.STREAM.PURGE.dermis_bob"}) {
    ASSERT_TRUE(anna->send("$JS." + request, ""));
  }
  // When this is answered, the hub has got all of them.
  ASSERT_TRUE(anna->ask("$JS.hub.API.DIRECT.GET.dermis-models.dermis-models.anna.chest.hash", ""));
  EXPECT_TRUE(hub_has("anna", 1));
  EXPECT_TRUE(hub_has("bob", 1));
  const auto bob = connected(servers->robot_address("bob"));
  EXPECT_EQ((*bob->last("dermis_bob", "dermis.bob.chest.frames"))->sequence, 1U);
  EXPECT_EQ((*hub->last("dermis-models", "dermis-models.anna.chest.hash"))->sequence, 1U);
}

TEST_F(Accounts, the_operator_takes_nothing_away_from_a_robot) {
  for (const std::string what : {"STREAM.DELETE.dermis_anna", "STREAM.PURGE.dermis_anna"}) {
    EXPECT_FALSE(hub->ask("$JS.anna.API." + what, ""));
  }
  EXPECT_EQ((*anna->last("dermis_anna", "dermis.anna.chest.frames"))->sequence, 1U);
}

TEST_F(Accounts, a_robot_comes_and_another_is_taken_out_while_the_hub_works) {
  ASSERT_TRUE(servers->write({"anna", "bob", "carl"}));
  servers->hub().reload();
  servers->start_robot("carl");
  publish("carl");
  add("carl");
  EXPECT_TRUE(hub_has("carl", 1));
  ASSERT_TRUE(servers->write({"bob", "carl"}));
  servers->hub().reload();
  servers->robot("anna").kill();
  servers->robot("anna").start();
  EXPECT_TRUE(hub_says("authentication error")) << servers->hub().log();
  publish("bob");
  EXPECT_TRUE(hub_has("bob", 2));
}

TEST_F(Accounts, the_key_of_a_robot_does_not_open_the_hub) {
  const auto direct = connect_broker(servers->hub_address("robots/anna/anna.pem"));
  ASSERT_FALSE(direct);
  EXPECT_EQ(direct.error().message,
            servers->hub().url() +
                ": the server does not know this user; give the password or key=FILE of one that it knows");
}

TEST_F(Accounts, nobody_enters_without_a_key) {
  for (const BrokerAddress& address :
       {servers->hub_address(""), BrokerAddress{servers->robot("anna").url(), servers->file("ca.pem")}}) {
    const auto refused = connect_broker(address);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, address.url + ": the server wants the certificate of a user; give key=FILE");
  }
}

TEST_F(Accounts, a_reader_reads_frames_alone) {
  const auto reader = connected(servers->hub_address("reader.pem"));
  EXPECT_TRUE(*reader->last("dermis_bob", "dermis.bob.chest.frames"));
  const auto deleted = reader->ask("$JS.API.STREAM.DELETE.dermis_bob", "");
  ASSERT_FALSE(deleted);
  EXPECT_EQ(deleted.error().message, servers->hub().url() + ": the user of this key may not do that");
  EXPECT_TRUE(hub_has("bob", 1));
}

TEST_F(Accounts, a_key_that_is_none_is_named) {
  const auto refused = connect_broker(servers->hub_address("hub/nats.conf"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            servers->file("hub/nats.conf") + ": cannot be read; it must hold the certificate and the key of a user");
}

/// Another fleet, whose robot goes to this hub.
class Strangers : public Accounts {
 public:
  void SetUp() override {
    Accounts::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    ASSERT_EQ(support::make_fleet(others, "anna"), 0);
    const std::string remote = support::read_bytes(servers->file("robots/anna/nats.conf"));
    support::write_bytes(others + "/robots/anna/nats.conf", remote);
  }
  support::TemporaryFolder folder;
  const std::string others = folder.file("others");
};

TEST_F(Strangers, a_hub_with_a_wrong_certificate_is_refused) {
  const auto refused = connect_broker({servers->hub().url(), others + "/ca.pem", servers->file("operator.pem")});
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      refused.error().message,
      servers->hub().url() + ": the server has no certificate of this name that is signed by " + others + "/ca.pem");
  const auto unknown = connect_broker({servers->hub().url(), "", servers->file("operator.pem")});
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("give ca=FILE"), std::string::npos) << unknown.error().message;
}

TEST_F(Strangers, a_robot_with_a_wrong_certificate_is_refused) {
  fs::copy_file(servers->file("ca.pem"), others + "/robots/anna/ca.pem", fs::copy_options::overwrite_existing);
  const support::NatsServer robot(others + "/robots/anna", support::free_port());
  EXPECT_TRUE(hub_says("TLS leafnode handshake error")) << servers->hub().log();
}

}  // namespace
}  // namespace dermis::live::fleet
