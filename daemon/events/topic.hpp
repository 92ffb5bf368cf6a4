#pragma once

/// One document that readers are told of whenever it changed.

#include <chrono>
#include <optional>
#include <string>

#include "core/base/clock.hpp"

namespace fvd {

struct TopicDocument {
  std::string text;      ///< as it is told
  std::string compared;  ///< what makes it another one: without clocks, and what else changes by itself
  std::string urgent;    ///< what is told at once: without figures that change all the time
};

/// context: one thread at a time.
class Topic {
 public:
  /// patience: between two tellings of which the second says nothing urgent.
  explicit Topic(std::chrono::milliseconds patience) : patience_(patience) {}

  /// Keeps the newest document. True if it is to be told now: it is another one than what was told last, and urgent or
  /// awaited long enough. The first is not: whoever begins to read is told it.
  [[nodiscard]] bool take(TopicDocument document, HostTime now);
  /// Of the newest document; "null" before the first.
  [[nodiscard]] const std::string& text() const noexcept { return newest_; }

 private:
  const std::chrono::milliseconds patience_;
  std::string newest_ = "null";
  std::optional<TopicDocument> told_;
  HostTime told_at_{};
};

}  // namespace fvd
