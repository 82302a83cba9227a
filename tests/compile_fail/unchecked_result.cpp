// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// expected error: conversion from .*Result<|no viable conversion
#include "dermis/bytes/files/array_toml.hpp"

std::size_t taxels();

std::size_t taxels() {
#ifdef MISTAKE
  const dermis::ArrayDescription array = dermis::bytes::files::read_array("array.toml");
#else
  const dermis::ArrayDescription array = dermis::bytes::files::read_array("array.toml").value();
#endif
  return array.taxel_count();
}
