/* SPDX-License-Identifier: Apache-2.0
 * SPDX-FileCopyrightText: 2026 The dermis authors
 *
 * Sends frames of a tactile array by the dermis wire protocol, version 1 (docs/wire-protocol.md): C99, no malloc, about
 * 300 bytes of RAM whatever the array, readings sent as they are scanned. Copy this file and dermis_wire.c.
 *
 *   static void put_byte(uint8_t byte, void *port) { ... }
 *   static dermis_wire wire = {.put_byte = put_byte};
 *
 *   dermis_wire_start(&wire);                       once, after power-up
 *   for each frame:
 *     dermis_wire_header header = {.sequence = n++, .rows = 16, .cols = 16, ...};
 *     dermis_wire_begin(&wire, &header);
 *     rows * cols times, row by row:  dermis_wire_reading(&wire, analogRead(...));
 *     dermis_wire_end(&wire);
 */
#ifndef DERMIS_WIRE_H
#define DERMIS_WIRE_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  uint32_t sequence; /* of the frame: counts every frame that was taken, also those that are not sent; wraps */
  bool has_time;
  uint32_t time_us; /* clock of the device when the frame was taken, wraps */
  bool has_temperature;
  int16_t temperature_centi_celsius; /* of the array, 0.01 C */
  bool has_supply;
  uint16_t supply_mv;
  uint16_t rows, cols; /* 1 ... 1024 each */
} dermis_wire_header;

typedef struct {
  void (*put_byte)(uint8_t byte, void* context); /* sends one byte */
  void* context;                                 /* handed to put_byte */
  uint32_t crc;                                  /* what follows is the encoder's own */
  uint8_t block_size;
  uint8_t block[254];
} dermis_wire;

/* Ends whatever the receiver may have seen before, so that the first frame is not lost. */
void dermis_wire_start(dermis_wire* wire);

void dermis_wire_begin(dermis_wire* wire, const dermis_wire_header* header);

/* The next reading, exactly rows * cols times a frame. */
void dermis_wire_reading(dermis_wire* wire, uint16_t counts);

void dermis_wire_end(dermis_wire* wire);

#ifdef __cplusplus
}
#endif

#endif
