#include "core/runtime/worker_pool.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include <pthread.h>

namespace fvd {

struct WorkerPool::Impl {
  std::mutex mutex;
  std::condition_variable_any work_arrived;
  std::condition_variable work_done;
  const std::function<void(int)>* body = nullptr;  // this and all below: guarded by mutex
  int next = 0;
  int count = 0;
  int running = 0;
  std::exception_ptr failure;
  std::vector<std::jthread> threads;  // last: they use everything above

  /// Runs indices until none is left; the lock is held on entry and exit.
  void work(std::unique_lock<std::mutex>& lock) {
    while (body != nullptr && next < count) {
      const int index = next++;
      const auto& task = *body;
      ++running;
      lock.unlock();
      std::exception_ptr thrown;
      try {
        task(index);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      --running;
      if (thrown) {
        if (!failure) failure = thrown;
        next = count;
      }
    }
    if (running == 0) work_done.notify_all();
  }

  void serve(std::stop_token stop) {
    std::unique_lock lock(mutex);
    while (work_arrived.wait(lock, stop, [this] { return body != nullptr && next < count; })) work(lock);
  }
};

WorkerPool::WorkerPool(int threads) : impl_(std::make_unique<Impl>()) {
  for (int i = 1; i < threads; ++i) {
    impl_->threads.emplace_back([impl = impl_.get()](std::stop_token stop) { impl->serve(stop); });
    pthread_setname_np(impl_->threads.back().native_handle(), "fvd-worker");
  }
}

WorkerPool::~WorkerPool() = default;

int WorkerPool::threads() const noexcept { return static_cast<int>(impl_->threads.size()) + 1; }

void WorkerPool::run(int count, const std::function<void(int)>& body) {
  std::unique_lock lock(impl_->mutex);
  impl_->body = &body;
  impl_->next = 0;
  impl_->count = count;
  impl_->failure = nullptr;
  if (count > 1) impl_->work_arrived.notify_all();
  impl_->work(lock);
  impl_->work_done.wait(lock, [this] { return impl_->running == 0 && impl_->next >= impl_->count; });
  impl_->body = nullptr;
  if (auto failure = std::exchange(impl_->failure, nullptr)) std::rethrow_exception(failure);
}

}  // namespace fvd
