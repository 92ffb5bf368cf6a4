#pragma once

/// The newest events, with ids by which a reader that was away finds its place again.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace fvd {

/// An event as a stream of text/event-stream has it. id: empty = none. data: without line breaks.
[[nodiscard]] std::string event_text(std::string_view id, std::string_view name, std::string_view data);

/// Events are numbered from 1. An id is "EPOCH-NUMBER": one of before a restart is known as such.
/// context: one thread at a time.
class EventRing {
 public:
  struct Limits {
    std::size_t events = 10'000;
    std::size_t bytes = std::size_t{16} << 20U;  ///< of their texts; the newest stays in any case
  };
  /// epoch: counts the daemon's starts.
  explicit EventRing(std::int64_t epoch) : EventRing(epoch, Limits{}) {}
  EventRing(std::int64_t epoch, const Limits& limits) : epoch_(epoch), limits_(limits) {}

  /// The oldest give way.
  void add(std::string_view name, std::string_view data);

  /// The newest event's number; 0 = there was none yet.
  [[nodiscard]] std::uint64_t newest() const noexcept { return newest_; }
  [[nodiscard]] std::string id_of(std::uint64_t number) const;
  /// The number that an id stands for, if the ring has every event after it; nothing for any other text.
  [[nodiscard]] std::optional<std::uint64_t> place_of(std::string_view id) const;
  /// So many of the events after that number are gone.
  [[nodiscard]] std::uint64_t missing_after(std::uint64_t number) const noexcept;

  struct Texts {
    std::string text;
    std::uint64_t last = 0;  ///< number of the last event in it
  };
  /// The events after that number, which the ring has, as far as they fit; the first of them in any case. Empty without
  /// one.
  [[nodiscard]] Texts after(std::uint64_t number, std::size_t most_bytes) const;

 private:
  [[nodiscard]] std::uint64_t oldest() const noexcept { return newest_ - texts_.size() + 1; }

  const std::int64_t epoch_;
  const Limits limits_;
  std::deque<std::string> texts_;  // of the events oldest() to newest_
  std::size_t bytes_ = 0;          // of texts_
  std::uint64_t newest_ = 0;
};

}  // namespace fvd
