#include "server/base/identifiers.hpp"

#include <openssl/evp.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "server/base/files.hpp"

namespace symcell::server {
namespace {

constexpr std::string_view kBase32 = "0123456789abcdefghjkmnpqrstvwxyz";
constexpr std::string_view kHex = "0123456789abcdef";
constexpr std::size_t kJobIdLength = 26;

template <std::size_t N>
std::array<unsigned char, N> random_bytes() {
  std::array<unsigned char, N> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(N)) != 1) {
    throw std::runtime_error("the system has no random numbers");
  }
  return bytes;
}

void append_hex(std::string& text, unsigned char byte) {
  text.push_back(kHex[byte >> 4U]);
  text.push_back(kHex[byte & 15U]);
}

}  // namespace

std::string make_job_id(std::int64_t time_ms) {
  std::string id(kJobIdLength, '0');
  auto time = static_cast<std::uint64_t>(time_ms);
  for (std::size_t i = 10; i-- > 0; time >>= 5U) id[i] = kBase32[time & 31U];
  const auto random = random_bytes<16>();
  for (std::size_t i = 0; i < random.size(); ++i) id[10 + i] = kBase32[random[i] & 31U];
  return id;
}

bool is_job_id(std::string_view text) {
  return text.size() == kJobIdLength && std::ranges::all_of(text, [](char c) {
           return kBase32.find(c) != std::string_view::npos;
         });
}

std::string make_random_hex() {
  std::string text;
  for (const unsigned char byte : random_bytes<8>()) append_hex(text, byte);
  return text;
}

struct Sha256::Impl {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
};

Sha256::Sha256() : impl_(std::make_unique<Impl>()) {
  if (impl_->context == nullptr || EVP_DigestInit_ex(impl_->context, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available");
  }
}

Sha256::~Sha256() {
  EVP_MD_CTX_free(impl_->context);
}

void Sha256::append(std::string_view bytes) {
  EVP_DigestUpdate(impl_->context, bytes.data(), bytes.size());
}

std::string Sha256::finish() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  EVP_DigestFinal_ex(impl_->context, digest.data(), &length);
  std::string text;
  for (unsigned int i = 0; i < length; ++i) append_hex(text, digest[i]);
  return text;
}

std::string sha256_of(std::string_view bytes) {
  Sha256 digest;
  digest.append(bytes);
  return digest.finish();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  Sha256 digest;
  FileReader file(path, Links::kRefuse);
  for (std::string_view piece = file.next(); !piece.empty(); piece = file.next()) {
    digest.append(piece);
  }
  return digest.finish();
}

}  // namespace symcell::server
