/* SPDX-License-Identifier: Apache-2.0 */
/* SPDX-FileCopyrightText: 2026 The dermis authors */
/* A hand of 1062 taxels that is asked by Modbus, by the server of libmodbus.

     modbus_hand tcp|PATH SEED MILLISECONDS

   listens on loopback and prints "port N", or answers on a serial line. It serves one client. Addresses count bytes
   from 3000 on. Taxel t of all 1062 is, when it is asked for the time number n (from 0 on),

     (1000 SEED + 7 t + 13 n) mod 4096

   MILLISECONDS go by before each answer. At the end it prints "a n" for each address: how often that was asked for. */
#include <arpa/inet.h>
#include <errno.h>
#include <modbus.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { first_address = 3000, taxels = 1062, unit = 1, baud = 115200 };

static unsigned answers[taxels];

static void fail(const char* what) {
  fprintf(stderr, "modbus_hand: %s: %s\n", what, modbus_strerror(errno));
  exit(1);
}

static void print_port(int listener) {
  struct sockaddr_in place;
  socklen_t size = sizeof place;
  getsockname(listener, (struct sockaddr*)&place, &size);
  printf("port %d\n", ntohs(place.sin_port));
  fflush(stdout);
}

static int is_asked_well(const uint8_t* question, unsigned address, unsigned words) {
  if (question[0] != MODBUS_FC_READ_HOLDING_REGISTERS || words < 1 || words > 125) return 0;
  return address >= first_address && address % 2 == 0 && address + 2 * words <= first_address + 2 * taxels;
}

static void answer(modbus_t* context, modbus_mapping_t* registers, const uint8_t* query, int length, unsigned seed) {
  const uint8_t* const question = query + modbus_get_header_length(context);
  const unsigned address = 256U * question[1] + question[2];
  const unsigned words = 256U * question[3] + question[4];
  if (!is_asked_well(question, address, words)) {
    modbus_reply_exception(context, query, MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS);
    return;
  }
  const unsigned first = (address - first_address) / 2;
  for (unsigned k = 0; k < words; ++k) {
    registers->tab_registers[address + k] =
        (uint16_t)((1000 * seed + 7 * (first + k) + 13 * answers[first + k]) % 4096);
  }
  if (modbus_reply(context, query, length, registers) <= 0) return;
  for (unsigned k = 0; k < words; ++k) ++answers[first + k];
}

int main(int argc, char** argv) {
  if (argc != 4) fail("usage: modbus_hand tcp|PATH SEED MILLISECONDS");
  const int is_tcp = strcmp(argv[1], "tcp") == 0;
  const unsigned seed = (unsigned)atoi(argv[2]);
  const useconds_t pause = 1000U * (useconds_t)atoi(argv[3]);
  modbus_t* const context = is_tcp ? modbus_new_tcp("127.0.0.1", 0) : modbus_new_rtu(argv[1], baud, 'N', 8, 1);
  modbus_mapping_t* const registers = modbus_mapping_new(0, 0, first_address + 4 * taxels, 0);
  if (context == NULL || registers == NULL) fail("cannot begin");
  modbus_set_slave(context, unit);
  int listener = -1;
  if (is_tcp) {
    listener = modbus_tcp_listen(context, 16);
    print_port(listener);
    if (modbus_tcp_accept(context, &listener) < 0) fail("nobody came");
  } else {
    if (modbus_connect(context) != 0) fail("cannot open the line");
    puts("open");
    fflush(stdout);
  }
  uint8_t query[MODBUS_TCP_MAX_ADU_LENGTH];
  for (int length = 0; (length = modbus_receive(context, query)) >= 0;) {
    if (length == 0) continue;
    if (pause > 0) usleep(pause);
    answer(context, registers, query, length, seed);
  }
  for (unsigned k = 0; k < taxels; ++k) {
    if (answers[k] > 0) printf("%u %u\n", first_address + 2 * k, answers[k]);
  }
  modbus_mapping_free(registers);
  modbus_close(context);
  modbus_free(context);
  return 0;
}
