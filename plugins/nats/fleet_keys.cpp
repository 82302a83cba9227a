// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/fleet_keys.hpp"

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include <memory>
#include <utility>

#include "destroyer.hpp"
#include "nkeys.hpp"

namespace dermis::live::fleet {
namespace {

using Key = std::unique_ptr<EVP_PKEY, Destroyer<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Destroyer<X509_free>>;
using Memory = std::unique_ptr<BIO, Destroyer<BIO_free_all>>;
using Extension = std::unique_ptr<X509_EXTENSION, Destroyer<X509_EXTENSION_free>>;
using Number = std::unique_ptr<BIGNUM, Destroyer<BN_free>>;

constexpr int kBitsOfSerial = 127;
constexpr const char* kBegins = "19700101000000Z";  // the clock of a robot may stand there after a start
constexpr const char* kEnds = "99991231235959Z";    // never (RFC 5280)

Error no_key() {
  return failed("the library of keys (OpenSSL) makes none");
}

std::string text_of(BIO* memory) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(memory, &data);
  return {data, static_cast<std::size_t>(size)};
}

Key key_of(const std::string& pem) {
  const Memory memory(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  return Key(PEM_read_bio_PrivateKey(memory.get(), nullptr, nullptr, nullptr));
}

Certificate certificate_of(const std::string& pem) {
  const Memory memory(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  return Certificate(PEM_read_bio_X509(memory.get(), nullptr, nullptr, nullptr));
}

bool add_extension(X509* certificate, X509* issuer, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const Extension extension(X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()));
  return extension != nullptr && X509_add_ext(certificate, extension.get(), -1) == 1;
}

bool add_use(X509* certificate, X509* issuer, const CertificatePlan& plan) {
  const auto add = [&](int kind, const char* value) { return add_extension(certificate, issuer, kind, value); };
  if (plan.holder == Holder::authority) {
    return add(NID_basic_constraints, "critical,CA:TRUE,pathlen:0") && add(NID_key_usage, "critical,keyCertSign");
  }
  return add(NID_basic_constraints, "critical,CA:FALSE") && add(NID_key_usage, "critical,digitalSignature") &&
         add(NID_ext_key_usage, plan.holder == Holder::server ? "serverAuth" : "clientAuth");
}

bool set_name(X509* certificate, const std::string& name) {
  return X509_NAME_add_entry_by_txt(X509_get_subject_name(certificate), "CN", MBSTRING_UTF8,
                                    reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0) == 1;
}

bool set_serial(X509* certificate) {
  const Number number(BN_new());
  return number != nullptr && BN_rand(number.get(), kBitsOfSerial, BN_RAND_TOP_ONE, BN_RAND_BOTTOM_ANY) == 1 &&
         BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(certificate)) != nullptr;
}

bool fill(X509* certificate, X509* issuer, const CertificatePlan& plan) {
  return X509_set_version(certificate, X509_VERSION_3) == 1 && set_serial(certificate) &&
         set_name(certificate, plan.name) && X509_set_issuer_name(certificate, X509_get_subject_name(issuer)) == 1 &&
         ASN1_TIME_set_string_X509(X509_getm_notBefore(certificate), kBegins) == 1 &&
         ASN1_TIME_set_string_X509(X509_getm_notAfter(certificate), kEnds) == 1 && add_use(certificate, issuer, plan) &&
         (plan.other_names.empty() || add_extension(certificate, issuer, NID_subject_alt_name, plan.other_names));
}

class MadeKeys final : public FleetKeys {
 public:
  [[nodiscard]] Result<std::string> make_key() override;
  [[nodiscard]] Result<std::string> make_certificate(const CertificatePlan& plan) override;
  [[nodiscard]] Result<std::string> make_seed() override;
  [[nodiscard]] Result<std::string> user_of(const std::string& seed) override { return user_of_seed(seed); }
};

Result<std::string> MadeKeys::make_key() {
  const Key key(EVP_PKEY_Q_keygen(nullptr, nullptr, "ED25519"));
  const Memory memory(BIO_new(BIO_s_secmem()));
  if (key == nullptr || memory == nullptr) return no_key();
  if (PEM_write_bio_PrivateKey(memory.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1) return no_key();
  return text_of(memory.get());
}

Result<std::string> MadeKeys::make_certificate(const CertificatePlan& plan) {
  const bool signs_itself = plan.authority.empty();
  const Key key = key_of(plan.key);
  const Key signer = key_of(signs_itself ? plan.key : plan.authority_key);
  const Certificate authority = signs_itself ? nullptr : certificate_of(plan.authority);
  if (key == nullptr || signer == nullptr) return bad_input("the key for a certificate is no private key in PEM");
  if (!signs_itself && (authority == nullptr || X509_check_private_key(authority.get(), signer.get()) != 1)) {
    return bad_input("the certificate of the authority is not that of its key");
  }
  const Certificate certificate(X509_new());
  if (certificate == nullptr || X509_set_pubkey(certificate.get(), key.get()) != 1) return no_key();
  X509* const issuer = signs_itself ? certificate.get() : authority.get();
  if (!fill(certificate.get(), issuer, plan) || X509_sign(certificate.get(), signer.get(), nullptr) == 0) {
    return failed("no certificate can be made for '" + plan.name + "' (" + plan.other_names + ")");
  }
  const Memory memory(BIO_new(BIO_s_mem()));
  if (memory == nullptr || PEM_write_bio_X509(memory.get(), certificate.get()) != 1) return no_key();
  return text_of(memory.get());
}

Result<std::string> MadeKeys::make_seed() {
  KeyBytes seed{};
  if (RAND_priv_bytes(seed.data(), static_cast<int>(seed.size())) != 1) return no_key();
  return seed_text(seed);
}

}  // namespace

}  // namespace dermis::live::fleet

extern "C" __attribute__((visibility("default"))) void dermis_make_fleet_keys(
    std::unique_ptr<dermis::live::fleet::FleetKeys>& made) {
  made = std::make_unique<dermis::live::fleet::MadeKeys>();
}
