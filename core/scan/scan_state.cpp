#include "core/scan/scan_state.hpp"

namespace fvd {

std::string_view scan_state_name(ScanState state) noexcept {
  switch (state) {
    case ScanState::kPreoperational:
      return "preoperational";
    case ScanState::kInitialized:
      return "initialized";
    case ScanState::kReady:
      return "ready";
    case ScanState::kExecuting:
      return "executing";
    case ScanState::kError:
      return "error";
    case ScanState::kHalted:
      return "halted";
  }
  return "error";
}

}  // namespace fvd
