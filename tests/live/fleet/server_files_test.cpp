// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/server_files.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <thread>

#include "dermis/live/fleet/hub.hpp"
#include "dermis/live/fleet/job_queue.hpp"
#include "fleet_servers.hpp"
#include "live/fleet/broker.hpp"
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

class ServerFiles : public testing::Test {
 public:
  void SetUp() override {
    const auto written = write_server_files({.hub = "hub.local", .robots = {"anna", "bob"}}, folder.file("fleet"));
    if (!written) GTEST_SKIP() << "skipped: " << written.error().message;
  }
  [[nodiscard]] std::string error_of(const FleetPlan& plan, const std::string& name = "other") const {
    const auto written = write_server_files(plan, folder.file(name));
    return written ? "" : written.error().message;
  }

  support::TemporaryFolder folder;
};

TEST_F(ServerFiles, are_readable_by_their_owner_alone) {
  ASSERT_EQ(files_in(folder.file("fleet")).size(), 19U);
  for (const auto& entry : fs::recursive_directory_iterator(folder.file("fleet"))) {
    EXPECT_EQ(entry.status().permissions() & (fs::perms::group_all | fs::perms::others_all), fs::perms::none)
        << entry.path();
  }
}

TEST_F(ServerFiles, stay_as_they_are_when_a_robot_comes) {
  const auto before = files_in(folder.file("fleet"));
  const auto written = write_server_files({.robots = {"carl", "anna"}}, folder.file("fleet"));
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(written->size(), 2U + 5U);
  for (auto [name, text] : before) {
    if (name == "fleet.toml" || name == "hub/nats.conf") continue;
    EXPECT_EQ(files_in(folder.file("fleet"))[name], text) << name;
  }
  const std::string hub = support::read_bytes(folder.file("fleet/hub/nats.conf"));
  for (const char* robot : {"anna@robots", "bob@robots", "carl@robots"}) {
    EXPECT_NE(hub.find(robot), std::string::npos) << robot;
  }
  EXPECT_TRUE(write_server_files({}, folder.file("fleet"))->empty());
}

TEST_F(ServerFiles, are_made_where_one_is_missing) {
  fs::remove(folder.file("fleet/robots/bob/bob.pem"));
  EXPECT_EQ(*write_server_files({}, folder.file("fleet")),
            std::vector<std::string>{folder.file("fleet/robots/bob/bob.pem")});
}

TEST_F(ServerFiles, refuse_what_cannot_be) {
  EXPECT_EQ(error_of({}), "robot: a fleet needs the name of one");
  EXPECT_EQ(error_of({.robots = {"a b"}}), "robot: 'a b' must be 1 to 64 letters, digits, '_' or '-'");
  EXPECT_EQ(error_of({.robots = {"hub"}}), "robot: 'hub' is the name of the hub; a robot needs another");
  EXPECT_EQ(error_of({.hub = "a,DNS:b", .robots = {"a"}}),
            "hub: 'a,DNS:b' must be the name or the IPv4 address of a machine");
  EXPECT_EQ(error_of({.port = 5, .robots_port = 5, .robots = {"a"}}), "hub: its two ports must differ");
  EXPECT_EQ(error_of({.hub = "b"}, "fleet"), folder.file("fleet/fleet.toml") +
                                                 ": the hub and its ports stay as they are; another fleet needs "
                                                 "another folder");
}

// A seed and its user from https://docs.nats.io/using-nats/developer/connecting/creds
TEST_F(ServerFiles, name_the_user_of_a_seed) {
  const std::string seed = "SUAOY5JZ2WJKVR4UO2KJ2P3SW6FZFNWEOIMAXF4WZEUNVQXXUOKGM55CYE";
  support::write_bytes(folder.file("fleet/operator.seed"), seed);
  ASSERT_TRUE(write_server_files({}, folder.file("fleet")));
  EXPECT_NE(support::read_bytes(folder.file("fleet/hub/nats.conf"))
                .find("\"UDXB2VMLXPASAJ7ZDTKYNQ7QOCFWSGB4FOMYQQ25HQWSAF7ZQJEBSQSW\""),
            std::string::npos);
  support::write_bytes(folder.file("fleet/operator.seed"),
                       "SUAOY5JZ2WJKVR4UO2KJ2P3SW6FZFNWEOIMAXF4WZEUNVQXXUOKGM55CYF");
  EXPECT_EQ(error_of({}, "fleet"),
            folder.file("fleet/operator.seed") + ": holds a key with a mistake: its checksum is another");
  for (const std::string& wrong : {seed.substr(1), seed + "A", "S" + seed, std::string("x"), std::string()}) {
    support::write_bytes(folder.file("fleet/operator.seed"), wrong);
    EXPECT_NE(error_of({}, "fleet").find("holds no key of a user of NATS"), std::string::npos) << wrong;
  }
}

TEST_F(ServerFiles, are_those_of_deploy) {
  for (const char* name : {"fleet.toml", "hub/nats.conf", "robots/anna/nats.conf"}) {
    const std::string made =
        std::regex_replace(support::read_bytes(folder.file("fleet") + "/" + name), std::regex("U[A-Z2-7]{55}"), "U...");
    EXPECT_EQ(made, support::read_bytes(support::project_folder() / "deploy/nats" / name)) << name;
  }
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
                                    "dermis-jobs.job", "dermis-outcomes.done.1"}) {
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
  ASSERT_TRUE(write_server_files({.robots = {"carl"}}, servers->file("")));
  servers->hub().reload();
  servers->start_robot("carl");
  publish("carl");
  add("carl");
  EXPECT_TRUE(hub_has("carl", 1));
  const std::string plan = servers->file("fleet.toml");
  support::write_bytes(plan, std::regex_replace(support::read_bytes(plan), std::regex("  \"anna\",\n"), ""));
  ASSERT_EQ(*write_server_files({}, servers->file("")), std::vector<std::string>{servers->file("hub/nats.conf")});
  servers->hub().reload();
  servers->robot("anna").kill();
  servers->robot("anna").start();
  EXPECT_TRUE(hub_says("authentication error")) << servers->hub().log();
  publish("bob");
  EXPECT_TRUE(hub_has("bob", 2));
}

TEST_F(Accounts, the_key_of_a_robot_does_not_open_the_hub) {
  const auto direct = connect_broker(servers->hub_address("robots/anna/anna.seed"));
  ASSERT_FALSE(direct);
  EXPECT_EQ(direct.error().message,
            servers->hub().url() + ": the server does not know this user; give key=FILE of one that it knows");
}

TEST_F(Accounts, nobody_enters_without_a_key) {
  EXPECT_FALSE(connect_broker(servers->hub_address("")));
  const auto robot = connect_broker({servers->robot("anna").url()});
  ASSERT_FALSE(robot);
  EXPECT_EQ(robot.error().message,
            servers->robot("anna").url() + ": the server does not know this user; give key=FILE of one that it knows");
}

TEST_F(Accounts, every_connection_signs_what_the_server_asks) {
  for (int k = 0; k < 400; ++k) {  // one signature in 256 begins with 0
    const auto robot = connect_broker(servers->robot_address("anna"));
    ASSERT_TRUE(robot) << robot.error().message << ", connection " << k;
  }
}

TEST_F(Accounts, a_worker_does_jobs_and_reads_frames_alone) {
  const Job job{"a", {"convert", "a.mcap", "a.csv"}};
  auto operators = JobQueue::connect(servers->operator_address());
  ASSERT_TRUE(operators && (*operators)->submit(job));
  auto queue = JobQueue::connect(servers->hub_address("worker.seed"));
  ASSERT_TRUE(queue) << queue.error().message;
  const auto taken = (*queue)->take();
  ASSERT_TRUE(taken && *taken);
  EXPECT_TRUE((*queue)->finish(**taken, {"a", "w", 0.1, ""}));
  EXPECT_EQ((*queue)->counts()->done, 1U);
  EXPECT_FALSE((*queue)->submit(job));
  const auto worker = connected(servers->hub_address("worker.seed"));
  EXPECT_TRUE(*worker->last("dermis_bob", "dermis.bob.chest.frames"));
  const auto deleted = worker->ask("$JS.API.STREAM.DELETE.dermis_bob", "");
  ASSERT_FALSE(deleted);
  EXPECT_EQ(deleted.error().message, servers->hub().url() + ": the user of this key may not do that");
  EXPECT_TRUE(hub_has("bob", 1));
}

/// Another fleet has the same ports.
class Strangers : public Accounts {
 public:
  void SetUp() override {
    Accounts::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    ASSERT_TRUE(write_server_files(servers->plan(), others.file("")));
  }
  support::TemporaryFolder others;
};

TEST_F(Strangers, a_hub_with_a_wrong_certificate_is_refused) {
  const auto refused = connect_broker({servers->hub().url(), others.file("ca.pem"), servers->file("operator.seed")});
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      refused.error().message,
      servers->hub().url() + ": the server has no certificate of this name that is signed by " + others.file("ca.pem"));
  const auto unknown = connect_broker({servers->hub().url(), "", servers->file("operator.seed")});
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("give ca=FILE"), std::string::npos) << unknown.error().message;
}

TEST_F(Strangers, a_robot_with_a_wrong_certificate_is_refused) {
  fs::copy_file(servers->file("ca.pem"), others.file("robots/anna/ca.pem"), fs::copy_options::overwrite_existing);
  const support::NatsServer robot(others.file("robots/anna"), support::free_port());
  EXPECT_TRUE(hub_says("TLS leafnode handshake error")) << servers->hub().log();
}

}  // namespace
}  // namespace dermis::live::fleet
