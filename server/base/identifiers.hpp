// Identifiers that cannot be guessed, and digests of requests.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace symcell::server {

// 26 characters of Crockford's base 32, lower case: 48 bits of time, 80 random bits. Sorted as text
// they are in order of time; the random part makes a job's address a secret.
[[nodiscard]] std::string make_job_id(std::int64_t time_ms);
[[nodiscard]] bool is_job_id(std::string_view text);

// 16 hexadecimal digits, for request ids and names of temporary files.
[[nodiscard]] std::string make_random_hex();

// SHA-256 of everything appended, as 64 hexadecimal digits.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void append(std::string_view bytes);
  // Once only.
  [[nodiscard]] std::string finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Of a whole file, which must not be a symbolic link.
[[nodiscard]] std::string sha256_of(std::string_view bytes);
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace symcell::server
