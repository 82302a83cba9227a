// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/bytes/system/thread_priority.hpp"
#include "live/dds/participant.hpp"

/// The plugin that dermis::dds loads.
namespace dermis::live::dds {
namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

using Message = std::span<const std::uint8_t>;

constexpr std::size_t kMostBytesOfATopic = std::size_t{32} << 20U;
constexpr std::size_t kFewestMessages = 10;
constexpr std::size_t kMostMessages = 1000;
// Lost data are sent again after this.
constexpr std::uint32_t kHeartbeatNanos = 10'000'000;
constexpr std::uint32_t kProgramsOnThisMachine = 32;
constexpr std::uint32_t kReceiveBuffer = 4U << 20U;  // bytes; the system may grant less

/// "sensor_msgs/msg/Image" -> "sensor_msgs::msg::dds_::Image_".
std::string dds_type_name(const std::string& ros_name) {
  const std::size_t first = ros_name.find('/');
  const std::size_t last = ros_name.rfind('/');
  return ros_name.substr(0, first) + "::msg::dds_::" + ros_name.substr(last + 1) + "_";
}

/// Messages are in CDR already.
class EncodedType final : public fast::TopicDataType {
 public:
  explicit EncodedType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 256;  // To begin with.
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }

  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Message& message = *static_cast<const Message*>(data);
    if (payload->max_size < message.size()) return false;
    std::memcpy(payload->data, message.data(), message.size());
    payload->length = static_cast<std::uint32_t>(message.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<const Message*>(data)->size()); };
  }
  bool deserialize(rtps::SerializedPayload_t* /*payload*/, void* /*data*/) override { return false; }
  void* createData() override { return nullptr; }
  void deleteData(void* /*data*/) override {}
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*key*/, bool /*force_md5*/) override { return false; }
};

fast::DataWriterQos writer_qos(const Topic& topic) {
  fast::DataWriterQos qos;
  qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = topic.is_kept ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
  const std::size_t room = kMostBytesOfATopic / std::max<std::size_t>(topic.message_bytes, 1);
  const auto depth = static_cast<std::int32_t>(topic.is_kept ? 1 : std::clamp(room, kFewestMessages, kMostMessages));
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = depth;
  qos.resource_limits().max_samples = depth;
  qos.resource_limits().max_samples_per_instance = depth;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().allocated_samples = std::min(depth, 10);
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.reliable_writer_qos().times.heartbeatPeriod = {0, kHeartbeatNanos};
  const std::string hash = std::string("typehash=") + topic.type.hash + ";";
  qos.user_data().setValue({hash.begin(), hash.end()});
  return qos;
}

class FastWriter final : public Writer, private fast::DataWriterListener {
 public:
  [[nodiscard]] bool open(fast::DomainParticipant& participant, fast::Publisher& publisher, const Topic& topic) {
    const std::string type = dds_type_name(topic.type.name);
    if (participant.find_type(type).empty()) {
      fast::TypeSupport(new EncodedType(type)).register_type(&participant);
    }
    fast::Topic* const made = participant.create_topic("rt" + topic.name, type, fast::TOPIC_QOS_DEFAULT);
    if (made == nullptr) return false;
    writer_ = publisher.create_datawriter(made, writer_qos(topic), this, fast::StatusMask::publication_matched());
    return writer_ != nullptr;
  }
  ~FastWriter() override {
    if (writer_ != nullptr) writer_->set_listener(nullptr);  // The participant deletes it.
  }

  [[nodiscard]] bool has_readers() const noexcept override { return readers_ > 0; }
  void write(Message message) override { writer_->write(&message); }

 private:
  void on_publication_matched(fast::DataWriter* /*writer*/, const fast::PublicationMatchedStatus& status) override {
    readers_ = status.current_count;
  }

  fast::DataWriter* writer_ = nullptr;
  std::atomic<std::int32_t> readers_{0};
};

/// Messages stay in CDR.
class ReceivedType final : public fast::TopicDataType {
 public:
  explicit ReceivedType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 4096;  // To begin with.
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }

  bool serialize(void* /*data*/, rtps::SerializedPayload_t* /*payload*/) override { return false; }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* /*data*/) override {
    return [] { return 0U; };
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<Received*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  void* createData() override { return new Received; }
  void deleteData(void* data) override { delete static_cast<Received*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*key*/, bool /*force_md5*/) override { return false; }

  using Received = std::vector<std::uint8_t>;
};

fast::DataReaderQos reader_qos(fast::ReliabilityQosPolicyKind reliability) {
  fast::DataReaderQos qos;
  qos.reliability().kind = reliability;
  qos.durability().kind = fast::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = kMostMessages;
  qos.resource_limits().max_samples = kMostMessages;
  qos.resource_limits().max_samples_per_instance = kMostMessages;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().allocated_samples = 10;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return qos;
}

Sample sample_of(const ReceivedType::Received& bytes, const fast::SampleInfo& info) {
  Sample sample{bytes, info.sample_identity.sequence_number().to64long(), Nanos(info.source_timestamp.to_ns()), {}};
  const rtps::GUID_t& guid = info.sample_identity.writer_guid();
  auto* const entity =
      std::copy(std::begin(guid.guidPrefix.value), std::end(guid.guidPrefix.value), sample.writer.begin());
  std::copy(std::begin(guid.entityId.value), std::end(guid.entityId.value), entity);
  return sample;
}

/// A thread of Fast DDS that is late leaves messages in its socket until there is no more room.
void raise_own_priority() {
  thread_local bool is_raised = false;
  if (!std::exchange(is_raised, true)) raise_thread_priority();
}

/// Asks for all messages. A second reader serves writers that send nothing again. It hears the others, too, so both
/// leave out repeated messages.
class FastReader final : public Reader, private fast::DataReaderListener {
 public:
  FastReader(fast::Subscriber& subscriber, Subscription subscription)
      : subscriber_(subscriber), subscription_(std::move(subscription)) {}

  [[nodiscard]] bool open(fast::DomainParticipant& participant) {
    const std::string& type = subscription_.type;
    if (participant.find_type(type).empty()) fast::TypeSupport(new ReceivedType(type)).register_type(&participant);
    auto* const known = participant.lookup_topicdescription(subscription_.topic);
    topic_ = known != nullptr ? dynamic_cast<fast::Topic*>(known)
                              : participant.create_topic(subscription_.topic, type, fast::TOPIC_QOS_DEFAULT);
    if (topic_ == nullptr || topic_->get_type_name() != type) return false;
    reliable_ = add(fast::RELIABLE_RELIABILITY_QOS);
    return reliable_ != nullptr;
  }

  ~FastReader() override {
    for (fast::DataReader* const reader : {reliable_, best_effort_.load()}) {
      if (reader != nullptr) reader->set_listener(nullptr);
    }
    if (adding_.joinable()) adding_.join();
    for (fast::DataReader* const reader : {reliable_, best_effort_.load()}) {
      if (reader == nullptr) continue;
      reader->set_listener(nullptr);
      subscriber_.delete_datareader(reader);
    }
  }

 private:
  fast::DataReader* add(fast::ReliabilityQosPolicyKind reliability) {
    fast::StatusMask mask = fast::StatusMask::data_available();
    mask << fast::StatusMask::requested_incompatible_qos();
    return subscriber_.create_datareader(topic_, reader_qos(reliability), this, mask);
  }

  /// A listener must not make a reader.
  void on_requested_incompatible_qos(fast::DataReader* /*reader*/,
                                     const fast::RequestedIncompatibleQosStatus& status) override {
    if (status.last_policy_id != fast::RELIABILITY_QOS_POLICY_ID || adding_.joinable()) return;
    adding_ = std::thread([this] { best_effort_ = add(fast::BEST_EFFORT_RELIABILITY_QOS); });
  }

  void on_data_available(fast::DataReader* reader) override {
    raise_own_priority();
    const std::lock_guard lock(mutex_);
    fast::SampleInfo info;
    while (reader->take_next_sample(&received_, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const Sample sample = sample_of(received_, info);
      std::uint64_t& last = last_[sample.writer];
      if (sample.sequence <= last) continue;
      last = sample.sequence;
      subscription_.heard(sample);
    }
  }

  fast::Subscriber& subscriber_;
  const Subscription subscription_;
  fast::Topic* topic_ = nullptr;
  fast::DataReader* reliable_ = nullptr;
  std::atomic<fast::DataReader*> best_effort_{nullptr};
  std::thread adding_;
  std::mutex mutex_;  // Of what follows.
  ReceivedType::Received received_;
  std::map<Sample::Writer, std::uint64_t> last_;
};

/// UDP is the only transport: other versions of Fast DDS would not understand our shared memory.
fast::DomainParticipantQos participant_qos(bool loopback_only) {
  fast::DomainParticipantQos qos;
  qos.name("dermis");
  qos.transport().use_builtin_transports = false;
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->receiveBufferSize = kReceiveBuffer;
  if (loopback_only) {
    udp->interfaceWhiteList.emplace_back("127.0.0.1");
    udp->maxInitialPeersRange = kProgramsOnThisMachine;
    rtps::Locator_t loopback;
    rtps::IPLocator::setIPv4(loopback, 127, 0, 0, 1);
    qos.wire_protocol().builtin.initialPeersList.push_back(loopback);
  }
  qos.transport().user_transports.push_back(udp);
  return qos;
}

class FastParticipant final : public Participant {
 public:
  ~FastParticipant() override {
    if (participant_ == nullptr) return;
    participant_->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  [[nodiscard]] Status open(const PublisherOptions& options) {
    fast::Log::ClearConsumers();  // The library never prints.
    participant_ = fast::DomainParticipantFactory::get_instance()->create_participant(
        options.domain, participant_qos(options.loopback_only));
    if (participant_ != nullptr) publisher_ = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
    if (participant_ != nullptr) subscriber_ = participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
    if (publisher_ != nullptr && subscriber_ != nullptr) return Done{};
    return failed("DDS: there is no place in domain " + std::to_string(options.domain) +
                  ": no network with IPv4, or too many programs; try another domain");
  }

  [[nodiscard]] Result<std::unique_ptr<Writer>> add_writer(const Topic& topic) override {
    auto writer = std::make_unique<FastWriter>();
    if (!writer->open(*participant_, *publisher_, topic)) return failed("DDS: cannot publish '" + topic.name + "'");
    return std::unique_ptr<Writer>(std::move(writer));
  }

  [[nodiscard]] Result<std::unique_ptr<Reader>> add_reader(const Subscription& subscription) override {
    auto reader = std::make_unique<FastReader>(*subscriber_, subscription);
    if (!reader->open(*participant_)) return failed("DDS: cannot subscribe to '" + subscription.topic + "'");
    return std::unique_ptr<Reader>(std::move(reader));
  }

 private:
  fast::DomainParticipant* participant_ = nullptr;
  fast::Publisher* publisher_ = nullptr;
  fast::Subscriber* subscriber_ = nullptr;
};

}  // namespace
}  // namespace dermis::live::dds

/// dermis::live::dds::OpenParticipant.
extern "C" __attribute__((visibility("default"))) void dermis_open_participant(
    const dermis::live::dds::PublisherOptions& options,
    dermis::Result<std::unique_ptr<dermis::live::dds::Participant>>& opened) {
  auto participant = std::make_unique<dermis::live::dds::FastParticipant>();
  if (dermis::Status open = participant->open(options); !open) {
    opened = open.error();
  } else {
    opened = std::unique_ptr<dermis::live::dds::Participant>(std::move(participant));
  }
}
