// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/serial_settings.hpp"

#include <asm/termbits.h>  // clashes with <termios.h>, so this is a file of its own
#include <sys/ioctl.h>

#include <cerrno>
#include <cstdint>

namespace dermis::bytes::devices {

bool set_raw_8n1(int descriptor, unsigned baud) {
  termios2 settings{};
  if (::ioctl(descriptor, TCGETS2, &settings) != 0) return false;
  settings.c_iflag = IGNPAR;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (static_cast<unsigned>(BOTHER) << static_cast<unsigned>(IBSHIFT));
  settings.c_ispeed = baud;
  settings.c_ospeed = baud;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  if (::ioctl(descriptor, TCSETS2, &settings) != 0 || ::ioctl(descriptor, TCGETS2, &settings) != 0) return false;
  // An asynchronous receiver bears some 3 % of difference.
  const std::uint64_t set = settings.c_ospeed;
  if (set * 100 >= std::uint64_t{baud} * 97 && set * 100 <= std::uint64_t{baud} * 103) return true;
  errno = EINVAL;
  return false;
}

}  // namespace dermis::bytes::devices
