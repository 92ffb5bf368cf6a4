/// What must never happen, counted: the axis moves while a client is told that the part is free; the machine is ready
/// between a device's loss and the error; a job takes the sequence number of another client; a scan is completed with
/// more slices lost than its recipe allows. And how long a heartbeat takes beside a slow disk. Beside each zero stands
/// how often it could have happened.
///
/// bench_structure FVD [KILLS] [LOSSES]: the program to be looked at, e.g. build/daemon/fvd, with its fvdctl in ctl/
/// beside it. bench_structure FVD jobs: the last two figures alone.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <random>
#include <thread>

#include <nlohmann/json.hpp>
#include <sqlite3.h>

#include "sim/plant/plant.hpp"
#include "tests/bench/motion_watch.hpp"
#include "tests/bench/ping_load.hpp"
#include "tests/bench/watched_daemon.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/line_client.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::bench {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

/// A log's time and a sample's are each known to a millisecond or two.
constexpr milliseconds kTimeTolerance{4};

class Bench {
 public:
  Bench(std::filesystem::path program, const sim::PlantOptions& options)
      : program_(std::move(program)), plant_(options), watch_(plant_.axis()) {}

  [[nodiscard]] std::unique_ptr<WatchedDaemon> start(const std::vector<std::string>& environment = {}) {
    const std::filesystem::path runtime_dir = folder_.path() / "run";
    auto daemon = std::make_unique<WatchedDaemon>(
        program_, runtime_dir,
        std::vector<std::string>{"camera.address=" + plant_.camera_address(),
                                 "stage.port=" + std::to_string(plant_.stage_port()), "rpc.port=0",
                                 "paths.state_dir=" + state_dir().string(),
                                 // In a form that every version reads.
                                 "paths.recipe_dir=" FVD_SOURCE_DIR "/tests/bench/recipes"},
        environment);
    port_ = daemon->await_port();
    return daemon;
  }

  /// The whole answer, an error too.
  json answer(const std::string& method, const json& params) const {
    LineClient client(port_);
    return json::parse(client.ask(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump()),
                       nullptr, false);
  }

  json ask(const std::string& method, const json& params) const {
    const json whole = answer(method, params);
    return whole.is_object() && whole.contains("result") ? whole["result"] : json::object();
  }

  /// Asks for the job until the machine takes it; false if it never does.
  bool begin(const std::string& recipe) {
    ++seq_;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < deadline) {
      if (ask("job.start", {{"seq", seq_}, {"part_id", "bench"}, {"recipe", recipe}}).contains("job_id")) return true;
      std::this_thread::sleep_for(milliseconds(20));
    }
    return false;
  }

  /// Waits until the job's scan has got to a slice.
  void await_slices(int slices) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < deadline &&
           ask("job.status", {{"seq", seq_}}).value("slices_done", 0) < slices) {
      std::this_thread::sleep_for(milliseconds(1));
    }
  }

  bool await_ready() const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < deadline) {
      if (ask("system.state", json::object()).value("ready", false)) return true;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return false;
  }

  [[nodiscard]] std::filesystem::path state_dir() const { return folder_.path() / "state"; }
  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] int seq() const { return seq_; }
  void set_seq(int seq) { seq_ = seq; }
  sim::Plant& plant() { return plant_; }
  MotionWatch& watch() { return watch_; }

 private:
  test::ScratchDir folder_;
  std::filesystem::path program_;
  sim::Plant plant_;
  MotionWatch watch_;
  int port_ = 0;
  int seq_ = 0;
};

sim::PlantOptions microscope() {
  sim::PlantOptions options;
  options.axis.encoder_noise_um = 0.01;
  options.axis.settle_noise_um = 0.02;
  return options;
}

/// Kills the daemon in continuous scans at random heights; the next one finds the axis in motion.
json moving_while_released(const std::filesystem::path& program, int kills) {
  Bench bench(program, microscope());
  std::mt19937 random(1);
  std::uniform_int_distribution<int> slice(5, 90);
  long samples = 0;
  long released = 0;
  int killed = 0;
  const auto count = [&](const std::vector<LoggedChange>& changes) {
    const auto intervals = released_intervals(changes);
    for (const WallTime& moving : bench.watch().take_moving()) {
      ++samples;
      released += std::count_if(intervals.begin(), intervals.end(), [&](const Interval& free) {
        return moving > free.from + kTimeTolerance && moving < free.to - kTimeTolerance;
      });
    }
  };
  for (int i = 0; i < kills; ++i) {
    auto daemon = bench.start();
    if (!bench.begin("chapter_continuous")) break;
    bench.await_slices(slice(random));
    daemon->kill();
    ++killed;
    count(daemon->changes());
  }
  auto last = bench.start();
  (void)bench.await_ready();
  last->kill();
  count(last->changes());
  return {{"moving_while_released", released}, {"moving_samples", samples}, {"kills", killed}};
}

/// Takes the stage's or the camera's cable away in a scan.
json ready_before_error(const std::filesystem::path& program, int losses) {
  Bench bench(program, microscope());
  std::mt19937 random(2);
  std::uniform_int_distribution<int> slice(1, 15);
  auto daemon = bench.start();
  int seen = 0;
  for (int i = 0; i < losses; ++i) {
    if (!bench.await_ready() || !bench.begin("chapter")) break;
    bench.await_slices(slice(random));
    const bool stage = i % 2 == 0;
    stage ? bench.plant().unplug_stage() : bench.plant().unplug_camera();
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
    while (std::chrono::steady_clock::now() < deadline &&
           bench.ask("system.state", json::object()).value("state", "") != "error") {
      std::this_thread::sleep_for(milliseconds(5));
    }
    stage ? bench.plant().plug_stage() : bench.plant().plug_camera();
  }
  (void)bench.await_ready();
  daemon->kill();
  int ready = 0;
  std::string before;
  std::string before_that;
  for (const LoggedChange& change : daemon->changes()) {
    if (change.what.rfind("part_release", 0) == 0) continue;
    if (change.what == "error" && before == "executing") ++seen;
    if (change.what == "error" && before == "ready" && before_that == "executing") {
      ++seen;
      ++ready;
    }
    before_that = before;
    before = change.what;
  }
  return {{"ready_before_error", ready}, {"losses_seen", seen}};
}

/// As if that many results had been made and never fetched.
void fill_store(const std::filesystem::path& file, int jobs) {
  sqlite3* database = nullptr;
  const std::string fill = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < " +
                           std::to_string(jobs) +
                           ") INSERT INTO jobs (job_id, seq, part_id, recipe, state) "
                           "SELECT 'bench-' || i, i, 'bench', 'chapter', 'completed' FROM n";
  const bool filled = sqlite3_open(file.c_str(), &database) == SQLITE_OK &&
                      sqlite3_exec(database, fill.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
  const std::string why = filled ? "" : sqlite3_errmsg(database);
  sqlite3_close(database);
  if (!filled) throw std::runtime_error("cannot fill " + file.string() + ": " + why);
}

/// Heartbeats of eight clients while jobs start, end and are acknowledged on a disk that takes 500 ms to sync.
json ping_beside_a_slow_disk(const std::filesystem::path& program) {
  constexpr int kResults = 100'000;
  Bench bench(program, microscope());
  bench.start()->kill();
  fill_store(bench.state_dir() / "fvd.sqlite", kResults);
  bench.set_seq(kResults);
  auto daemon = bench.start({"LD_PRELOAD=" FVD_SLOW_SYNC, "FVD_SLOW_SYNC_MS=500"});
  (void)bench.await_ready();
  int jobs = 0;
  const auto working = start_thread("bench-jobs", [&](const std::stop_token& stop) {
    while (!stop.stop_requested() && bench.begin("chapter_continuous")) {
      ++jobs;
      (void)bench.ask("job.wait", {{"seq", bench.seq()}});
      (void)bench.ask("result.ack", {{"seq", bench.seq()}});
    }
  });
  const auto times = ping_times_ms(bench.port(), {});
  return {{"ping_p99_ms_100k_unacked", percentile(times, 0.99)},
          {"ping_median_ms", percentile(times, 0.5)},
          {"ping_calls", times.size()},
          {"jobs_beside_pings", jobs}};
}

/// A command's stop against what ends the command: 0 if the program that runs the rounds ended badly.
json stop_race() {
  json figures{{"stop_race_rounds", 0}};
  std::FILE* output = ::popen(FVD_STOP_RACE, "r");
  if (output == nullptr) return figures;
  std::array<char, 256> line{};
  const bool told = std::fgets(line.data(), static_cast<int>(line.size()), output) != nullptr;
  if (::pclose(output) == 0 && told) figures.update(json::parse(line.data()));
  return figures;
}

/// Starts jobs as a PLC does, which counts its numbers itself, and as a person with fvdctl does in between, who leaves
/// the number to fvdctl. A number that the PLC finds taken, or under which it finds another's part, is a collision.
json seq_collisions(const std::filesystem::path& program, int jobs) {
  constexpr const char* kRecipe = "chapter_continuous";
  Bench bench(program, microscope());
  auto daemon = bench.start();
  const std::string fvdctl = (program.parent_path() / "ctl" / "fvdctl").string();
  const std::string address = "127.0.0.1:" + std::to_string(bench.port());
  int collisions = 0;
  int started = 0;
  const auto end_job = [&] {
    const std::string id = bench.ask("system.state", json::object()).value("job_id", "");
    (void)bench.ask("job.abort", {{"job_id", id}});
    (void)bench.ask("job.wait", {{"job_id", id}, {"timeout_ms", 20000}});
  };
  for (int seq = 1; started < jobs && bench.await_ready(); ++seq) {
    const std::string part = "plc-" + std::to_string(seq);
    const json reply = bench.answer("job.start", {{"seq", seq}, {"part_id", part}, {"recipe", kRecipe}});
    const bool accepted = reply.contains("result");
    const bool own = bench.ask("job.status", {{"seq", seq}}).value("part_id", "") == part;
    if (accepted) ++started;
    if (!own) ++collisions;
    end_job();
    if (!bench.await_ready()) break;
    test::ChildProcess person(
        {fvdctl, "--address", address, "start", "--part", "person-" + std::to_string(seq), "--recipe", kRecipe});
    (void)person.rest();
    if (person.wait() == 0) ++started;
    end_job();
  }
  daemon->kill();
  return {{"seq_collisions", collisions}, {"seq_jobs", started}};
}

/// Continuous scans in which the camera stands still for a while and goes on without a gap in its frame ids.
json completed_with_lost_slices(const std::filesystem::path& program, int scans) {
  constexpr const char* kRecipe = "slow_continuous";
  constexpr int kPlanned = 101;  // of the recipe: 2 um apart at 100 um/s, 3 may be lost
  constexpr int kAllowedLost = 3;
  constexpr milliseconds kPause{160};  // 8 slices
  Bench bench(program, microscope());
  auto daemon = bench.start();
  std::mt19937 random(3);
  std::uniform_int_distribution<int> frame(25, 80);
  int starved = 0;
  int completed = 0;
  int done = 0;
  for (; done < scans && bench.await_ready(); ++done) {
    bench.plant().camera().faults().add({.fault = sim::CameraFault::kHang, .after = frame(random), .delay = kPause});
    if (!bench.begin(kRecipe)) break;
    const json job = bench.ask("job.wait", {{"seq", bench.seq()}});
    const json slices =
        bench.ask("result.get", {{"seq", bench.seq()}, {"format", "full"}}).value("slices", json::object());
    const bool is_completed = job.value("state", "") == "completed";
    const bool lost_too_many = slices.value("measured", kPlanned) < kPlanned - kAllowedLost;
    if (is_completed && lost_too_many) ++completed;
    const bool refused = job.value("error_message", "").find("slices were lost") != std::string::npos;
    if ((is_completed && lost_too_many) || refused) ++starved;
  }
  daemon->kill();
  return {{"completed_with_lost_slices", completed}, {"starved_beyond_limit", starved}, {"starved_scans", done}};
}

json job_figures(const std::filesystem::path& program) {
  json figures = seq_collisions(program, 200);
  std::cerr << figures.dump() << '\n';
  figures.update(completed_with_lost_slices(program, 20));
  std::cerr << figures.dump() << '\n';
  return figures;
}

int run(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: bench_structure FVD [KILLS] [LOSSES] | FVD jobs\n";
    return 64;
  }
  const std::filesystem::path program = argv[1];
  if (argc > 2 && std::string(argv[2]) == "jobs") {
    std::cout << job_figures(program).dump() << std::endl;
    return 0;
  }
  json figures = moving_while_released(program, argc > 2 ? std::atoi(argv[2]) : 20);
  std::cerr << figures.dump() << '\n';
  figures.update(ready_before_error(program, argc > 3 ? std::atoi(argv[3]) : 50));
  std::cerr << figures.dump() << '\n';
  figures.update(stop_race());
  figures.update(job_figures(program));
  figures.update(ping_beside_a_slow_disk(program));
  std::cout << figures.dump() << std::endl;
  return 0;
}

}  // namespace
}  // namespace fvd::bench

int main(int argc, char** argv) { return fvd::bench::run(argc, argv); }
