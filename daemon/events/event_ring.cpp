#include "daemon/events/event_ring.hpp"

#include <charconv>

namespace fvd {

std::string event_text(std::string_view id, std::string_view name, std::string_view data) {
  std::string text;
  if (!id.empty()) text.append("id: ").append(id).append("\n");
  return text.append("event: ").append(name).append("\ndata: ").append(data).append("\n\n");
}

void EventRing::add(std::string_view name, std::string_view data) {
  ++newest_;
  texts_.push_back(event_text(id_of(newest_), name, data));
  bytes_ += texts_.back().size();
  while (texts_.size() > limits_.events || (bytes_ > limits_.bytes && texts_.size() > 1)) {
    bytes_ -= texts_.front().size();
    texts_.pop_front();
  }
}

std::string EventRing::id_of(std::uint64_t number) const {
  return std::to_string(epoch_) + "-" + std::to_string(number);
}

std::optional<std::uint64_t> EventRing::place_of(std::string_view id) const {
  const std::string_view digits = id.substr(id.rfind('-') + 1);  // of the whole text without one
  std::uint64_t number = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (read.ec != std::errc() || id_of(number) != id) return std::nullopt;
  if (number > newest_ || missing_after(number) > 0) return std::nullopt;
  return number;
}

std::uint64_t EventRing::missing_after(std::uint64_t number) const noexcept {
  return number + 1 < oldest() ? oldest() - number - 1 : 0;
}

EventRing::Texts EventRing::after(std::uint64_t number, std::size_t most_bytes) const {
  Texts texts{{}, number};
  for (std::uint64_t next = number + 1; next <= newest_; ++next) {
    const std::string& text = texts_[static_cast<std::size_t>(next - oldest())];
    if (!texts.text.empty() && texts.text.size() + text.size() > most_bytes) break;
    texts.text += text;
    texts.last = next;
  }
  return texts;
}

}  // namespace fvd
