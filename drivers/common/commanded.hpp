#pragma once

/// What an axis is told to do, for as long as it is.

#include <atomic>

#include "core/hw/axis.hpp"

namespace fvd {

/// Sets the state while it lives; kReady after that. context: one thread; the state may be read on any.
class Commanded {
 public:
  Commanded(std::atomic<AxisState>& state, AxisState now) : state_(state) { state_ = now; }
  ~Commanded() { state_ = AxisState::kReady; }
  Commanded(const Commanded&) = delete;
  Commanded& operator=(const Commanded&) = delete;

 private:
  std::atomic<AxisState>& state_;
};

}  // namespace fvd
