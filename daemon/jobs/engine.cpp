#include "daemon/jobs/engine.hpp"

#include <algorithm>
#include <functional>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include "daemon/base/version.hpp"
#include "daemon/config/config_file.hpp"
#include "daemon/export/sha256.hpp"

namespace fvd {

namespace {

/// Longest time that the machine's thread may take to look after devices and disk between jobs and commands, which
/// have times of their own.
constexpr std::chrono::minutes kLongestLook{2};

int thread_count(int configured) {
  if (configured > 0) return configured;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

MachineBoard::Constants constants(const Config& config, JobStore& store, std::function<bool()> axis_stands) {
  return {config.camera.simulated || config.stage.simulated,
          store.epoch(),
          [&store] { return store.unacknowledged_count(); },
          [&store] { return store.unacknowledged_results(); },
          [&store] { return store.newest_seqs(); },
          config.rpc.fifo_results,
          std::move(axis_stands),
          store.results().count_of_interrupted()};
}

std::size_t memory_budget_bytes(const Config& config) {
  return static_cast<std::size_t>(config.compute.memory_budget_mib) << 20U;
}

}  // namespace

Engine::Engine(const Config& config, const EngineDependencies& deps)
    : state_dir_(config.paths.state_dir),
      alarms_(deps.alarms ? deps.alarms : std::make_shared<AlarmLog>()),
      pool_(thread_count(config.compute.threads)),
      pages_(std::make_shared<KeptPages>(memory_budget_bytes(config))),
      history_(config.paths.state_dir / "stage_history.json"),
      calibrations_(config.paths.state_dir / "calibration"),
      studies_(config.paths.state_dir / "studies"),
      recipes_({config.paths.recipe_dir, config.paths.state_dir / "recipes"},
               {config.stage.min, config.stage.max, config.stage.take_up, config.stage.speed_um_per_s},
               deps.store.recipe_versions()),
      board_(constants(config, deps.store, [this] { return hub_.seen_standing(); }), deps.store.latest()),
      access_(config.rpc.access),
      control_([] { return HostClock::now(); }, [this] { return board_.read().state.job != JobStage::kNone; }),
      audit_(deps.store.audit()),
      objectives_(config.objectives, deps.store.objectives(), board_),
      hub_(deps.openers, deps.clock,
           [this](bool at_rest) {
             board_.update([at_rest](MachineRecord& machine) {
               machine.apply(at_rest ? MachineEvent::kStandstillMeasured : MachineEvent::kMotionSeen);
             });
           }),
      ticks_("fvd-machine", kLongestLook),
      tasks_({board_, hub_, work_, deps.clock, preview_, history_, config.paths.state_dir, config.objectives}),
      storage_(deps.store.file(), config.paths.state_dir / "results"),
      following_(deps.store),
      retention_(deps.store, config.store, config.paths.state_dir / "results"),
      runner_({config, deps.store, board_, hub_, deps.clock, pool_, pages_, preview_, history_, ticks_, calibrations_,
               following_, storage_, deps.make_result,
               deps.repeatability ? deps.repeatability
                                  : [this, simulated = config.camera.simulated || config.stage.simulated](
                                        const Recipe& recipe) {
                                      const MachineRecord machine = board_.read();
                                      return studies_.newest_repeatability(
                                          recipe.id, machine.objective,
                                          simulated || (machine.devices && machine.devices->simulated));
                                    }}),
      evaluator_({deps.store, board_, config.paths.state_dir / "results", config.paths.state_dir / "calibration",
                  memory_budget_bytes(config)}),
      jobs_({deps.store,
             board_,
             work_,
             runner_,
             evaluator_,
             {pool_.threads(), memory_budget_bytes(config), pages_},
             [this](const std::string& recipe_id) { return recipes_.load(recipe_id); },
             [this] { return tasks_.task_stop(); },
             config.objectives,
             storage_}),
      desk_({[&store = deps.store](const std::string& id) { return store.find(id); },
             [this](const std::string& id) { return recipes_.load(id); }, memory_budget_bytes(config),
             calibrations_.folder()},
            studies_, calibrations_, config.camera.simulated || config.stage.simulated),
      study_runner_(desk_, [this] { board_.update([](MachineRecord&) {}); }),
      thread_(hub_, board_, work_, ticks_, [this] {
        runner_.look_after_storage();
        jobs_.restore_prepared();
        note_health();
      }) {
  board_.update([&](MachineRecord& machine) { machine.recipe = deps.store.prepared_recipe(); });
  note_configuration(config, std::string("start of fvd ") + kVersion);
  const auto last = deps.store.latest();
  if (last && last->error == ErrorCode::kInterrupted && !last->acknowledged) {
    spdlog::warn("job {} of client {}, seq {}, part '{}': {}", last->job_id, last->request.client, last->request.seq,
                 last->request.part_id, last->error_message);
  }
}

Engine::~Engine() { finish(); }

void Engine::note_configuration(const Config& in_force, const std::string& what, std::string_view outcome) {
  AuditEntry entry;
  entry.who = "fvd";
  entry.role = role_name(Role::kAdminister);
  entry.what = "configuration.load";
  entry.detail = what + "; sha256 of the configuration in force " + sha256_of(config_text(in_force));
  entry.outcome = outcome;
  audit_.note(std::move(entry));
}

void Engine::note_health() {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(state_dir_, error);
  const DevicesHealth health = hub_.health();
  board_.update([&](MachineRecord& machine) {
    machine.health = health;
    machine.disk = error ? std::nullopt : std::optional(DiskSpace{space.available, space.capacity});
  });
}

void Engine::shut_down() {
  board_.update([](MachineRecord& machine) { machine.apply(MachineEvent::kHalt); });
  thread_.request_stop();
  following_.request_stop();
  jobs_.stop_job();
  tasks_.task_stop().request_stop();
  study_runner_.request_stop();
}

void Engine::finish() {
  shut_down();
  thread_.finish();
  runner_.store_late_end();  // the last chance, before what may take long
  following_.finish();
  retention_.finish();
  evaluator_.finish();
  study_runner_.finish();
}

}  // namespace fvd
