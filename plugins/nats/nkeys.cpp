// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "nkeys.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "destroyer.hpp"

namespace dermis::live::fleet {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ234567";
constexpr unsigned kBitsOfALetter = 5;
constexpr unsigned kLetterMask = 31;
constexpr std::uint8_t kUser = 20U << 3U;  // the first letter is U
constexpr std::uint8_t kSeed = 18U << 3U;  // the first letter is S, and that of the kind is the next
constexpr std::array<std::uint8_t, 2> kSeedOfUser = {kSeed | (kUser >> 5U), static_cast<std::uint8_t>(kUser << 3U)};
constexpr std::size_t kChecksumBytes = 2;
constexpr std::size_t kLettersOfASeed = 58;

/// CRC-16 with the polynomial 0x1021, from 0 on (XMODEM).
std::uint16_t checksum(const Bytes& bytes) {
  std::uint32_t sum = 0;
  for (const std::uint32_t byte : bytes) {
    sum ^= byte << 8U;
    for (int bit = 0; bit < 8; ++bit) sum = ((sum << 1U) ^ ((sum & 0x8000U) != 0 ? 0x1021U : 0U)) & 0xFFFFU;
  }
  return static_cast<std::uint16_t>(sum);
}

void add_checksum(Bytes& bytes) {
  const std::uint16_t sum = checksum(bytes);
  bytes.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(sum >> 8U));
}

/// Base32 without padding.
std::string text_of(const Bytes& bytes) {
  std::string text;
  std::uint32_t waiting = 0;
  unsigned bits = 0;
  for (const std::uint8_t byte : bytes) {
    waiting = (waiting << 8U) | byte;
    for (bits += 8; bits >= kBitsOfALetter; bits -= kBitsOfALetter) {
      text += kLetters[(waiting >> (bits - kBitsOfALetter)) & kLetterMask];
    }
  }
  if (bits > 0) text += kLetters[(waiting << (kBitsOfALetter - bits)) & kLetterMask];
  return text;
}

std::optional<Bytes> bytes_of(const std::string& text) {
  Bytes bytes;
  std::uint32_t waiting = 0;
  unsigned bits = 0;
  for (const char letter : text) {
    const std::size_t value = kLetters.find(letter);
    if (value == std::string_view::npos) return std::nullopt;
    waiting = (waiting << kBitsOfALetter) | static_cast<std::uint32_t>(value);
    bits += kBitsOfALetter;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>((waiting >> bits) & 0xFFU));
  }
  return bytes;
}

template <std::size_t Size>
std::string encode(const std::array<std::uint8_t, Size>& kind, const KeyBytes& key) {
  Bytes bytes(kind.begin(), kind.end());
  bytes.insert(bytes.end(), key.begin(), key.end());
  add_checksum(bytes);
  return text_of(bytes);
}

Result<KeyBytes> parse_seed(const std::string& text) {
  const Error wrong = bad_input("holds no key of a user of NATS: 58 letters and digits that begin with SU");
  if (text.size() != kLettersOfASeed) return wrong;
  const std::optional<Bytes> bytes = bytes_of(text);
  KeyBytes key{};
  if (!bytes || bytes->size() != kSeedOfUser.size() + key.size() + kChecksumBytes) return wrong;
  if (!std::equal(kSeedOfUser.begin(), kSeedOfUser.end(), bytes->begin())) return wrong;
  std::copy_n(bytes->begin() + kSeedOfUser.size(), key.size(), key.begin());
  if (encode(kSeedOfUser, key) != text) return bad_input("holds a key with a mistake: its checksum is another");
  return key;
}

using Key = std::unique_ptr<EVP_PKEY, Destroyer<EVP_PKEY_free>>;
using Context = std::unique_ptr<EVP_MD_CTX, Destroyer<EVP_MD_CTX_free>>;

Error no_key() {
  return failed("the library of keys (OpenSSL) makes no key");
}

Result<Key> key_of_seed(const std::string& seed) {
  const Result<KeyBytes> bytes = parse_seed(seed);
  if (!bytes) return bytes.error();
  Key key(EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, nullptr, bytes->data(), bytes->size()));
  if (key == nullptr) return no_key();
  return key;
}

}  // namespace

std::string seed_text(const KeyBytes& seed) {
  return encode(kSeedOfUser, seed);
}

Result<std::string> user_of_seed(const std::string& seed) {
  const Result<Key> key = key_of_seed(seed);
  if (!key) return key.error();
  KeyBytes user{};
  std::size_t size = user.size();
  if (EVP_PKEY_get_raw_public_key(key->get(), user.data(), &size) != 1) return no_key();
  return encode(std::array{kUser}, user);
}

Result<Signature> sign(const std::string& seed, std::string_view text) {
  const Result<Key> key = key_of_seed(seed);
  if (!key) return key.error();
  const Context context(EVP_MD_CTX_new());
  Signature signature{};
  std::size_t size = signature.size();
  const bool is_signed = context != nullptr &&
                         EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, key->get()) == 1 &&
                         EVP_DigestSign(context.get(), signature.data(), &size,
                                        reinterpret_cast<const std::uint8_t*>(text.data()), text.size()) == 1;
  return is_signed ? Result<Signature>(signature) : no_key();
}

}  // namespace dermis::live::fleet
