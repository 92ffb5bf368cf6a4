#pragma once

/// The SHA-256 of bytes that come one after the other.

#include <memory>
#include <string>
#include <string_view>

namespace fvd {

/// FIPS 180-4. context: one thread.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  /// Not after digits().
  void update(std::string_view bytes);
  /// 64 lower-case hexadecimal digits.
  [[nodiscard]] std::string digits();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

[[nodiscard]] std::string sha256_of(std::string_view bytes);

}  // namespace fvd
