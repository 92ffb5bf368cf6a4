#include "drivers/modbus/drive_register.hpp"

#include <cstdlib>
#include <utility>

namespace fvd {

bool holds(const DriveRegister& reg, std::int64_t value) noexcept {
  constexpr std::int64_t kMostBase1000 = 32767 * 1000LL + 999;
  if (reg.codec == RegisterCodec::kBase1000) return std::abs(value) <= kMostBase1000;
  switch (reg.type) {
    case RegisterType::kBit:
      return value == 0 || value == 1;
    case RegisterType::kU16:
      return value >= 0 && value <= 0xFFFF;
    case RegisterType::kI16:
      return value >= -0x8000 && value <= 0x7FFF;
    case RegisterType::kU32:
      return value >= 0 && value <= 0xFFFFFFFFLL;
    case RegisterType::kI32:
      return value >= -0x80000000LL && value <= 0x7FFFFFFFLL;
  }
  return false;
}

std::vector<std::uint16_t> encode(const DriveRegister& reg, std::int64_t value) {
  if (reg.type == RegisterType::kBit) return {static_cast<std::uint16_t>(value != 0 ? 1 : 0)};
  std::uint16_t low = 0;
  std::uint16_t high = 0;
  if (reg.codec == RegisterCodec::kBase1000) {
    low = static_cast<std::uint16_t>(value % 1000);
    high = static_cast<std::uint16_t>(value / 1000);
  } else {
    const auto bits = static_cast<std::uint32_t>(value);
    low = static_cast<std::uint16_t>(bits & 0xFFFFU);
    high = static_cast<std::uint16_t>(bits >> 16U);
  }
  if (reg.words() == 1) return {low};
  if (reg.order == WordOrder::kHighFirst) return {high, low};
  return {low, high};
}

std::int64_t decode(const DriveRegister& reg, const std::uint16_t* words) {
  if (reg.words() == 1) return reg.type == RegisterType::kI16 ? static_cast<std::int16_t>(words[0]) : words[0];
  const bool high_first = reg.order == WordOrder::kHighFirst;
  const std::uint16_t high = words[high_first ? 0 : 1];
  const std::uint16_t low = words[high_first ? 1 : 0];
  if (reg.codec == RegisterCodec::kBase1000) {
    return std::int64_t{1000} * static_cast<std::int16_t>(high) + static_cast<std::int16_t>(low);
  }
  const std::uint32_t bits = (std::uint32_t{high} << 16U) | low;
  return reg.type == RegisterType::kI32 ? static_cast<std::int32_t>(bits) : std::int64_t{bits};
}

void RegisterImage::add(const PollBlock& block, std::vector<std::uint16_t> words) {
  parts_.push_back({block, std::move(words)});
}

std::optional<std::int64_t> RegisterImage::value(const DriveRegister& reg) const {
  for (const Part& part : parts_) {
    if (part.block.holds(reg)) return decode(reg, part.words.data() + (reg.address - part.block.address));
  }
  return std::nullopt;
}

DriveCondition DriveCondition::compare(DriveRegister reg, std::uint32_t mask, std::uint32_t number, bool equals) {
  DriveCondition condition;
  condition.kind_ = equals ? Kind::kEquals : Kind::kDiffers;
  condition.reg_ = std::move(reg);
  condition.mask_ = mask;
  condition.number_ = number;
  return condition;
}

DriveCondition DriveCondition::combine(Kind kind, std::vector<DriveCondition> parts) {
  DriveCondition condition;
  condition.kind_ = kind;
  condition.parts_ = std::move(parts);
  return condition;
}

std::optional<bool> DriveCondition::holds(const Lookup& lookup) const {
  if (kind_ == Kind::kEquals || kind_ == Kind::kDiffers) {
    const auto value = lookup(reg_);
    if (!value) return std::nullopt;
    const bool equal = (static_cast<std::uint32_t>(*value) & mask_) == number_;
    return equal == (kind_ == Kind::kEquals);
  }
  const bool until = kind_ == Kind::kAny;  // the answer of one part that decides for all
  for (const DriveCondition& part : parts_) {
    const auto holds = part.holds(lookup);
    if (!holds) return std::nullopt;
    if (kind_ == Kind::kNot) return !*holds;
    if (*holds == until) return until;
  }
  return !until;
}

std::vector<DriveRegister> DriveCondition::registers() const {
  if (kind_ == Kind::kEquals || kind_ == Kind::kDiffers) return {reg_};
  std::vector<DriveRegister> all;
  for (const DriveCondition& part : parts_) {
    for (DriveRegister& reg : part.registers()) all.push_back(std::move(reg));
  }
  return all;
}

}  // namespace fvd
