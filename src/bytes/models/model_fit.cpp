// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/models/model_fit.hpp"

#include <fmt/core.h>

namespace dermis::bytes::models {

std::string misfit(const ArrayDescription& array, const ArrayDescription& of_model) {
  if (of_model.rows != array.rows || of_model.cols != array.cols) {
    return fmt::format("it is of {}x{} taxels, the array of {}x{}", of_model.rows, of_model.cols, array.rows,
                       array.cols);
  }
  if (of_model.row_pitch_m != array.row_pitch_m || of_model.col_pitch_m != array.col_pitch_m) {
    return "it is of another pitch";
  }
  const bool has_same_readings = of_model.readout.quantity == array.readout.quantity &&
                                 of_model.readout.adc_bits == array.readout.adc_bits &&
                                 of_model.readout.pressure_raises_reading == array.readout.pressure_raises_reading;
  if (!has_same_readings) return "it is of other readings: quantity, bits or direction differ";
  if (of_model.order != array.order) return "its lines are in another order";
  const bool has_same_temperatures = of_model.temperature_sensors == array.temperature_sensors &&
                                     of_model.temperature_gradient_celsius == array.temperature_gradient_celsius;
  if (!has_same_temperatures) return "its sensors of temperature are elsewhere";
  return of_model.absent != array.absent ? "other taxels are absent in it" : "";
}

}  // namespace dermis::bytes::models
