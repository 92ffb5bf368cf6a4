#include "daemon/metrics/metrics_page.hpp"

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <utility>

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <unistd.h>

#include "core/runtime/thread_ticks.hpp"
#include "daemon/api/rpc_errors.hpp"
#include "daemon/base/heap.hpp"
#include "daemon/base/version.hpp"
#include "daemon/jobs/machine_state.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMostTemperatures = 16;
constexpr double kSecondsPerMicrosecond = 1e-6;

using Labels = prometheus::Labels;

/// One page: a registry that is filled once.
class Page {
 public:
  void gauge(const std::string& name, const std::string& help, double value, const Labels& labels = {}) {
    prometheus::BuildGauge().Name(name).Help(help).Register(registry_).Add(labels).Set(value);
  }
  void counter(const std::string& name, const std::string& help, std::uint64_t value, const Labels& labels = {}) {
    prometheus::BuildCounter().Name(name).Help(help).Register(registry_).Add(labels).Increment(
        static_cast<double>(value));
  }
  /// One series for each value of the label.
  void counters(const std::string& name, const std::string& help, const std::string& label,
                std::initializer_list<std::pair<const char*, std::uint64_t>> values) {
    for (const auto& [value, count] : values) counter(name, help, count, {{label, value}});
  }
  [[nodiscard]] std::string text() const { return prometheus::TextSerializer().Serialize(registry_.Collect()); }

 private:
  // Several calls may name one family.
  prometheus::Registry registry_{prometheus::Registry::InsertBehavior::Merge};
};

void add_machine(Page& page, const MachineStatus& machine) {
  page.gauge("fvd_build_info", "1; the label tells the version", 1.0, {{"version", kVersion}});
  for (const ScanState state : {ScanState::kPreoperational, ScanState::kInitialized, ScanState::kReady,
                                ScanState::kExecuting, ScanState::kError, ScanState::kHalted}) {
    page.gauge("fvd_state", "1 for the state that the machine is in", state == machine.state ? 1.0 : 0.0,
               {{"state", std::string(scan_state_name(state))}});
  }
  page.gauge("fvd_error_code", "code of the error that keeps the machine from measuring; 0 = none",
             machine.error ? rpc_error(*machine.error).code : 0);
  page.gauge("fvd_simulated", "1 if a device is simulated", machine.simulated ? 1.0 : 0.0);
  page.gauge("fvd_epoch", "counts the daemon's starts", static_cast<double>(machine.epoch));
  page.gauge("fvd_results_unacknowledged", "results that nobody has acknowledged", machine.results_waiting);
  page.counters("fvd_jobs_total",
                "jobs that ended since the start; interrupted: of all starts, those that ran when a daemon ended",
                "outcome",
                {{"completed", machine.ended.completed},
                 {"aborted", machine.ended.aborted},
                 {"failed", machine.ended.failed},
                 {"interrupted", machine.ended.interrupted}});
  page.gauge("fvd_threads_stalled", "threads that have not ticked for longer than they may",
             static_cast<double>(stalled_threads(HostClock::now()).size()));
}

void add_devices(Page& page, const DevicesHealth& health) {
  for (const auto& [device, report] : {std::pair("camera", health.camera), std::pair("stage", health.stage)}) {
    page.gauge("fvd_device_open", "1 while the device is open", report.open ? 1.0 : 0.0, {{"device", device}});
    page.counter("fvd_device_openings_total", "how often it was opened: more than once, it was lost",
                 static_cast<std::uint64_t>(report.openings), {{"device", device}});
  }
  const CameraHealth& frames = health.frames;
  page.counters("fvd_camera_frames_total", "frames since the camera was opened", "status",
                {{"complete", frames.frames_complete},
                 {"failed", frames.frames_failed},
                 {"underrun", frames.underruns},
                 {"skipped", frames.ids_skipped}});
  page.counters("fvd_camera_packets_total", "packets that did not come at once", "kind",
                {{"resent", frames.packets_resent}, {"missing", frames.packets_missing}});
  const StageLinkStats link = health.link.value_or(StageLinkStats{});
  page.counter("fvd_stage_requests_total", "requests to the drive since it was opened", link.requests);
  page.counters("fvd_stage_request_errors_total", "requests to the drive that did not go well at once", "kind",
                {{"retried", link.retries},
                 {"unanswered", link.unanswered},
                 {"refused", link.refused},
                 {"put_off", link.put_off},
                 {"implausible", link.implausible}});
  page.counter("fvd_stage_reconnects_total", "how often the line to the drive was connected anew", link.reconnects);
  for (const auto& [quantile, latency_us] :
       {std::pair("0.5", link.latency_p50_us), std::pair("0.99", link.latency_p99_us),
        std::pair("1", link.latency_max_us)}) {
    page.gauge("fvd_stage_latency_seconds", "request to answer", latency_us * kSecondsPerMicrosecond,
               {{"quantile", quantile}});
  }
  for (std::size_t i = 0; i < std::min(health.temperatures.size(), kMostTemperatures); ++i) {
    page.gauge("fvd_temperature_celsius", "that the device tells", health.temperatures[i].celsius,
               {{"device", "stage"}, {"sensor", health.temperatures[i].name}});
  }
}

void add_system(Page& page, const MachineStatus& machine) {
  if (machine.disk) {
    page.gauge("fvd_storage_free_bytes", "of the file system of the results",
               static_cast<double>(machine.disk->free_bytes));
    page.gauge("fvd_storage_size_bytes", "of the file system of the results",
               static_cast<double>(machine.disk->size_bytes));
  }
  std::ifstream statm("/proc/self/statm");
  std::uint64_t virtual_pages = 0;
  std::uint64_t resident_pages = 0;
  if (statm >> virtual_pages >> resident_pages) {
    page.gauge("process_resident_memory_bytes", "memory in use",
               static_cast<double>(resident_pages) * static_cast<double>(::sysconf(_SC_PAGESIZE)));
  }
  const HeapUse heap = heap_use();
  page.gauge("fvd_heap_in_use_bytes", "taken and not freed, without large images; a leak makes it rise without end",
             static_cast<double>(heap.in_use_bytes));
  page.gauge("fvd_heap_held_bytes", "that in use, and what the heap keeps for what is taken next",
             static_cast<double>(heap.held_bytes));
}

}  // namespace

std::string metrics_text(const MachineStatus& machine) {
  Page page;
  add_machine(page, machine);
  add_devices(page, machine.health);
  add_system(page, machine);
  return page.text();
}

std::optional<std::string> why_unhealthy(const MachineStatus& machine) {
  if (const auto stalled = stalled_threads(HostClock::now()); !stalled.empty()) {
    return "thread " + stalled.front().name + " hangs";
  }
  switch (machine.state) {
    case ScanState::kInitialized:
    case ScanState::kReady:
    case ScanState::kExecuting:
      return std::nullopt;
    default:
      break;
  }
  const std::string state(scan_state_name(machine.state));
  return machine.error ? state + ": " + machine.error_message : state;
}

}  // namespace fvd
