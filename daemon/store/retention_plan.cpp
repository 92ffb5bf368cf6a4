#include "daemon/store/retention_plan.hpp"

namespace fvd {

namespace {

/// What results take and the disk has, as results go.
class Room {
 public:
  Room(const std::vector<KeptResult>& results, const RetentionLimits& limits, std::uint64_t free_bytes)
      : limits_(limits), free_(free_bytes) {
    for (const KeptResult& result : results) taken_ += result.bytes;
  }
  [[nodiscard]] bool suffices() const {
    return (!limits_.most_bytes || taken_ <= *limits_.most_bytes) &&
           (!limits_.least_free_bytes || free_ >= *limits_.least_free_bytes);
  }
  void give(std::uint64_t bytes) {
    taken_ -= bytes;
    free_ += bytes;
  }

 private:
  const RetentionLimits& limits_;
  std::uint64_t taken_ = 0;
  std::uint64_t free_;
};

}  // namespace

std::vector<RetentionStep> retention_plan(const std::vector<KeptResult>& results, const RetentionLimits& limits,
                                          std::uint64_t free_bytes) {
  std::vector<RetentionStep> steps;
  Room room(results, limits, free_bytes);
  std::vector<std::uint64_t> left(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const bool too_old = limits.longest_s && results[i].age_s > *limits.longest_s;
    left[i] = results[i].removable ? results[i].bytes : 0;
    if (!results[i].removable || !too_old) continue;
    steps.push_back({i, false});
    room.give(left[i]);
    left[i] = 0;
  }
  for (std::size_t i = 0; i < results.size() && !room.suffices(); ++i) {
    if (left[i] == 0 || results[i].slices_bytes == 0) continue;
    steps.push_back({i, true});
    room.give(results[i].slices_bytes);
    left[i] -= results[i].slices_bytes;
  }
  for (std::size_t i = 0; i < results.size() && !room.suffices(); ++i) {
    if (left[i] == 0) continue;
    steps.push_back({i, false});
    room.give(left[i]);
    left[i] = 0;
  }
  return steps;
}

}  // namespace fvd
