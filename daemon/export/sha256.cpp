#include "daemon/export/sha256.hpp"

#include <glib.h>

namespace fvd {

struct Sha256::State {
  State() : checksum(g_checksum_new(G_CHECKSUM_SHA256)) {}
  ~State() { g_checksum_free(checksum); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  GChecksum* checksum;
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}

Sha256::~Sha256() = default;

void Sha256::update(std::string_view bytes) {
  g_checksum_update(state_->checksum, reinterpret_cast<const guchar*>(bytes.data()), static_cast<gssize>(bytes.size()));
}

std::string Sha256::digits() { return g_checksum_get_string(state_->checksum); }

std::string sha256_of(std::string_view bytes) {
  Sha256 digest;
  digest.update(bytes);
  return digest.digits();
}

}  // namespace fvd
