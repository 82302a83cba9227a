// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/websocket/server.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>  // Asio 1.74 forgets it

#include "support/temporary_folder.hpp"

namespace dermis::out::websocket {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;
using nlohmann::json;

constexpr std::string_view kPage = "<html>viewer</html>";

/// Lines that the server says, from its thread.
class Log {
 public:
  void add(const std::string& line) {
    const std::lock_guard lock(mutex_);
    lines_.push_back(line);
  }
  [[nodiscard]] std::vector<std::string> lines() const {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
};

/// Waits until `done` holds, for 20 seconds at most.
template <typename Done>
bool eventually(Done done) {
  for (int i = 0; i < 2000; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

struct StreamServer : testing::Test {
  Log log;
  std::mutex mutex;
  ParameterValue value{1.0};
  ServerOptions options;
  std::unique_ptr<Server> server;
  asio::io_context context;

  void SetUp() override {
    options.port = 0;
    options.notice = [this](const std::string& line) { log.add(line); };
  }

  void serve() {
    const std::vector<Asset> assets{
        {"/index.html", "text/html", false, {reinterpret_cast<const std::uint8_t*>(kPage.data()), kPage.size()}},
        {"/assets/x-12345678.js", "text/javascript", true, {reinterpret_cast<const std::uint8_t*>("zip"), 3}}};
    Handlers handlers{[this] {
                        const std::lock_guard lock(mutex);
                        return std::vector<Parameter>{{"/threshold", value}};
                      },
                      [this](const Parameter& set, const std::string& /*client*/) -> Status {
                        const std::lock_guard lock(mutex);
                        value = set.value;
                        return Done{};
                      }};
    Result<std::unique_ptr<Server>> created = Server::create(options, assets);
    ASSERT_TRUE(created) << created.error().message;
    server = std::move(*created);
    server->start(std::move(handlers));
  }

  tcp::socket connect() {
    tcp::socket socket(context);
    socket.connect({asio::ip::make_address("127.0.0.1"), server->port()});
    return socket;
  }

  struct Headers {
    std::string host = "127.0.0.1";
    std::string origin{};
    std::string authorization{};
  };

  http::response<http::string_body> get(const std::string& target, const Headers& headers = {"127.0.0.1", {}, {}},
                                        http::verb method = http::verb::get) {
    tcp::socket socket = connect();
    http::request<http::empty_body> request(method, target, 11);
    request.set(http::field::host, headers.host);
    if (!headers.authorization.empty()) request.set(http::field::authorization, headers.authorization);
    http::write(socket, request);
    http::response_parser<http::string_body> parser;
    parser.skip(method == http::verb::head);
    beast::flat_buffer buffer;
    http::read(socket, buffer, parser);
    return parser.release();
  }

  using Socket = websocket::stream<tcp::socket>;

  /// The status of the answer to a handshake, 101 where it was taken.
  unsigned upgrade_status(const std::string& target, const Headers& headers,
                          const std::string& subprotocols = "foxglove.sdk.v1") {
    tcp::socket socket = connect();
    http::request<http::empty_body> request(http::verb::get, target, 11);
    request.set(http::field::host, headers.host);
    request.set(http::field::upgrade, "websocket");
    request.set(http::field::connection, "Upgrade");
    request.set(http::field::sec_websocket_version, "13");
    request.set(http::field::sec_websocket_key, "dGhlIHNhbXBsZSBub25jZQ==");
    request.set(http::field::sec_websocket_protocol, subprotocols);
    if (!headers.origin.empty()) request.set(http::field::origin, headers.origin);
    http::write(socket, request);
    http::response_parser<http::string_body> parser;
    beast::flat_buffer buffer;
    http::read_header(socket, buffer, parser);
    return parser.get().result_int();
  }

  unsigned shake_hands(Socket& socket, const std::string& target = "/", const Headers& headers = {"127.0.0.1", {}, {}},
                       const std::string& subprotocols = "foxglove.websocket.v1, foxglove.sdk.v1") {
    socket.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      request.set(http::field::sec_websocket_protocol, subprotocols);
      if (!headers.origin.empty()) request.set(http::field::origin, headers.origin);
      if (!headers.authorization.empty()) request.set(http::field::authorization, headers.authorization);
    }));
    websocket::response_type response;
    error_code error;
    socket.handshake(response, headers.host, target, error);
    chosen = std::string(response[http::field::sec_websocket_protocol]);
    return response.result_int();
  }
  std::string chosen;

  static std::string read(Socket& socket) {
    beast::flat_buffer buffer;
    socket.read(buffer);
    return beast::buffers_to_string(buffer.data());
  }
  static json read_json(Socket& socket) { return json::parse(read(socket)); }
  static void say(Socket& socket, const std::string& text) {
    socket.text(true);
    socket.write(asio::buffer(text));
  }

  void subscribe(Socket& socket, ChannelId channel, std::uint32_t id = 9) const {
    say(socket, R"({"op":"subscribe","subscriptions":[{"id":)" + std::to_string(id) + R"(,"channelId":)" +
                    std::to_string(channel) + "}]}");
    ASSERT_TRUE(eventually([&] { return server->has_subscribers(channel); }));
  }
};

TEST_F(StreamServer, gives_a_file_to_be_saved_as_it_is_on_the_disk) {
  const support::TemporaryFolder folder;
  const std::string content(700'000, 'm');
  support::write_bytes(folder.file("walk.mcap"), content);
  serve();
  EXPECT_EQ(get("/recordings/walk.mcap").result_int(), 404U) << "nobody said so yet";
  server->set_file("/recordings/walk.mcap", folder.file("walk.mcap"));
  const auto answer = get("/recordings/walk.mcap");
  EXPECT_EQ(answer.result_int(), 200U);
  EXPECT_EQ(answer.body(), content);
  EXPECT_EQ(answer[http::field::content_disposition], "attachment; filename=\"walk.mcap\"");
  EXPECT_EQ(get("/recordings/walk.mcap", {"evil.example", {}, {}}).result_int(), 403U);
  EXPECT_EQ(get("/recordings/../walk.mcap").result_int(), 404U);
  std::filesystem::remove(folder.file("walk.mcap"));
  EXPECT_EQ(get("/recordings/walk.mcap").result_int(), 404U);
}

TEST_F(StreamServer, gives_a_file_to_nobody_without_the_token) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("walk.mcap"), "frames");
  options.token = "a-long-token";
  serve();
  server->set_file("/walk.mcap", folder.file("walk.mcap"));
  EXPECT_EQ(get("/walk.mcap").result_int(), 401U);
  EXPECT_EQ(get("/walk.mcap?token=a-wrong-token").result_int(), 401U);
  EXPECT_EQ(get("/walk.mcap?token=a-long-token").body(), "frames");
}

TEST_F(StreamServer, gives_its_files_and_documents) {
  serve();
  server->set_document("/suit.json", "application/json", "{}");
  for (const char* target : {"/", "/index.html", "/?token=whatever"}) {
    const auto response = get(target);
    EXPECT_EQ(response.result_int(), 200U) << target;
    EXPECT_EQ(response.body(), kPage);
  }
  EXPECT_EQ(get("/suit.json").body(), "{}");
  const auto script = get("/assets/x-12345678.js");
  EXPECT_EQ(script[http::field::content_encoding], "gzip");
  EXPECT_NE(std::string(script[http::field::cache_control]).find("immutable"), std::string::npos);
  EXPECT_EQ(get("/nowhere").result_int(), 404U);
  EXPECT_EQ(get("/../../etc/passwd").result_int(), 404U);
  EXPECT_EQ(get("/", {"127.0.0.1", {}, {}}, http::verb::head).result_int(), 200U);
  EXPECT_EQ(get("/", {"127.0.0.1", {}, {}}, http::verb::delete_).result_int(), 405U);
}

TEST_F(StreamServer, streams_to_each_subscriber_under_its_own_id) {
  serve();
  const ChannelId channel = server->add_channel("/chest/raw", "sensor_msgs/msg/Image", "uint8 x");
  Socket one(context);
  Socket two(context);
  one.next_layer() = connect();
  two.next_layer() = connect();
  EXPECT_EQ(shake_hands(one), 101U);
  EXPECT_EQ(chosen, "foxglove.sdk.v1");
  EXPECT_EQ(shake_hands(two, "/", {"127.0.0.1", {}, {}}, "foxglove.websocket.v1"), 101U);
  EXPECT_EQ(chosen, "foxglove.websocket.v1");
  for (Socket* socket : {&one, &two}) {
    EXPECT_EQ(read_json(*socket)["op"], "serverInfo");
    EXPECT_EQ(read_json(*socket)["channels"][0]["topic"], "/chest/raw");
  }
  EXPECT_FALSE(server->has_subscribers(channel));
  say(one, R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":0}]})");
  say(two, R"({"op":"subscribe","subscriptions":[{"id":200,"channelId":0}]})");
  const std::vector<std::uint8_t> message{1, 2, 3};
  ASSERT_TRUE(eventually([&] { return server->has_subscribers(channel); }));
  std::thread publisher([&] {
    EXPECT_TRUE(eventually([&] {
      server->publish(channel, Nanos(7), message);
      return server->statistics().messages > 20;
    }));
  });
  EXPECT_EQ(read(one), std::string("\x01\x01\0\0\0\x07\0\0\0\0\0\0\0\x01\x02\x03", 16));
  EXPECT_EQ(read(two), std::string("\x01\xc8\0\0\0\x07\0\0\0\0\0\0\0\x01\x02\x03", 16));
  publisher.join();
  EXPECT_EQ(server->statistics().clients, 2U);
  const ChannelId later = server->add_channel("/later", "t", "s");
  EXPECT_EQ(later, 1U);
}

TEST_F(StreamServer, tells_all_clients_of_a_changed_parameter) {
  serve();
  Socket one(context);
  Socket two(context);
  for (Socket* socket : {&one, &two}) {
    socket->next_layer() = connect();
    ASSERT_EQ(shake_hands(*socket), 101U);
    EXPECT_EQ(read_json(*socket)["op"], "serverInfo");
  }
  say(two, R"({"op":"subscribeParameterUpdates","parameterNames":["/threshold"]})");
  EXPECT_EQ(read_json(two)["parameters"][0]["value"], 1.0);
  say(one, R"({"op":"setParameters","parameters":[{"name":"/threshold","value":5}],"id":"1"})");
  EXPECT_EQ(read_json(one)["parameters"][0]["value"], 5.0);
  server->parameters_changed();
  EXPECT_EQ(read_json(two)["parameters"][0]["value"], 5.0);
}

TEST_F(StreamServer, asks_for_the_token) {
  options.token = "secret-1";
  serve();
  server->set_document("/suit.json", "application/json", "{}");
  EXPECT_EQ(get("/").result_int(), 200U) << "the viewer holds no data";
  EXPECT_EQ(get("/suit.json").result_int(), 401U);
  EXPECT_EQ(get("/suit.json?token=secret-2").result_int(), 401U);
  EXPECT_EQ(get("/suit.json?token=secret-1").result_int(), 200U);
  EXPECT_EQ(get("/suit.json", {"127.0.0.1", {}, "Bearer secret-1"}).result_int(), 200U);
  const auto status = [this](const std::string& target, const std::string& origin) {
    return upgrade_status(target, {"127.0.0.1", origin, {}});
  };
  EXPECT_EQ(status("/", ""), 401U);
  EXPECT_EQ(status("/?token=no", ""), 401U);
  EXPECT_EQ(status("/", "https://app.foxglove.dev"), 401U);
  EXPECT_EQ(status("/?token=secret-1", ""), 101U);
  EXPECT_EQ(status("/?token=secret-1", "https://app.foxglove.dev"), 101U) << "who has the token may come from anywhere";
}

TEST_F(StreamServer, refuses_foreign_pages_names_and_protocols) {
  serve();
  const auto status = [this](const Headers& headers, const std::string& subprotocols) {
    return upgrade_status("/", headers, subprotocols);
  };
  const std::string good = "foxglove.sdk.v1";
  EXPECT_EQ(status({"127.0.0.1:1", "http://127.0.0.1:1", {}}, good), 101U);
  EXPECT_EQ(status({"127.0.0.1:1", "https://app.foxglove.dev", {}}, good), 101U);
  EXPECT_EQ(status({"127.0.0.1:1", "https://lichtblick-suite.github.io", {}}, good), 101U);
  EXPECT_EQ(status({"127.0.0.1:1", "http://evil.org", {}}, good), 403U);
  EXPECT_EQ(status({"127.0.0.1:1", "null", {}}, good), 403U);
  EXPECT_EQ(status({"evil.org", "http://evil.org", {}}, good), 403U) << "DNS rebinding";
  EXPECT_EQ(status({"127.0.0.1:1", {}, {}}, "chat"), 400U);
  EXPECT_EQ(get("/", {"evil.org", {}, {}}).result_int(), 403U);
  EXPECT_EQ(server->statistics().refused, 4U);
  EXPECT_EQ(log.lines().size(), 1U) << "one line, not one each";
}

TEST_F(StreamServer, cuts_off_who_does_not_speak_the_protocol) {
  serve();
  const auto is_cut = [this](auto misbehave) {
    Socket socket(context);
    socket.next_layer() = connect();
    EXPECT_EQ(shake_hands(socket), 101U);
    EXPECT_EQ(read_json(socket)["op"], "serverInfo");
    error_code error;
    misbehave(socket, error);
    beast::flat_buffer buffer;
    error = {};
    socket.read(buffer, error);
    return static_cast<bool>(error);
  };
  EXPECT_TRUE(is_cut([](Socket& socket, error_code& error) { socket.write(asio::buffer("garbage", 7), error); }));
  EXPECT_TRUE(is_cut([](Socket& socket, error_code& error) {
    const std::string garbage(100, '\xff');
    asio::write(socket.next_layer(), asio::buffer(garbage), error);
  }));
  EXPECT_TRUE(is_cut([](Socket& socket, error_code& error) {
    const std::string large((1U << 20U) + 100U, ' ');
    socket.write(asio::buffer(large), error);
  }));
  tcp::socket raw = connect();
  error_code error;
  asio::write(raw, asio::buffer("\x16\x03\x01 no HTTP at all\r\n\r\n", 23), error);
  std::array<char, 100> answer{};
  raw.read_some(asio::buffer(answer), error);
  EXPECT_TRUE(error);
  EXPECT_TRUE(eventually([&] { return server->statistics().clients == 0; }));
  ASSERT_EQ(log.lines().size(), 1U) << "one line, not one each";
  EXPECT_NE(log.lines()[0].find("does not speak the protocol"), std::string::npos);
}

TEST_F(StreamServer, a_client_that_reads_nothing_costs_the_others_nothing) {
  options.client_queue_bytes = 1U << 20U;
  serve();
  const ChannelId channel = server->add_channel("/big", "t", "s");
  Socket deaf(context);
  deaf.next_layer() = connect();
  ASSERT_EQ(shake_hands(deaf), 101U);
  subscribe(deaf, channel);
  Socket reader(context);
  reader.next_layer() = connect();
  ASSERT_EQ(shake_hands(reader), 101U);
  EXPECT_EQ(read_json(reader)["op"], "serverInfo");
  EXPECT_EQ(read_json(reader)["op"], "advertise");
  subscribe(reader, channel);
  say(reader, R"({"op":"getParameters","parameterNames":[],"id":"ready"})");
  EXPECT_EQ(read_json(reader)["id"], "ready");
  std::vector<std::uint8_t> message(200'000);
  for (std::uint8_t i = 0; i < 200; ++i) {
    message[0] = i;
    server->publish(channel, Nanos(i), message);
    EXPECT_EQ(static_cast<std::uint8_t>(read(reader)[13]), i);  // all of them, in order
  }
  EXPECT_GT(server->statistics().dropped, 100U);
  EXPECT_EQ(server->statistics().clients, 2U);
}

TEST_F(StreamServer, who_says_nothing_makes_room) {
  serve();
  std::vector<tcp::socket> silent;
  for (int i = 0; i < 200; ++i) silent.push_back(connect());
  EXPECT_EQ(get("/").result_int(), 200U);
  Socket socket(context);
  socket.next_layer() = connect();
  EXPECT_EQ(shake_hands(socket), 101U);
  EXPECT_EQ(read_json(socket)["op"], "serverInfo");
  std::array<char, 1> answer{};
  error_code error;
  silent.front().read_some(asio::buffer(answer), error);
  EXPECT_EQ(error, asio::error::eof) << "the oldest is closed";
  EXPECT_GE(server->statistics().refused, 130U);
  EXPECT_EQ(log.lines().size(), 1U);
}

TEST_F(StreamServer, takes_as_many_clients_as_it_may) {
  options.most_clients = 2;
  serve();
  Socket one(context);
  Socket two(context);
  for (Socket* socket : {&one, &two}) {
    socket->next_layer() = connect();
    ASSERT_EQ(shake_hands(*socket), 101U);
  }
  EXPECT_EQ(upgrade_status("/", {"127.0.0.1", {}, {}}), 503U);
  EXPECT_EQ(get("/").result_int(), 200U) << "the page is no client of the stream";
  one.next_layer().close();
  EXPECT_TRUE(eventually([&] { return upgrade_status("/", {"127.0.0.1", {}, {}}) == 101U; }));
}

TEST_F(StreamServer, who_comes_back_without_end_gets_a_place_each_time_and_takes_nobody_elses) {
  serve();
  const ChannelId channel = server->add_channel("/x", "t", "s");
  for (int i = 0; i < 50; ++i) EXPECT_EQ(upgrade_status("/", {"127.0.0.1", {}, {}}), 101U);
  for (int i = 0; i < 150; ++i) EXPECT_EQ(upgrade_status("/", {"evil.org", {}, {}}), 403U);
  Socket socket(context);
  socket.next_layer() = connect();
  ASSERT_EQ(shake_hands(socket), 101U);
  subscribe(socket, channel);
  server->publish(channel, Nanos(1), std::array<std::uint8_t, 1>{7});
  EXPECT_EQ(read_json(socket)["op"], "serverInfo");
  EXPECT_EQ(read_json(socket)["op"], "advertise");
  EXPECT_EQ(static_cast<std::uint8_t>(read(socket)[13]), 7);
}

TEST_F(StreamServer, answers_all_that_is_asked_at_length_though_later) {
  serve();
  Socket socket(context);
  socket.next_layer() = connect();
  ASSERT_EQ(shake_hands(socket), 101U);
  EXPECT_EQ(read_json(socket)["op"], "serverInfo");
  const std::string padding(600'000, 'x');  // more than the budget of a second
  for (int i = 0; i < 3; ++i) {
    say(socket, R"({"op":"getParameters","parameterNames":[],"id":")" + std::to_string(i) + R"(","more":")" + padding +
                    R"("})");
  }
  for (int i = 0; i < 3; ++i) EXPECT_EQ(read_json(socket)["id"], std::to_string(i));
  EXPECT_TRUE(log.lines().empty());
}

TEST_F(StreamServer, an_owner_that_takes_long_does_not_hold_up_the_stream) {
  serve();
  const ChannelId channel = server->add_channel("/x", "t", "s");
  Socket asker(context);
  Socket reader(context);
  for (Socket* socket : {&asker, &reader}) {
    socket->next_layer() = connect();
    ASSERT_EQ(shake_hands(*socket), 101U);
    EXPECT_EQ(read_json(*socket)["op"], "serverInfo");
    EXPECT_EQ(read_json(*socket)["op"], "advertise");
  }
  subscribe(reader, channel);
  {
    const std::lock_guard held(mutex);  // the handlers wait for it
    say(asker, R"({"op":"setParameters","parameters":[{"name":"/threshold","value":5}],"id":"1"})");
    for (std::uint8_t i = 0; i < 100; ++i) {
      server->publish(channel, Nanos(i), std::array{i});
      EXPECT_EQ(static_cast<std::uint8_t>(read(reader)[13]), i);
    }
  }
  EXPECT_EQ(read_json(asker)["parameters"][0]["value"], 5.0);
}

TEST_F(StreamServer, who_reads_late_gets_every_answer) {
  options.client_queue_bytes = 1U << 16U;
  value = std::string(20'000, 'x');
  serve();
  Socket socket(context);
  socket.next_layer().open(tcp::v4());
  socket.next_layer().set_option(asio::socket_base::receive_buffer_size(4096));
  socket.next_layer().connect({asio::ip::make_address("127.0.0.1"), server->port()});
  ASSERT_EQ(shake_hands(socket), 101U);
  constexpr int kQuestions = 150;  // 3 MB of answers, more than all the buffers hold
  for (int i = 0; i < kQuestions; ++i) {
    say(socket, R"({"op":"getParameters","parameterNames":[],"id":")" + std::to_string(i) + R"("})");
  }
  EXPECT_EQ(read_json(socket)["op"], "serverInfo");
  for (int i = 0; i < kQuestions; ++i) EXPECT_EQ(read_json(socket)["id"], std::to_string(i));
  EXPECT_TRUE(log.lines().empty()) << "it waited for the client to read, and did not cut it off";
}

TEST_F(StreamServer, tells_once_of_what_changes_often) {
  serve();
  Socket socket(context);
  socket.next_layer() = connect();
  ASSERT_EQ(shake_hands(socket), 101U);
  EXPECT_EQ(read_json(socket)["op"], "serverInfo");
  say(socket, R"({"op":"subscribeParameterUpdates","parameterNames":[]})");
  EXPECT_EQ(read_json(socket)["op"], "parameterValues");
  {
    const std::lock_guard held(mutex);
    for (int i = 0; i < 10'000; ++i) server->parameters_changed();
  }
  EXPECT_EQ(read_json(socket)["op"], "parameterValues");
  say(socket, R"({"op":"getParameters","parameterNames":[],"id":"end"})");
  int told = 1;
  while (!read_json(socket).contains("id")) ++told;
  EXPECT_LE(told, 2) << "one may have begun before the last change";
}

TEST_F(StreamServer, ends_with_clients_connected) {
  serve();
  Socket socket(context);
  socket.next_layer() = connect();
  ASSERT_EQ(shake_hands(socket), 101U);
  EXPECT_EQ(read_json(socket)["op"], "serverInfo");
  server->stop();
  server->parameters_changed();  // nobody hears it
  server.reset();
  beast::flat_buffer buffer;
  error_code error;
  socket.read(buffer, error);
  EXPECT_TRUE(error);
}

TEST_F(StreamServer, tells_what_to_do_about_a_port_in_use) {
  serve();
  ServerOptions second;
  second.port = server->port();
  const auto created = Server::create(second, {});
  ASSERT_FALSE(created);
  EXPECT_NE(created.error().message.find("is in use; choose another"), std::string::npos);
}

TEST(StreamServerOptions, others_need_a_token) {
  ServerOptions options;
  EXPECT_TRUE(options.validate());
  options.host = "0.0.0.0";
  EXPECT_FALSE(options.validate());
  options.token = "with space";
  EXPECT_FALSE(options.validate());
  options.token = "short";
  EXPECT_FALSE(options.validate());
  options.token = "long-enough";
  EXPECT_TRUE(options.validate());
  options.host = "robot";
  EXPECT_FALSE(options.validate());
}

}  // namespace
}  // namespace dermis::out::websocket
