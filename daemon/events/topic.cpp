#include "daemon/events/topic.hpp"

#include <utility>

namespace fvd {

bool Topic::take(TopicDocument document, HostTime now) {
  newest_ = std::move(document);
  if (!told_) {
    told_ = newest_;
    told_at_ = now;
    return false;
  }
  if (!owes()) return false;
  if (newest_.urgent == told_->urgent && now - told_at_ < patience_) return false;
  told_ = newest_;
  told_at_ = now;
  has_shown_another_ = false;
  return true;
}

bool Topic::owes() const { return told_ && (has_shown_another_ || newest_.compared != told_->compared); }

const std::string& Topic::show() {
  has_shown_another_ = has_shown_another_ || owes();
  return newest_.text;
}

}  // namespace fvd
