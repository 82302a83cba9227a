/* SPDX-License-Identifier: Apache-2.0
 * SPDX-FileCopyrightText: 2026 The dermis authors
 *
 * The sketch of a 4x6 array that a press wanders over, to be run on a PC: 100 frames on standard output.
 *   ./firmware_example > frames.bin
 * On a microcontroller, main() becomes setup() and loop(), and read_taxel() selects the lines and reads the ADC. */
#include <stdio.h>

#include "dermis_wire.h"

static const uint16_t kRows = 4;
static const uint16_t kCols = 6;
static const uint32_t kFrames = 100;
static const uint32_t kPeriodUs = 5000;

static void put_byte(uint8_t byte, void* context) {
  (void)context;
  putchar(byte);
}

static uint16_t read_taxel(uint32_t frame, uint16_t row, uint16_t col) {
  const uint32_t index = (uint32_t)(row * kCols + col);
  return (frame / 4) % (uint32_t)(kRows * kCols) == index ? 900 : (uint16_t)index;
}

int main(void) {
  dermis_wire wire = {.put_byte = put_byte};
  dermis_wire_start(&wire);
  for (uint32_t frame = 0; frame < kFrames; ++frame) {
    const dermis_wire_header header = {.sequence = frame,
                                       .has_time = true,
                                       .time_us = frame * kPeriodUs,
                                       .has_temperature = true,
                                       .temperature_centi_celsius = 2350,
                                       .has_supply = true,
                                       .supply_mv = 3300,
                                       .rows = kRows,
                                       .cols = kCols};
    dermis_wire_begin(&wire, &header);
    for (uint16_t row = 0; row < kRows; ++row) {
      for (uint16_t col = 0; col < kCols; ++col) dermis_wire_reading(&wire, read_taxel(frame, row, col));
    }
    dermis_wire_end(&wire);
  }
  return 0;
}
