// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/serial_stream.hpp"

#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "bytes/devices/asio_stream.hpp"
#include "bytes/devices/serial_settings.hpp"
#include "dermis/bytes/devices/serial_ports.hpp"

namespace dermis::bytes::devices {
namespace {

Error not_there(const std::string& path) {
  std::string list;
  for (const SerialPort& port : serial_ports()) list += (list.empty() ? "" : ", ") + port.device;
  if (list.empty()) {
    return failed(in_quotes(path) +
                  " is not there, nor is any USB serial device: is it plugged in, with a data cable?");
  }
  return failed(in_quotes(path) + " is not there; the serial devices that are: " + list);
}

Error cannot_open_serial(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO: return not_there(path);
    case EACCES:
    case EPERM:
      return failed("no permission for " + in_quotes(path) +
                    ": add yourself to the group dialout: sudo usermod -aG dialout $USER, and log in again");
    case EBUSY:
    case EWOULDBLOCK:
      return failed(in_quotes(path) + " is in use by another program: close it ('fuser " + path + "' tells which)");
    case ENOTTY:
      return bad_input(in_quotes(path) + " is no serial device; bytes of a device in a file are file:" + path);
    default: return failed("cannot open " + in_quotes(path) + ": " + std::strerror(error));
  }
}

/// Bytes are handed over as they come, not 16 ms later; where the driver knows how, and where we may.
void ask_for_low_latency(int descriptor, const std::string& path) {
  serial_struct settings{};
  if (::ioctl(descriptor, TIOCGSERIAL, &settings) == 0) {
    settings.flags |= ASYNC_LOW_LATENCY;
    ::ioctl(descriptor, TIOCSSERIAL, &settings);
  }
  std::error_code error;
  const std::string device = std::filesystem::canonical(path, error).filename().string();
  std::ofstream latency_timer("/sys/class/tty/" + device + "/device/latency_timer");  // FTDI [ms]
  latency_timer << 1;
}

/// Asio has opened the port without blocking.
ByteStream::Transferred read_now(int descriptor, std::span<std::uint8_t> into) {
  const ssize_t count = ::read(descriptor, into.data(), into.size());
  if (count > 0) return {static_cast<std::size_t>(count), ByteStream::End::none};
  const bool goes_on = count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
  return {0, goes_on ? ByteStream::End::none : ByteStream::End::lost};
}

class SerialStream final : public AsioStream {
 public:
  SerialStream(std::string path, unsigned baud) : path_(std::move(path)), baud_(baud) {}

  Result<bool> open(Nanos /*timeout*/) override {
    error_code error;
    port_.close(error);
    port_.open(path_, error);
    if (error) return cannot_open_serial(path_, error.value());
    const int descriptor = port_.native_handle();
    // TIOCEXCL does not hold back root, the lock only those who ask for it.
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return give_up(errno);
    ::ioctl(descriptor, TIOCEXCL);
    if (!set_raw_8n1(descriptor, baud_)) {
      if (errno == EINVAL) return refuse_baud();
      return give_up(errno);
    }
    ask_for_low_latency(descriptor, path_);
    descriptor_ = descriptor;
    return true;
  }
  Transferred read(std::span<std::uint8_t> into, Nanos timeout) override {
    if (timeout > Nanos{}) return read_some(port_, into, timeout, End::lost);
    return read_now(port_.native_handle(), into);
  }
  Transferred write(std::span<const std::uint8_t> bytes, Nanos timeout) override {
    return write_some(port_, bytes, timeout, End::lost);
  }
  [[nodiscard]] int descriptor() const override { return descriptor_; }
  [[nodiscard]] std::string name() const override { return path_; }

 private:
  Error give_up(int number) {
    error_code ignored;
    port_.close(ignored);
    return cannot_open_serial(path_, number);
  }

  Error refuse_baud() {
    error_code ignored;
    port_.close(ignored);
    return bad_input(in_quotes(path_) + " cannot do baud=" + std::to_string(baud_) + ": give one that it can");
  }

  std::string path_;
  unsigned baud_;
  int descriptor_ = -1;
  asio::serial_port port_{context_};
};

}  // namespace

std::unique_ptr<ByteStream> make_serial_stream(const std::string& path, unsigned baud) {
  return std::make_unique<SerialStream>(path, baud);
}

}  // namespace dermis::bytes::devices
