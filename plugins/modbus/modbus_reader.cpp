// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <modbus.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>
#include <string>
#include <utility>

#include "live/buses/register_reader.hpp"

/// The plugin that dermis::buses loads.
namespace dermis::live::buses {
namespace {

constexpr std::uint32_t kAnswerMicroseconds = 500'000;
/// The silence of a line before the next question: after no answer, and after a damaged one.
constexpr int kSilenceMilliseconds = 500;
constexpr int kShortSilenceMilliseconds = 20;
constexpr int kMostPieces = 100;

struct Deleter {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};
using Context = std::unique_ptr<modbus_t, Deleter>;

class ModbusReader final : public RegisterReader {
 public:
  ModbusReader(Context context, bool has_ids) : context_(std::move(context)), has_ids_(has_ids) {}

  [[nodiscard]] Status connect() override {
    modbus_close(context_.get());
    if (modbus_connect(context_.get()) == 0) return Done{};
    error_ = errno;
    return failed(reason());
  }

  [[nodiscard]] Answer read(bool input, std::uint16_t address, std::span<std::uint16_t> words) override {
    const int count = static_cast<int>(words.size());
    const auto ask = input ? modbus_read_input_registers : modbus_read_registers;
    if (ask(context_.get(), address, count, words.data()) == count) return Answer::read;
    error_ = errno;
    if (error_ > MODBUS_ENOBASE && error_ <= EMBXGTAR) return Answer::refused;
    has_ids_ ? void(modbus_flush(context_.get())) : wait_for_silence();
    if (error_ == ETIMEDOUT || error_ >= MODBUS_ENOBASE) return Answer::nothing;
    return Answer::lost;
  }

  [[nodiscard]] std::string reason() const override { return modbus_strerror(error_); }

 private:
  /// Answers on a serial line do not say to which question: a late one must not meet the next.
  void wait_for_silence() {
    const int silence = error_ == ETIMEDOUT ? kSilenceMilliseconds : kShortSilenceMilliseconds;
    pollfd line = {modbus_get_socket(context_.get()), POLLIN, 0};
    for (int piece = 0; piece < kMostPieces && poll(&line, 1, silence) > 0; ++piece) {
      std::array<char, 256> late{};
      if (::read(line.fd, late.data(), late.size()) <= 0) break;
    }
    modbus_flush(context_.get());
  }

  Context context_;
  bool has_ids_;  ///< Of questions, as TCP has them.
  int error_ = 0;
};

Context make_context(const ModbusPlace& place) {
  if (place.host.empty()) return Context(modbus_new_rtu(place.path.c_str(), static_cast<int>(place.baud), 'N', 8, 1));
  return Context(modbus_new_tcp_pi(place.host.c_str(), std::to_string(place.port).c_str()));
}

}  // namespace
}  // namespace dermis::live::buses

/// dermis::live::buses::MakeRegisterReader.
extern "C" __attribute__((visibility("default"))) void dermis_make_register_reader(
    const dermis::live::buses::ModbusPlace& place,
    dermis::Result<std::unique_ptr<dermis::live::buses::RegisterReader>>& made) {
  dermis::live::buses::Context context = dermis::live::buses::make_context(place);
  if (context == nullptr || modbus_set_slave(context.get(), place.unit) != 0 ||
      modbus_set_response_timeout(context.get(), 0, dermis::live::buses::kAnswerMicroseconds) != 0) {
    made = dermis::failed(std::string("Modbus: ") + modbus_strerror(errno));
    return;
  }
  made = std::unique_ptr<dermis::live::buses::RegisterReader>(
      std::make_unique<dermis::live::buses::ModbusReader>(std::move(context), !place.host.empty()));
}
