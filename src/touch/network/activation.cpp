// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/network/activation.hpp"

#include <cmath>

namespace dermis::touch::network {

std::string_view name(Activation activation) noexcept {
  switch (activation) {
    case Activation::log_sigmoid: return "log_sigmoid";
    case Activation::tanh: return "tanh";
    case Activation::relu: return "relu";
    case Activation::linear: break;
  }
  return "linear";
}

template <std::floating_point Real>
Real activate(Activation activation, Real sum) noexcept {
  switch (activation) {
    case Activation::log_sigmoid: return Real{1} / (Real{1} + std::exp(-sum));
    case Activation::tanh: return std::tanh(sum);
    case Activation::relu: return sum < Real{0} ? Real{0} : sum;
    case Activation::linear: break;
  }
  return sum;
}

template <std::floating_point Real>
Real slope_from_output(Activation activation, Real output) noexcept {
  switch (activation) {
    case Activation::log_sigmoid: return output * (Real{1} - output);
    case Activation::tanh: return Real{1} - output * output;
    case Activation::relu: return output > Real{0} ? Real{1} : Real{0};
    case Activation::linear: break;
  }
  return Real{1};
}

template float activate(Activation, float) noexcept;
template double activate(Activation, double) noexcept;
template float slope_from_output(Activation, float) noexcept;
template double slope_from_output(Activation, double) noexcept;

}  // namespace dermis::touch::network
