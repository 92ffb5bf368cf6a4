#include "drivers/modbus/own_writes.hpp"

#include <algorithm>
#include <utility>

#include "drivers/modbus/drive_sequence.hpp"

namespace fvd {

namespace {

bool contains(const std::vector<std::int64_t>& values, std::int64_t value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

/// The value that a write puts into a register; nothing if it does not touch all of it.
std::optional<std::int64_t> written_to(const DriveRegister& reg, const ModbusRequest& write) {
  const auto count = static_cast<int>(write.written.size());
  if (reg.table != write.table || reg.address < write.address) return std::nullopt;
  if (reg.address + reg.words() > write.address + count) return std::nullopt;
  return decode(reg, write.written.data() + (reg.address - write.address));
}

}  // namespace

OwnWrites::OwnWrites(std::vector<DriveRegister> watched)
    : registers_(std::move(watched)), possible_(registers_.size()) {}

void OwnWrites::saw(const ModbusRequest& write, bool sent, bool done) {
  const MutexLock lock(mutex_);
  ++epoch_;
  on_their_way_ += sent ? -1 : 1;
  for (std::size_t i = 0; i < registers_.size(); ++i) {
    const auto value = written_to(registers_[i], write);
    if (!value) continue;
    Possible& possible = possible_[i];
    if (done) {
      possible = {*value};
    } else if (!sent && !possible.empty() && !contains(possible, *value)) {
      possible.push_back(*value);
    }
  }
}

std::optional<std::uint64_t> OwnWrites::quiet_epoch() const {
  const MutexLock lock(mutex_);
  return on_their_way_ == 0 ? std::optional(epoch_) : std::nullopt;
}

std::optional<ForeignWrite> OwnWrites::foreign(ModbusLink& link, const std::stop_token& stop) {
  const auto before = quiet_epoch();
  if (!before) return std::nullopt;
  std::vector<std::int64_t> values;
  for (const DriveRegister& reg : registers_) {
    const auto value = read_register(link, reg, ModbusPriority::kNormal, stop);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  const MutexLock lock(mutex_);
  if (on_their_way_ != 0 || epoch_ != *before) return std::nullopt;
  return judge(values);
}

/// Another master may write a 0 too, but hardly to everything at once: then the drive is not fvd's to take back.
std::optional<ForeignWrite> OwnWrites::judge(const std::vector<std::int64_t>& values) {
  std::optional<ForeignWrite> found;
  bool is_restart = true;
  for (std::size_t i = 0; i < registers_.size(); ++i) {
    const Possible own = std::exchange(possible_[i], {values[i]});
    if (own.empty()) continue;
    if (contains(own, values[i])) {
      possible_[i] = own;
      is_restart = false;
      continue;
    }
    is_restart = is_restart && values[i] == 0;
    if (found) continue;
    found = ForeignWrite{"'" + registers_[i].name + "' reads " + std::to_string(values[i]) + ", and fvd wrote " +
                         std::to_string(own.back())};
  }
  if (found) found->is_restart = is_restart;
  return found;
}

}  // namespace fvd
