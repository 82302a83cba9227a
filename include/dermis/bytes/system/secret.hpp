// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/touch/frames/result.hpp"

namespace dermis {

/// Where a secret may be, for a program whose command line everybody may read. The first place that is there counts.
struct SecretPlaces {
  std::string file;         ///< That the user names, such as "/etc/dermis/token"; empty: none.
  std::string environment;  ///< "DERMIS_TOKEN"; what is set and empty is not there.
  std::string credential;   ///< "token": a file in $CREDENTIALS_DIRECTORY, where systemd puts those of LoadCredential=.
};

/// The secret; empty where no place has one. A file holds it as its only line, of at most 4096 bytes. Bad input: a file
/// that cannot be read, that holds anything else, or that every user of the machine may read or write. No message holds
/// a secret. Not beside setenv().
[[nodiscard]] Result<std::string> read_secret(const SecretPlaces& places);

}  // namespace dermis
