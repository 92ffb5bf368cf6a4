#include "daemon/events/event_resource.hpp"

#include <chrono>
#include <map>
#include <utility>

#include "core/base/mutex.hpp"
#include "daemon/transport/http_refusal.hpp"

namespace fvd {

namespace {

constexpr std::chrono::seconds kPingPeriod{15};

ResourceAnswer refused(HttpRefusal refusal) {
  ResourceAnswer answer;
  answer.status = refusal.status;
  answer.fields = {{"Content-Type", "application/json"}};
  if (refusal.status == 503) answer.fields.emplace_back("Retry-After", "5");
  answer.body = refusal.body();
  return answer;
}

}  // namespace

/// How many streams each address has, and those who came without a token. context: thread-safe.
class EventResource::Places {
 public:
  /// False: there are too many.
  [[nodiscard]] bool take(const std::string& address, bool has_token) {
    const MutexLock lock(mutex_);
    if (all_ == kMost || (!has_token && without_token_ == kMostWithoutToken)) return false;
    std::size_t& taken = of_address_[address];
    if (taken == kMostOfAddress) return false;
    ++taken;
    ++all_;
    if (!has_token) ++without_token_;
    return true;
  }
  void give_back(const std::string& address, bool has_token) {
    const MutexLock lock(mutex_);
    --all_;
    if (!has_token) --without_token_;
    if (--of_address_[address] == 0) of_address_.erase(address);
  }

 private:
  Mutex mutex_;
  std::map<std::string, std::size_t> of_address_ FVD_GUARDED_BY(mutex_);
  std::size_t all_ FVD_GUARDED_BY(mutex_) = 0;
  std::size_t without_token_ FVD_GUARDED_BY(mutex_) = 0;
};

/// One reader.
class EventResource::Stream final : public StreamSource {
 public:
  Stream(EventHub& hub, std::shared_ptr<Places> places, const ResourceRequest& request)
      : hub_(hub),
        places_(std::move(places)),
        address_(request.address),
        has_token_(request.has_token),
        told_(hub.begin(request.last_event_id)) {}
  ~Stream() override {
    hub_.on_events({}, this);
    places_->give_back(address_, has_token_);
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  std::string next() override {
    if (told_.text.empty()) told_ = hub_.after(told_.place);
    return std::exchange(told_.text, {});
  }
  [[nodiscard]] std::string ping() const override { return event_text({}, "ping", "{}"); }
  [[nodiscard]] std::chrono::milliseconds ping_period() const override { return kPingPeriod; }
  void on_ready(std::function<void()> ready) override { hub_.on_events(std::move(ready), this); }

 private:
  EventHub& hub_;
  const std::shared_ptr<Places> places_;
  const std::string address_;
  const bool has_token_;
  EventHub::Told told_;  // its text is still to be given
};

EventResource::EventResource(EventHub& hub) : hub_(hub), places_(std::make_shared<Places>()) {}
EventResource::~EventResource() = default;

ResourceAnswer EventResource::get(const ResourceRequest& request) {
  if (request.path != kPath) {
    return refused({404, "not_found", std::string("there is nothing here; events are at ") + kPath});
  }
  ResourceAnswer answer;
  // A proxy that collects what it passes on would hold events back.
  answer.fields = {{"Content-Type", "text/event-stream"}, {"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}};
  if (request.is_head) {
    answer.is_endless = true;
    return answer;
  }
  if (!places_->take(request.address, request.has_token)) {
    return refused({503, "too_many_streams",
                    "an address may have " + std::to_string(kMostOfAddress) + " streams of events, all " +
                        std::to_string(kMost) + ", those without a token " + std::to_string(kMostWithoutToken) +
                        "; close a page, or send a token"});
  }
  answer.stream = std::make_unique<Stream>(hub_, places_, request);
  return answer;
}

}  // namespace fvd
