#include "drivers/modbus/own_writes.hpp"

#include <algorithm>
#include <utility>

#include "drivers/modbus/drive_sequence.hpp"

namespace fvd {

namespace {

/// The value that a write puts into a register; nothing if it does not touch all of it.
std::optional<std::int64_t> written_to(const DriveRegister& reg, const ModbusRequest& write) {
  const auto count = static_cast<int>(write.written.size());
  if (reg.table != write.table || reg.address < write.address) return std::nullopt;
  if (reg.address + reg.words() > write.address + count) return std::nullopt;
  return decode(reg, write.written.data() + (reg.address - write.address));
}

}  // namespace

OwnWrites::OwnWrites(std::vector<DriveRegister> watched, bool restart_reads_zero)
    : restart_reads_zero_(restart_reads_zero), registers_(std::move(watched)) {
  const MutexLock lock(mutex_);
  for (const DriveRegister& reg : registers_) watched_.push_back({reg, {}});
}

void OwnWrites::saw(const ModbusRequest& write, bool sent, bool done) {
  const MutexLock lock(mutex_);
  ++epoch_;
  on_their_way_ += sent ? -1 : 1;
  for (Watched& watched : watched_) {
    const auto value = written_to(watched.reg, write);
    if (!value) continue;
    if (done) {
      watched.possible = {*value};
    } else if (!sent && !watched.possible.empty()) {
      watched.possible.push_back(*value);
    }
  }
}

std::optional<std::uint64_t> OwnWrites::quiet_epoch() const {
  const MutexLock lock(mutex_);
  return on_their_way_ == 0 ? std::optional(epoch_) : std::nullopt;
}

std::optional<ForeignWrite> OwnWrites::foreign(ModbusLink& link) {
  std::optional<ForeignWrite> found;
  for (std::size_t i = 0; i < registers_.size(); ++i) {
    const auto before = quiet_epoch();
    if (!before) return found;
    const auto value = read_register(link, registers_[i]);
    const MutexLock lock(mutex_);
    if (!value || on_their_way_ != 0 || epoch_ != *before) continue;
    auto one = judge(watched_[i], *value);
    if (one && (!found || found->is_restart)) found = std::move(one);
  }
  return found;
}

std::optional<ForeignWrite> OwnWrites::judge(Watched& watched, std::int64_t value) const {
  auto& possible = watched.possible;
  if (std::find(possible.begin(), possible.end(), value) != possible.end()) return std::nullopt;
  const auto own = possible.empty() ? std::nullopt : std::optional(possible.back());
  possible = {value};
  if (!own) return std::nullopt;
  return ForeignWrite{
      "'" + watched.reg.name + "' reads " + std::to_string(value) + ", and fvd wrote " + std::to_string(*own),
      value == 0 && restart_reads_zero_};
}

}  // namespace fvd
