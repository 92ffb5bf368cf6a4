#include "daemon/jobs/alarm_log.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

namespace {

constexpr std::string_view kCut = "...";

/// What goes first where too many are kept.
int rank(const Alarm& alarm) { return alarm.acknowledged ? 0 : 1 + static_cast<int>(alarm.level); }

/// Of the character that begins there; 0 = none does. What would be another spelling of a shorter one, half of a pair,
/// or beyond the last character, is none.
std::size_t character_bytes(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : std::uint8_t{0};
  };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  const std::size_t size = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  const unsigned second = byte(1);
  const bool is_another_spelling = (first == 0xE0U && second < 0xA0U) || (first == 0xF0U && second < 0x90U);
  const bool is_no_character = (first == 0xEDU && second > 0x9FU) || (first == 0xF4U && second > 0x8FU);
  return is_another_spelling || is_no_character ? 0 : size;
}

/// Whole characters.
std::string readable(std::string_view text, std::size_t most_bytes) {
  std::string told;
  std::size_t uncut = 0;  // bytes of `told` behind which there is room for the dots
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character_bytes(text, at);
    told += size == 0 ? std::string_view("?") : text.substr(at, size);
    at += std::max<std::size_t>(1, size);
    if (told.size() + kCut.size() <= most_bytes) uncut = told.size();
    if (told.size() > most_bytes) return told.substr(0, uncut).append(kCut);
  }
  return told;
}

}  // namespace

void AlarmLog::note(AlarmLevel level, std::string_view text, std::chrono::system_clock::time_point time) {
  Alarm alarm;
  alarm.level = level;
  alarm.text = readable(text, kLongestText_bytes);
  alarm.time_utc = utc_text(time);
  alarm.last_utc = alarm.time_utc;
  const MutexLock lock(mutex_);
  ++revision_;
  const auto same = std::find_if(kept_.rbegin(), kept_.rend(), [&](const Kept& kept) {
    return !kept.alarm.acknowledged && kept.alarm.level == level && time - kept.last < kRepeatTime &&
           kept.alarm.text == alarm.text;
  });
  if (same != kept_.rend()) {
    ++same->alarm.count;
    same->alarm.last_utc = alarm.last_utc;
    same->last = time;
    return;
  }
  alarm.number = ++newest_number_;
  kept_.push_back({std::move(alarm), time});
  if (kept_.size() <= kMostKept) return;
  kept_.erase(std::min_element(kept_.begin(), kept_.end(),
                               [](const Kept& a, const Kept& b) { return rank(a.alarm) < rank(b.alarm); }));
}

std::vector<Alarm> AlarmLog::newest() const {
  const MutexLock lock(mutex_);
  std::vector<Alarm> alarms;
  alarms.reserve(kept_.size());
  for (auto kept = kept_.rbegin(); kept != kept_.rend(); ++kept) alarms.push_back(kept->alarm);
  return alarms;
}

void AlarmLog::acknowledge(std::int64_t number, std::string_view time_utc) {
  const MutexLock lock(mutex_);
  const auto found =
      std::find_if(kept_.begin(), kept_.end(), [number](const Kept& kept) { return kept.alarm.number == number; });
  if (found == kept_.end()) {
    throw Error(ErrorCode::kBadInput, "there is no alarm " + std::to_string(number) + ": alarm.list tells the " +
                                          std::to_string(kMostKept) + " at most that are kept");
  }
  if (!time_utc.empty() && time_utc != found->alarm.time_utc) {
    throw Error(ErrorCode::kBadInput, "alarm " + std::to_string(number) + " is of " + found->alarm.time_utc +
                                          ", not of the time_utc that was given: fvd was started again, and numbers "
                                          "with it; ask alarm.list, and acknowledge what it tells now");
  }
  if (found->alarm.acknowledged) return;
  found->alarm.acknowledged = true;
  ++revision_;
}

}  // namespace fvd
