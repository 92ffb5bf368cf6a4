#pragma once

/// A fixed set of threads that share out the indices of a loop.

#include <functional>
#include <memory>

namespace fvd {

/// context: thread-safe; a body may itself call run().
class WorkerPool {
 public:
  /// threads >= 1 in all, the caller's included: WorkerPool(1) runs everything in the caller.
  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  [[nodiscard]] int threads() const noexcept;

  /// Calls body(index) once for every index in [0, count), in any order, on any thread; returns when all are done.
  /// The first exception a body throws is rethrown here, after all running bodies ended; indices not begun by then are
  /// left out. Allocates nothing; a lambda with many captures is passed as std::ref(lambda), or its copy is allocated.
  void run(int count, const std::function<void(int)>& body);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
