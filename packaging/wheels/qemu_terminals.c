// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// What the kernel of an arm64 machine has, and qemu 7.2 lacks: terminals with any speed (TCGETS2, TCSETS2). Programs that
// qemu runs preload it; of a pseudo-terminal, the speed means nothing.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <stdarg.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

static unsigned speed = 38400;

int ioctl(int file, unsigned long request, ...) {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  struct termios2* const wide = argument;
  struct termios known;  // termios2 begins with it
  if (request == TCGETS2) {
    const long failed = syscall(SYS_ioctl, file, TCGETS, &known);
    if (failed) return (int)failed;
    memcpy(wide, &known, sizeof known);
    wide->c_ispeed = wide->c_ospeed = speed;
    return 0;
  }
  if (request == TCSETS2) {
    memcpy(&known, wide, sizeof known);
    known.c_cflag = (known.c_cflag & ~(tcflag_t)(CBAUD | (CBAUD << IBSHIFT))) | B115200;
    speed = wide->c_ospeed;
    return (int)syscall(SYS_ioctl, file, TCSETS, &known);
  }
  return (int)syscall(SYS_ioctl, file, request, argument);
}
