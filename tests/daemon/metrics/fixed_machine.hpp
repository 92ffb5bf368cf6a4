#pragma once

/// A machine whose status a test sets.

#include <memory>

#include "daemon/jobs/services.hpp"

namespace fvd::test {

class FixedMachine final : public MachineView {
 public:
  [[nodiscard]] std::shared_ptr<const MachineStatus> snapshot() const override {
    return std::make_shared<const MachineStatus>(status);
  }
  [[nodiscard]] bool stage_stands() const override { return status.signals.part_release; }
  void on_change(std::function<void()> /*listener*/, const void* /*whose*/) override {}

  MachineStatus status;
};

}  // namespace fvd::test
