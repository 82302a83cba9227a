// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/buses/bus_address.hpp"

#include <gtest/gtest.h>

#include <string>

namespace dermis::live::buses {
namespace {

ModbusPlace modbus(const std::string& text) {
  return std::get<ModbusPlace>(parse_bus_address(text)->place);
}

std::string error_of(const std::string& text) {
  return parse_bus_address(text).error().message;
}

TEST(BusAddress, a_device_in_the_network_has_host_port_and_map) {
  const ModbusPlace hand = modbus("modbus-tcp://192.168.123.211?map=inspire-rh56&array=palm");
  EXPECT_EQ(hand.host, "192.168.123.211");
  EXPECT_EQ(hand.port, 0) << "the map knows it";
  EXPECT_EQ(hand.map, "inspire-rh56");
  const ModbusPlace other = modbus("modbus-tcp://[::1]:6001?map=a.toml&unit=2&rate=30&reconnect_s=2");
  EXPECT_EQ(other.host, "::1");
  EXPECT_EQ(other.port, 6001);
  EXPECT_EQ(other.unit, 2);
  EXPECT_EQ(other.rate_hz, 30.0);
  EXPECT_EQ(other.reconnect, std::chrono::seconds(2));
}

TEST(BusAddress, a_serial_line_has_a_path_and_a_baud) {
  const ModbusPlace line = modbus("modbus-rtu:///dev/ttyUSB0?map=dfrobot-sen0705&baud=921600");
  EXPECT_EQ(line.path, "/dev/ttyUSB0");
  EXPECT_EQ(line.baud, 921'600U);
  EXPECT_TRUE(line.host.empty());
}

TEST(BusAddress, a_topic_has_a_domain_and_a_type) {
  const Result<BusAddress> address = parse_bus_address("dds://7/rt/dex3/left/state?type=HandState&array=a&loopback=1");
  ASSERT_TRUE(address);
  const auto& topic = std::get<TopicPlace>(address->place);
  EXPECT_EQ(topic.domain, 7U);
  EXPECT_EQ(topic.topic, "rt/dex3/left/state");
  EXPECT_EQ(topic.type, "HandState");
  EXPECT_TRUE(topic.loopback_only);
  EXPECT_EQ(address->array, "a");
}

TEST(BusAddress, arrays_of_one_place_share_a_connection) {
  const auto connection = [](const std::string& text) { return parse_bus_address(text)->connection; };
  EXPECT_EQ(connection("dds://0/t?type=T&array=a"), connection("dds://0/t?array=b&type=T"));
  EXPECT_NE(connection("dds://0/t?type=T"), connection("dds://1/t?type=T"));
  EXPECT_NE(connection("modbus-tcp://h?map=m&unit=1"), connection("modbus-tcp://h?map=m&unit=2"));
}

TEST(BusAddress, errors_name_the_part_and_the_mend) {
  EXPECT_EQ(error_of("modbus-tcp://?map=m"), "'modbus-tcp://?map=m': name the host, as modbus-tcp://192.168.123.210");
  EXPECT_EQ(error_of("modbus-tcp://h:0?map=m"), "'modbus-tcp://h:0?map=m': the port must be 1 to 65535");
  EXPECT_EQ(error_of("modbus-tcp://h"), "'modbus-tcp://h': lacks map=NAME, the registers of the device");
  EXPECT_EQ(error_of("modbus-tcp://h?map=m&unti=1"),
            "'modbus-tcp://h?map=m&unti=1': 'unti' is no parameter; did you mean 'unit'?");
  EXPECT_EQ(error_of("modbus-tcp://h?map=m&unit=300"),
            "'modbus-tcp://h?map=m&unit=300': unit: must be 1 to 247, not '300'");
  EXPECT_EQ(error_of("modbus-tcp://h?map=m&map=n"), "'modbus-tcp://h?map=m&map=n': map: is given twice");
  EXPECT_EQ(error_of("modbus-rtu:?map=m"), "'modbus-rtu:?map=m': name the serial line, as modbus-rtu:///dev/ttyUSB0");
  EXPECT_EQ(error_of("dds://300/t?type=T"), "'dds://300/t?type=T': name a domain of 0 to 232, as dds://0/rt/chest/raw");
  EXPECT_EQ(error_of("dds://0?type=T"),
            "'dds://0?type=T': names no topic; write it as DDS does, as dds://0/rt/chest/raw");
  EXPECT_EQ(error_of("dds://0/t"), "'dds://0/t': lacks type=TYPE, such as type=sensor_msgs/msg/Image");
  EXPECT_EQ(error_of("dds://0/t?type"), "'dds://0/t?type': type: has no value");
}

TEST(BusAddress, other_names_are_no_addresses_of_buses) {
  for (const char* const text : {"tcp://h:1", "serial:///dev/ttyUSB0", "dds.mcap", "modbus.toml"}) {
    EXPECT_FALSE(is_bus_address(text)) << text;
  }
}

}  // namespace
}  // namespace dermis::live::buses
