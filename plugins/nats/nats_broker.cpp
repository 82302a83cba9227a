// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <nats/nats.h>
#include <openssl/sha.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "destroyer.hpp"
#include "live/fleet/broker.hpp"

/// The plugin that dermis::fleet loads.
namespace dermis::live::fleet {
namespace {

constexpr std::int64_t kConnectMs = 2000;
constexpr std::int64_t kReconnectMs = 200;
constexpr std::int64_t kAnswerMs = 2000;
constexpr int kForEver = -1;
constexpr const char* kIdHeader = "Nats-Msg-Id";

using Options = std::unique_ptr<natsOptions, Destroyer<natsOptions_Destroy>>;
using Connection = std::unique_ptr<natsConnection, Destroyer<natsConnection_Destroy>>;
using JetStream = std::unique_ptr<jsCtx, Destroyer<jsCtx_Destroy>>;
using Message = std::unique_ptr<natsMsg, Destroyer<natsMsg_Destroy>>;
using PublishAck = std::unique_ptr<jsPubAck, Destroyer<jsPubAck_Destroy>>;

Error error_of(const std::string& place, natsStatus status) {
  if (status == NATS_NO_SERVER)
    return failed(place + ": no server answers there; see that nats-server is on, and its port open");
  if (status == NATS_TIMEOUT)
    return failed(place + ": no answer came; see that nats-server works, and its disk has room");
  return failed(place + ": " + natsStatus_GetText(status));
}

StoredMessage stored_message(natsMsg* message) {
  StoredMessage stored;
  stored.sequence = natsMsg_GetSequence(message);
  stored.time = Nanos(natsMsg_GetTime(message));
  const char* id = nullptr;
  if (natsMsgHeader_Get(message, kIdHeader, &id) == NATS_OK) stored.id = id;
  const auto* const data = reinterpret_cast<const std::uint8_t*>(natsMsg_GetData(message));
  stored.bytes.assign(data, data + natsMsg_GetDataLength(message));
  return stored;
}

class NatsBroker final : public Broker {
 public:
  NatsBroker(std::string url, Connection connection, JetStream jet_stream)
      : url_(std::move(url)), connection_(std::move(connection)), jet_stream_(std::move(jet_stream)) {}

  [[nodiscard]] Result<std::string> ask(const std::string& subject, const std::string& request) override;
  void stop() override { natsConnection_Close(connection_.get()); }
  [[nodiscard]] Status send(const std::string& subject, const std::string& text) override;
  [[nodiscard]] Result<std::uint64_t> store(const std::string& subject, const std::string& id,
                                            std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] Result<std::optional<std::uint64_t>> store_after(std::uint64_t last, const std::string& subject,
                                                                 std::string_view text) override;
  [[nodiscard]] Result<std::optional<StoredMessage>> last(const std::string& stream, const std::string& subject,
                                                          const std::string& domain) override;
  [[nodiscard]] Result<std::optional<StoredMessage>> next(const std::string& stream, const std::string& subject,
                                                          std::uint64_t sequence) override;

 private:
  struct Published {
    natsStatus status = NATS_OK;
    jsErrCode code{};
    PublishAck acknowledged{};
  };

  [[nodiscard]] Result<std::optional<StoredMessage>> get(const std::string& stream, jsDirectGetMsgOptions& which,
                                                         const std::string& domain = "");
  [[nodiscard]] Error why_not(natsStatus status) const;
  [[nodiscard]] Published publish(const std::string& subject, std::string_view bytes, jsPubOptions& options);
  [[nodiscard]] Error why_not_stored(natsStatus status, jsErrCode code);

  const std::string url_;
  const Connection connection_;
  const JetStream jet_stream_;
};

/// A server says to the connection that a request is not permitted, and does not answer it.
Error NatsBroker::why_not(natsStatus status) const {
  const char* text = nullptr;
  const bool is_denied =
      status == NATS_TIMEOUT && natsConnection_GetLastError(connection_.get(), &text) == NATS_NOT_PERMITTED;
  return is_denied ? bad_input(url_ + ": the user of this key may not do that") : error_of(url_, status);
}

Result<std::string> NatsBroker::ask(const std::string& subject, const std::string& request) {
  natsMsg* got = nullptr;
  const natsStatus asked =
      natsConnection_RequestString(&got, connection_.get(), subject.c_str(), request.c_str(), kAnswerMs);
  const Message answer(got);
  if (asked != NATS_OK) return why_not(asked);
  return std::string(natsMsg_GetData(answer.get()), static_cast<std::size_t>(natsMsg_GetDataLength(answer.get())));
}

Status NatsBroker::send(const std::string& subject, const std::string& text) {
  const natsStatus sent = natsConnection_PublishString(connection_.get(), subject.c_str(), text.c_str());
  if (sent != NATS_OK) return error_of(url_, sent);
  return Done{};
}

NatsBroker::Published NatsBroker::publish(const std::string& subject, std::string_view bytes, jsPubOptions& options) {
  options.MaxWait = kAnswerMs;
  Published published;
  jsPubAck* answer = nullptr;
  published.status = js_Publish(&answer, jet_stream_.get(), subject.c_str(), bytes.data(),
                                static_cast<int>(bytes.size()), &options, &published.code);
  published.acknowledged.reset(answer);
  return published;
}

Result<std::uint64_t> NatsBroker::store(const std::string& subject, const std::string& id,
                                        std::span<const std::uint8_t> bytes) {
  jsPubOptions options;
  jsPubOptions_Init(&options);
  if (!id.empty()) options.MsgId = id.c_str();
  const auto [status, code, acknowledged] =
      publish(subject, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, options);
  if (status == NATS_MAX_PAYLOAD) return bad_input(url_ + ": " + subject + ": the server takes no message so large");
  if (status != NATS_OK) return why_not_stored(status, code);
  return acknowledged->Sequence;
}

Result<std::optional<std::uint64_t>> NatsBroker::store_after(std::uint64_t last, const std::string& subject,
                                                             std::string_view text) {
  jsPubOptions options;
  jsPubOptions_Init(&options);
  options.ExpectLastSubjectSeq = last;
  options.ExpectNoMessage = last == 0;
  const auto [status, code, acknowledged] = publish(subject, text, options);
  if (code == JSStreamWrongLastSequenceErr) return std::optional<std::uint64_t>();
  if (status != NATS_OK) return why_not_stored(status, code);
  return std::optional(acknowledged->Sequence);
}

/// A server whose disk, or whose share of it, is full, says no more than that; how much it holds is asked for.
Error NatsBroker::why_not_stored(natsStatus status, jsErrCode code) {
  if (code != JSInsufficientResourcesErr && code != JSStorageResourcesExceededErr) {
    return code == 0 ? error_of(url_, status) : failed(url_ + ": " + nats_GetLastError(nullptr));
  }
  jsAccountInfo* got = nullptr;
  const bool is_known = js_GetAccountInfo(&got, jet_stream_.get(), nullptr, nullptr) == NATS_OK;
  const std::unique_ptr<jsAccountInfo, Destroyer<jsAccountInfo_Destroy>> info(got);
  const std::string size =
      is_known ? " with " + std::to_string((info->Store + 500'000) / 1'000'000) + " MB of streams" : "";
  return failed(url_ + ": " + kDiskIsFull + size + "; clear it, or raise max_file_store");
}

Result<std::optional<StoredMessage>> NatsBroker::get(const std::string& stream, jsDirectGetMsgOptions& which,
                                                     const std::string& domain) {
  natsMsg* got = nullptr;
  jsOptions options;
  jsOptions_Init(&options);
  options.Wait = kAnswerMs;
  if (!domain.empty()) options.Domain = domain.c_str();
  const natsStatus asked = js_DirectGetMsg(&got, jet_stream_.get(), stream.c_str(), &options, &which);
  const Message message(got);
  if (asked == NATS_NOT_FOUND) return std::optional<StoredMessage>();
  if (asked != NATS_OK) return error_of(url_ + ": stream " + stream, asked);
  return std::optional(stored_message(message.get()));
}

Result<std::optional<StoredMessage>> NatsBroker::last(const std::string& stream, const std::string& subject,
                                                      const std::string& domain) {
  jsDirectGetMsgOptions which;
  jsDirectGetMsgOptions_Init(&which);
  which.LastBySubject = subject.c_str();
  return get(stream, which, domain);
}

Result<std::optional<StoredMessage>> NatsBroker::next(const std::string& stream, const std::string& subject,
                                                      std::uint64_t sequence) {
  jsDirectGetMsgOptions which;
  jsDirectGetMsgOptions_Init(&which);
  which.Sequence = sequence;
  which.NextBySubject = subject.c_str();
  return get(stream, which);
}

/// "hub" of "tls://hub:4222".
std::string host_of(const std::string& url) {
  const std::string rest = url.substr(url.find("://") + 3);
  const std::size_t end = rest.starts_with('[') ? rest.find(']') : rest.find_first_of(":/");
  return rest.starts_with('[') ? rest.substr(1, end - 1) : rest.substr(0, end);
}

bool is_encrypted(const BrokerAddress& address) {
  return address.url.starts_with("tls:") || !address.ca.empty() || !address.key.empty();
}

natsStatus set_password(natsOptions* options, const std::string& user, const std::string& password) {
  if (password.empty()) return NATS_OK;
  return user.empty() ? natsOptions_SetToken(options, password.c_str())
                      : natsOptions_SetUserInfo(options, user.c_str(), password.c_str());
}

natsStatus set_options(natsOptions* options, const BrokerAddress& address, const std::string& password) {
  const auto both = [](natsStatus first, natsStatus second) { return first != NATS_OK ? first : second; };
  natsStatus status = natsOptions_SetURL(options, address.url.c_str());
  status = both(status, natsOptions_SetTimeout(options, kConnectMs));
  status = both(status, natsOptions_SetMaxReconnect(options, kForEver));
  status = both(status, natsOptions_SetReconnectWait(options, kReconnectMs));
  status = both(status, natsOptions_SetFailRequestsOnDisconnect(options, true));
  status = both(status, natsOptions_SetName(options, "dermis"));
  status = both(status, set_password(options, address.user, password));
  if (!is_encrypted(address)) return status;
  status = both(status, natsOptions_SetSecure(options, true));
  return both(status, natsOptions_SetExpectedHostname(options, host_of(address.url).c_str()));
}

Result<Options> make_options(const BrokerAddress& address, const std::string& password) {
  natsOptions* made = nullptr;
  natsStatus status = natsOptions_Create(&made);
  Options options(made);
  if (status == NATS_OK) status = set_options(options.get(), address, password);
  if (status != NATS_OK) return error_of(address.url, status);
  if (!address.ca.empty() && natsOptions_LoadCATrustedCertificates(options.get(), address.ca.c_str()) != NATS_OK) {
    return bad_input(address.ca + ": cannot be read; it must hold the certificates that sign that of the server");
  }
  const char* const key = address.key.c_str();
  if (!address.key.empty() && natsOptions_LoadCertificatesChain(options.get(), key, key) != NATS_OK) {
    return bad_input(address.key + ": cannot be read; it must hold the certificate and the key of a user");
  }
  return options;
}

/// Why there is no connection, and the mend.
Error refusal(const BrokerAddress& address, natsStatus status) {
  const std::string& place = address.url;
  switch (status) {
    case NATS_CONNECTION_AUTH_FAILED:
      return bad_input(place +
                       ": the server does not know this user; give the password or key=FILE of one that it knows");
    case NATS_SSL_ERROR:
      return bad_input(place + ": the server has no certificate of this name that is signed by " +
                       (address.ca.empty() ? "those of the machine; give ca=FILE" : address.ca));
    case NATS_SECURE_CONNECTION_WANTED:
      return bad_input(place + ": the server does not encrypt; leave out ca=FILE and write nats://");
    case NATS_PROTOCOL_ERROR:  // the handshake was well for us, not for the server
      if (!is_encrypted(address) || !address.key.empty()) return error_of(place, status);
      return bad_input(place + ": the server wants the certificate of a user; give key=FILE");
    default: return error_of(place, status);
  }
}

Result<std::unique_ptr<Broker>> connect(const BrokerAddress& address, const std::string& password) {
  Result<Options> options = make_options(address, password);
  if (!options) return options.error();
  natsConnection* made_connection = nullptr;
  natsStatus status = natsConnection_Connect(&made_connection, options->get());
  Connection connection(made_connection);
  if (status != NATS_OK) return refusal(address, status);
  jsCtx* made_context = nullptr;
  status = natsConnection_JetStream(&made_context, connection.get(), nullptr);
  JetStream jet_stream(made_context);
  if (status != NATS_OK) return error_of(address.url, status);
  return std::unique_ptr<Broker>(
      std::make_unique<NatsBroker>(address.url, std::move(connection), std::move(jet_stream)));
}

}  // namespace
}  // namespace dermis::live::fleet

extern "C" __attribute__((visibility("default"))) void dermis_connect_broker(
    const dermis::live::fleet::BrokerAddress& address, const std::string& password,
    dermis::Result<std::unique_ptr<dermis::live::fleet::Broker>>& connected) {
  connected = dermis::live::fleet::connect(address, password);
}

extern "C" __attribute__((visibility("default"))) void dermis_sha256(std::string_view bytes, std::string& digits) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> hash{};
  SHA256(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), hash.data());
  digits.clear();
  for (const std::uint8_t byte : hash) {
    digits += kDigits[byte / 16U];
    digits += kDigits[byte % 16U];
  }
}
