#pragma once

/// Resources and bodies as a test wants them.

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "core/base/mutex.hpp"
#include "daemon/transport/http_resource.hpp"

namespace fvd::test {

/// Answers as its function says.
class FakeResource final : public HttpResource {
 public:
  using Get = std::function<ResourceAnswer(const ResourceRequest&)>;
  explicit FakeResource(Get get, bool needs_view = true) : get_(std::move(get)), needs_view_(needs_view) {}

  [[nodiscard]] bool needs_view() const override { return needs_view_; }
  [[nodiscard]] ResourceAnswer get(const ResourceRequest& request) override {
    ++asked;
    return get_(request);
  }
  std::atomic<int> asked{0};

 private:
  Get get_;
  bool needs_view_;
};

inline ResourceAnswer text_answer(std::string body, std::string etag = {}) {
  ResourceAnswer answer;
  answer.fields = {{"Content-Type", "text/plain"}};
  if (!etag.empty()) answer.fields.emplace_back("ETag", std::move(etag));
  answer.body = std::move(body);
  return answer;
}

/// Pieces of one letter each.
class FakeBody final : public BodySource {
 public:
  struct Counts {
    std::atomic<int> made{0};   ///< pieces
    std::atomic<int> alive{0};  ///< bodies
  };
  FakeBody(Counts& counts, std::size_t piece_bytes, int pieces)
      : counts_(counts), piece_bytes_(piece_bytes), pieces_(pieces) {
    ++counts_.alive;
  }
  ~FakeBody() override { --counts_.alive; }
  FakeBody(const FakeBody&) = delete;
  FakeBody& operator=(const FakeBody&) = delete;

  std::string next() override {
    if (made_ == pieces_) return {};
    ++counts_.made;
    return std::string(piece_bytes_, static_cast<char>('a' + made_++ % 26));
  }

 private:
  Counts& counts_;
  const std::size_t piece_bytes_;
  const int pieces_;
  int made_ = 0;
};

/// What all readers of a FakeStream are given, while the test lives.
class FakeNews {
 public:
  /// Gives one more text, to every reader.
  void add(const std::string& text) {
    const MutexLock lock(mutex_);
    text_ += text;
    for (const auto& [whose, ready] : ready_) ready();
  }
  [[nodiscard]] std::string after(std::size_t place) {
    const MutexLock lock(mutex_);
    return text_.substr(place);
  }
  void on_ready(std::function<void()> ready, const void* whose) {
    const MutexLock lock(mutex_);
    ready_.erase(whose);
    if (ready) ready_[whose] = std::move(ready);
  }
  std::atomic<int> readers{0};

 private:
  Mutex mutex_;
  std::string text_ FVD_GUARDED_BY(mutex_);
  std::map<const void*, std::function<void()>> ready_ FVD_GUARDED_BY(mutex_);
};

class FakeStream final : public StreamSource {
 public:
  FakeStream(FakeNews& news, std::chrono::milliseconds ping) : news_(news), ping_(ping) { ++news_.readers; }
  ~FakeStream() override {
    news_.on_ready({}, this);
    --news_.readers;
  }
  FakeStream(const FakeStream&) = delete;
  FakeStream& operator=(const FakeStream&) = delete;

  std::string next() override {
    std::string text = news_.after(place_);
    place_ += text.size();
    return text;
  }
  [[nodiscard]] std::string ping() const override { return "ping\n"; }
  [[nodiscard]] std::chrono::milliseconds ping_period() const override { return ping_; }
  void on_ready(std::function<void()> ready) override { news_.on_ready(std::move(ready), this); }

 private:
  FakeNews& news_;
  const std::chrono::milliseconds ping_;
  std::size_t place_ = 0;
};

}  // namespace fvd::test
