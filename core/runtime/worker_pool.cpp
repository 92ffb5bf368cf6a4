#include "core/runtime/worker_pool.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <exception>
#include <stop_token>
#include <thread>
#include <vector>

#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"

namespace fvd {

namespace {

/// Of one index; the longest are whole exporters.
constexpr std::chrono::minutes kLongestIndex{10};

/// One call of run(), in the frame of its caller. Everything is guarded by the pool's mutex.
struct Loop {
  const std::function<void(int)>& body;
  int count = 0;
  Loop* older = nullptr;  ///< the loop that was begun before it
  int next = 0;
  int running = 0;
  std::exception_ptr failure = nullptr;

  [[nodiscard]] bool has_more() const { return next < count; }
  [[nodiscard]] bool is_done() const { return !has_more() && running == 0; }
};

}  // namespace

struct WorkerPool::Impl {
  Mutex mutex;
  Condition work_arrived;
  Condition work_done;
  Loop* newest FVD_GUARDED_BY(mutex) = nullptr;  // of those that are not done, linked by age
  std::deque<ThreadTicks> ticks;                 // one a thread, made before it: a thread at work allocates nothing
  std::vector<std::jthread> threads;             // last: they use everything above

  /// Runs a loop's indices until none is left; lets go of the mutex for each.
  void work(Loop& loop, ThreadTicks* own_ticks) FVD_REQUIRES(mutex) {
    while (loop.has_more()) {
      const int index = loop.next++;
      ++loop.running;
      mutex.unlock();
      if (own_ticks != nullptr) own_ticks->tick(HostClock::now());
      std::exception_ptr thrown;
      try {
        loop.body(index);
      } catch (...) {
        thrown = std::current_exception();
      }
      mutex.lock();
      --loop.running;
      if (thrown) {
        if (!loop.failure) loop.failure = thrown;
        loop.next = loop.count;
      }
    }
    if (loop.is_done()) work_done.notify_all();
  }

  /// The newest first: another loop's index waits for it.
  Loop* loop_with_more() const FVD_REQUIRES(mutex) {
    Loop* loop = newest;
    while (loop != nullptr && !loop->has_more()) loop = loop->older;
    return loop;
  }

  void take_out(const Loop& loop) FVD_REQUIRES(mutex) {
    Loop** link = &newest;
    while (*link != &loop) link = &(*link)->older;
    *link = loop.older;
  }

  void serve(ThreadTicks& own_ticks, std::stop_token stop) {
    MutexLock lock(mutex);
    const auto due = [this] {
      mutex.assert_held();
      return loop_with_more() != nullptr;
    };
    while (work_arrived.wait(lock, stop, due)) {
      work(*loop_with_more(), &own_ticks);
      own_ticks.rest();
    }
  }
};

WorkerPool::WorkerPool(int threads) : impl_(std::make_unique<Impl>()) {
  for (int i = 1; i < threads; ++i) {
    ThreadTicks& ticks = impl_->ticks.emplace_back("fvd-worker", kLongestIndex);
    impl_->threads.push_back(
        start_thread("fvd-worker", [impl = impl_.get(), &ticks](std::stop_token stop) { impl->serve(ticks, stop); }));
  }
}

WorkerPool::~WorkerPool() = default;

int WorkerPool::threads() const noexcept { return static_cast<int>(impl_->threads.size()) + 1; }

void WorkerPool::run(int count, const std::function<void(int)>& body) {
  MutexLock lock(impl_->mutex);
  Loop loop{body, count, impl_->newest};
  impl_->newest = &loop;
  if (count > 1) impl_->work_arrived.notify_all();
  impl_->work(loop, nullptr);  // the caller has ticks of its own
  impl_->work_done.wait(lock, [this, &loop] {
    impl_->mutex.assert_held();
    return loop.is_done();
  });
  impl_->take_out(loop);
  if (loop.failure) std::rethrow_exception(loop.failure);
}

}  // namespace fvd
