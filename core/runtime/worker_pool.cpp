#include "core/runtime/worker_pool.hpp"

#include <algorithm>
#include <exception>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"

namespace fvd {

struct WorkerPool::Impl {
  Mutex mutex;
  Condition work_arrived;
  Condition work_done;
  const std::function<void(int)>* body FVD_GUARDED_BY(mutex) = nullptr;
  int next FVD_GUARDED_BY(mutex) = 0;
  int count FVD_GUARDED_BY(mutex) = 0;
  int running FVD_GUARDED_BY(mutex) = 0;
  std::exception_ptr failure FVD_GUARDED_BY(mutex);
  std::vector<std::jthread> threads;  // last: they use everything above

  /// Runs indices until none is left; lets go of the mutex for each.
  void work() FVD_REQUIRES(mutex) {
    while (body != nullptr && next < count) {
      const int index = next++;
      const auto& task = *body;
      ++running;
      mutex.unlock();
      std::exception_ptr thrown;
      try {
        task(index);
      } catch (...) {
        thrown = std::current_exception();
      }
      mutex.lock();
      --running;
      if (thrown) {
        if (!failure) failure = thrown;
        next = count;
      }
    }
    if (running == 0) work_done.notify_all();
  }

  void serve(std::stop_token stop) {
    MutexLock lock(mutex);
    const auto due = [this] {
      mutex.assert_held();
      return body != nullptr && next < count;
    };
    while (work_arrived.wait(lock, stop, due)) work();
  }
};

WorkerPool::WorkerPool(int threads) : impl_(std::make_unique<Impl>()) {
  for (int i = 1; i < threads; ++i) {
    impl_->threads.push_back(
        start_thread("fvd-worker", [impl = impl_.get()](std::stop_token stop) { impl->serve(stop); }));
  }
}

WorkerPool::~WorkerPool() = default;

int WorkerPool::threads() const noexcept { return static_cast<int>(impl_->threads.size()) + 1; }

void WorkerPool::run(int count, const std::function<void(int)>& body) {
  MutexLock lock(impl_->mutex);
  impl_->body = &body;
  impl_->next = 0;
  impl_->count = count;
  impl_->failure = nullptr;
  if (count > 1) impl_->work_arrived.notify_all();
  impl_->work();
  impl_->work_done.wait(lock, [this] {
    impl_->mutex.assert_held();
    return impl_->running == 0 && impl_->next >= impl_->count;
  });
  impl_->body = nullptr;
  if (auto failure = std::exchange(impl_->failure, nullptr)) std::rethrow_exception(failure);
}

}  // namespace fvd
