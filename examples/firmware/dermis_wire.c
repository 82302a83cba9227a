/* SPDX-License-Identifier: Apache-2.0
 * SPDX-FileCopyrightText: 2026 The dermis authors */
#include "dermis_wire.h"

/* Bytes without a zero: their number and one more, then they themselves. */
static void put_block(dermis_wire* wire) {
  wire->put_byte((uint8_t)(wire->block_size + 1), wire->context);
  for (uint8_t i = 0; i < wire->block_size; ++i) wire->put_byte(wire->block[i], wire->context);
  wire->block_size = 0;
}

/* COBS: a zero is not sent, as each block but one of 254 bytes ends in one. */
static void put_stuffed(dermis_wire* wire, uint8_t byte) {
  if (wire->block_size == sizeof wire->block) put_block(wire);
  if (byte == 0) {
    put_block(wire);
  } else {
    wire->block[wire->block_size++] = byte;
  }
}

/* CRC-32 of IEEE 802.3, four bits at a time. */
static uint32_t crc_of_low_bits(uint32_t crc) {
  static const uint32_t kTable[16] = {0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
                                      0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
                                      0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
  return (crc >> 4) ^ kTable[crc & 15];
}

static void put_8(dermis_wire* wire, uint8_t byte) {
  wire->crc = crc_of_low_bits(crc_of_low_bits(wire->crc ^ byte));
  put_stuffed(wire, byte);
}

static void put_16(dermis_wire* wire, uint16_t value) {
  put_8(wire, (uint8_t)(value & 255));
  put_8(wire, (uint8_t)(value >> 8));
}

static void put_32(dermis_wire* wire, uint32_t value) {
  put_16(wire, (uint16_t)(value & 65535));
  put_16(wire, (uint16_t)(value >> 16));
}

void dermis_wire_start(dermis_wire* wire) {
  wire->put_byte(0, wire->context);
}

void dermis_wire_begin(dermis_wire* wire, const dermis_wire_header* header) {
  wire->crc = 0xffffffff;
  wire->block_size = 0;
  put_8(wire, 1); /* version */
  put_8(wire, (uint8_t)((header->has_temperature ? 1 : 0) | (header->has_supply ? 2 : 0) | (header->has_time ? 4 : 0)));
  put_32(wire, header->sequence);
  put_32(wire, header->has_time ? header->time_us : 0);
  put_16(wire, header->has_temperature ? (uint16_t)header->temperature_centi_celsius : 0);
  put_16(wire, header->has_supply ? header->supply_mv : 0);
  put_16(wire, header->rows);
  put_16(wire, header->cols);
}

void dermis_wire_reading(dermis_wire* wire, uint16_t counts) {
  put_16(wire, counts);
}

void dermis_wire_end(dermis_wire* wire) {
  put_32(wire, ~wire->crc);
  put_block(wire);
  wire->put_byte(0, wire->context);
}
