#include "daemon/events/topic.hpp"

#include <utility>

namespace fvd {

bool Topic::take(TopicDocument document, HostTime now) {
  newest_ = document.text;
  const bool is_first = !told_;
  if (!is_first) {
    if (document.compared == told_->compared) return false;
    if (document.urgent == told_->urgent && now - told_at_ < patience_) return false;
  }
  told_ = std::move(document);
  told_at_ = now;
  return !is_first;
}

}  // namespace fvd
