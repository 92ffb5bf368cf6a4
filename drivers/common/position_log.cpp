#include "drivers/common/position_log.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace fvd {

void PositionLog::add(const AxisSample& sample) {
  ring_[next_] = sample;
  next_ = (next_ + 1) % ring_.size();
  count_ = std::min(count_ + 1, ring_.size());
}

const AxisSample& PositionLog::at(std::size_t age) const {
  return ring_[(next_ + ring_.size() - 1 - age) % ring_.size()];
}

std::optional<AxisSample> PositionLog::latest() const {
  if (count_ == 0) return std::nullopt;
  return at(0);
}

PositionMean PositionLog::mean(HostTime from, HostTime to) const {
  assert(count_ > 0);
  PositionMean result;
  double sum = 0.0;
  double squares = 0.0;
  const double reference = at(0).position.value;  // differences to it keep the squares small
  const AxisSample* after = nullptr;
  const AxisSample* before = nullptr;
  for (std::size_t age = 0; age < count_ && before == nullptr; ++age) {
    const AxisSample& sample = at(age);
    if (sample.time > to) {
      after = &sample;
    } else if (sample.time < from) {
      before = &sample;
    } else {
      const double difference = sample.position.value - reference;
      sum += difference;
      squares += difference * difference;
      ++result.samples;
    }
  }
  if (result.samples > 0) {
    const double mean = sum / result.samples;
    result.mean = Micrometers{reference + mean};
    if (result.samples > 1) {
      result.sd =
          Micrometers{std::sqrt(std::max(0.0, (squares - result.samples * mean * mean) / (result.samples - 1)))};
    }
    return result;
  }
  if (after == nullptr || before == nullptr) {
    result.mean = (after != nullptr ? after : before)->position;
    return result;
  }
  const auto seconds = [](HostClock::duration d) { return std::chrono::duration<double>(d).count(); };
  const double fraction = seconds(from + (to - from) / 2 - before->time) / seconds(after->time - before->time);
  result.mean = before->position + (after->position - before->position) * fraction;
  return result;
}

PositionMean PositionLog::line(HostTime at, std::chrono::microseconds reach) const {
  assert(count_ > 0);
  // Differences to the moment and to the newest position keep the squares small.
  const double reference = this->at(0).position.value;
  double n = 0.0;
  double t = 0.0;
  double z = 0.0;
  double tt = 0.0;
  double tz = 0.0;
  double zz = 0.0;
  for (std::size_t age = 0; age < count_; ++age) {
    const AxisSample& sample = this->at(age);
    if (sample.time > at + reach) continue;
    if (sample.time < at - reach) break;
    const double seconds = std::chrono::duration<double>(sample.time - at).count();
    const double um = sample.position.value - reference;
    n += 1.0;
    t += seconds;
    z += um;
    tt += seconds * seconds;
    tz += seconds * um;
    zz += um * um;
  }
  const double spread = n * tt - t * t;
  if (n < 2.0 || spread <= 0.0) {
    PositionMean result = mean(at, at);
    result.samples = 0;
    return result;
  }
  const double slope = (n * tz - t * z) / spread;
  const double offset = (z - slope * t) / n;
  PositionMean result;
  result.mean = Micrometers{reference + offset};
  result.samples = static_cast<int>(n);
  if (n > 2.0) result.sd = Micrometers{std::sqrt(std::max(0.0, (zz - offset * z - slope * tz) / (n - 2.0)))};
  return result;
}

}  // namespace fvd
