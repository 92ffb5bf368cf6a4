/// How well devices, lines, threads and the disk do.

#include "core/runtime/thread_ticks.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"

namespace fvd {

namespace {

void describe_health(Fields& fields) {
  const ResultFields result(fields);
  result.boolean("ok", "no thread hangs, and the machine is not in error");
  result.any("stalled_threads", "names of the threads that have not ticked for longer than they may");
  result.any("camera",
             "an object: open, openings since the start (more than one: it was lost); since it was opened: "
             "frames_complete, frames_failed, underruns, ids_skipped, packets_resent, packets_missing");
  result.any(
      "stage",
      "an object: open, openings; standstill, of this moment: measured, and its newest sample says so too; if it "
      "has a line also, since it was opened: requests, retries, unanswered, refused, put_off, reconnects, implausible, "
      "discarded_bytes, latency_p50_us, latency_p99_us; temperatures_c by name where the drive tells them; z_um, where "
      "it was at the last look between jobs and "
      "commands, not its place while one runs, if that is known; min_um, max_um, how far it may be sent, while it is "
      "open");
  result.any("disk", "an object: free_bytes, size_bytes of the file system of the results", Presence::kSometimes);
}

Reply camera_of(const DevicesHealth& health) {
  return {{"open", health.camera.open},
          {"openings", health.camera.openings},
          {"frames_complete", health.frames.frames_complete},
          {"frames_failed", health.frames.frames_failed},
          {"underruns", health.frames.underruns},
          {"ids_skipped", health.frames.ids_skipped},
          {"packets_resent", health.frames.packets_resent},
          {"packets_missing", health.frames.packets_missing}};
}

Reply stage_of(const DevicesHealth& health, bool stands) {
  Reply stage{{"open", health.stage.open}, {"openings", health.stage.openings}, {"standstill", stands}};
  if (const auto& link = health.link) {
    stage.update({{"requests", link->requests},
                  {"retries", link->retries},
                  {"unanswered", link->unanswered},
                  {"refused", link->refused},
                  {"put_off", link->put_off},
                  {"reconnects", link->reconnects},
                  {"implausible", link->implausible},
                  {"discarded_bytes", link->discarded_bytes},
                  {"latency_p50_us", link->latency_p50_us},
                  {"latency_p99_us", link->latency_p99_us}});
  }
  if (health.position) stage["z_um"] = health.position->value;
  if (health.reach) stage.update({{"min_um", health.reach->min.value}, {"max_um", health.reach->max.value}});
  for (const StageTemperature& temperature : health.temperatures) {
    stage["temperatures_c"][temperature.name] = temperature.celsius;
  }
  return stage;
}

Reply health_of(const MachineView& view) {
  const auto snapshot = view.snapshot();
  const MachineStatus& machine = *snapshot;
  Reply stalled = Reply::array();
  for (const StalledThread& thread : stalled_threads(HostClock::now())) stalled.push_back(thread.name);
  Reply reply{{"ok", stalled.empty() && !machine.error},
              {"stalled_threads", stalled},
              {"camera", camera_of(machine.health)},
              {"stage", stage_of(machine.health, view.stage_stands())}};
  if (machine.disk) {
    reply["disk"] = {{"free_bytes", machine.disk->free_bytes}, {"size_bytes", machine.disk->size_bytes}};
  }
  return reply;
}

}  // namespace

void add_health_methods(MethodTable& methods, const Services& services) {
  methods["system.health"] = {
      .about = {.summary = "Devices, their lines, threads and disk, as they were between jobs and commands",
                .role = Role::kView,
                .params = described<NoParams>(),
                .result = describe_health},
      .peek = [&machine = services.machine](const Call&) { return health_of(machine); }};
}

}  // namespace fvd
