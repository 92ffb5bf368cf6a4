/// How the stage driver behaves beside other masters, busy drives, and gateways that answer for somebody else. Prints
/// what goes wrong; the last line is one JSON object.

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>
#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "drivers/modbus/modbus_link.hpp"
#include "tests/bench/stage_fault_bench.hpp"
#include "tests/support/bent_line.hpp"
#include "tests/support/busy_bank.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd::test {
namespace {

using std::chrono::milliseconds;

constexpr SettleCriterion kCriterion{
    .window = Micrometers{0.5}, .samples = 3, .dwell = milliseconds(10), .timeout = milliseconds(5000)};
constexpr double kTolerance_um = 0.75;  // one and a half windows
constexpr int kExitTaken = 3;

int port_of(const SimulatedLine& line) { return std::get<ModbusTcpEndpoint>(line.config().endpoint).port; }

// --- a second copy ---

/// Lets the CiA 402 drive be seen, and counts how often a write takes its torque.
class TorqueWatch final : public sim::RegisterBank {
 public:
  explicit TorqueWatch(sim::RegisterBank& drive) : drive_(drive) {}
  sim::ModbusException read(int address, std::span<std::uint16_t> values) override {
    return drive_.read(address, values);
  }
  sim::ModbusException write(int address, std::span<const std::uint16_t> values) override {
    const bool had = has_torque();
    const auto exception = drive_.write(address, values);
    if (had && !has_torque()) ++drops_;
    return exception;
  }
  void idle() override { drive_.idle(); }
  [[nodiscard]] int drops() const noexcept { return drops_; }

 private:
  [[nodiscard]] bool has_torque() {
    constexpr int kStatusword = 5000;
    std::uint16_t word = 0;
    return drive_.read(kStatusword, std::span(&word, 1)) == sim::ModbusException::kNone && (word & 0x6FU) == 0x27U;
  }

  sim::RegisterBank& drive_;
  std::atomic<int> drops_{0};
};

/// What a second copy does: another process, which opens the same drive and homes it if it may.
int open_as_second_copy(const std::string& profile, int port) {
  StageConfig config;
  config.profile = profile;
  config.port = port;
  try {
    const auto stage = open_modbus_stage(config);
    stage->home({});
    return 0;
  } catch (const Error& error) {
    return error.code() == ErrorCode::kStageTaken ? kExitTaken : 1;
  }
}

/// The second copy's exit code; -1 if it did not start.
int run_second_copy(const StageConfig& config) {
  std::string self = "/proc/self/exe";
  std::string word = "--second-copy";
  std::string profile = config.profile.string();
  std::string port = std::to_string(config.port);
  std::array<char*, 5> arguments{self.data(), word.data(), profile.data(), port.data(), nullptr};
  pid_t child = 0;
  if (::posix_spawn(&child, self.c_str(), nullptr, nullptr, arguments.data(), environ) != 0) return -1;
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

struct CopyFigures {
  int openings = 0;
  int torque_drops = 0;
  int moves_not_ours = 0;
  int not_refused = 0;
};

CopyFigures run_second_copies() {
  constexpr int kOpenings = 50;
  SimulatedDrive plant(kDriveCases[4], Transport::kTcp);
  TorqueWatch watch(plant.drive());
  sim::FaultScript no_faults;
  const SimulatedLine line(Transport::kTcp, watch, no_faults);
  StageConfig config = plant.config();
  config.port = port_of(line);
  const auto stage = open_modbus_stage(config);
  stage->home({});
  const int drops = watch.drops();
  const int before = plant.drive().moves();
  CopyFigures figures;
  std::atomic<bool> done{false};
  std::jthread other([&] {
    for (; figures.openings < kOpenings; ++figures.openings) {
      if (run_second_copy(config) != kExitTaken) ++figures.not_refused;
    }
    done = true;
  });
  int commanded = 0;
  while (!done) {
    try {
      stage->move_to(Micrometers{10.0 * (++commanded % 30)}, kCriterion, {});
    } catch (const Error& error) {
      std::cout << "a second copy disturbed a move: " << error.what() << std::endl;
    }
  }
  other.join();
  figures.torque_drops = watch.drops() - drops;
  figures.moves_not_ours = std::abs(plant.drive().moves() - before - commanded);
  std::printf("second copies: %d opened in %d moves, %d not refused, %d torque drops, %d moves not ours\n",
              figures.openings, commanded, figures.not_refused, figures.torque_drops, figures.moves_not_ours);
  return figures;
}

// --- busy drives ---

struct BusyFigures {
  int jobs_ok = 0;
  int put_off = 0;
  int wrong_values = 0;
  int moves_too_many = 0;
};

/// Homing and twelve slices' moves on a drive that puts off five requests in a hundred.
void run_busy_job(const DriveCase& drive, unsigned seed, BusyFigures& figures) {
  constexpr int kMoves = 12;
  constexpr double kShare = 0.05;
  SimulatedDrive plant(drive, Transport::kTcp);
  BusyBank busy(plant.drive(), kShare, seed);
  sim::FaultScript no_faults;
  const SimulatedLine line(Transport::kTcp, busy, no_faults);
  StageConfig config = plant.config();
  config.port = port_of(line);
  int commanded = 0;
  try {
    const auto stage = open_modbus_stage(config);
    stage->home({});
    while (commanded < kMoves) {
      const double target_um = 10.0 * ++commanded;
      const MoveRecord move = stage->move_to(Micrometers{target_um}, kCriterion, {});
      const double true_um = plant.axis().true_position_um(HostClock::now());
      const bool right =
          std::abs(move.position.value - true_um) <= kTolerance_um && std::abs(true_um - target_um) <= kTolerance_um;
      if (!right) ++figures.wrong_values;
    }
    ++figures.jobs_ok;
  } catch (const Error& error) {
    std::cout << "busy " << drive << " " << seed << ": " << error.what() << std::endl;
  }
  figures.put_off += busy.put_off();
  figures.moves_too_many += std::max(0, plant.drive().moves() - commanded);
}

BusyFigures run_busy_jobs() {
  constexpr unsigned kJobsOfEach = 10;
  BusyFigures figures;
  for (const DriveCase& drive : kDriveCases) {
    for (unsigned seed = 1; seed <= kJobsOfEach; ++seed) run_busy_job(drive, seed, figures);
  }
  std::printf("busy drives: %d jobs ok, %d requests put off, %d wrong values, %d motions too many\n", figures.jobs_ok,
              figures.put_off, figures.wrong_values, figures.moves_too_many);
  return figures;
}

// --- answers of somebody else ---

/// How many of a hundred bent answers are believed.
int believed(const std::function<void(LineBytes&)>& bend) {
  constexpr int kReads = 100;
  constexpr int kAzPosition = 0x00CC;
  SimulatedDrive plant(kDriveCases[0], Transport::kTcp);
  const BentLine line(port_of(plant.line()), {.answer = bend});
  ModbusLinkConfig config;
  config.endpoint = ModbusTcpEndpoint{"127.0.0.1", line.port()};
  ModbusLink link(config);
  int count = 0;
  for (int i = 0; i < kReads; ++i) {
    if (link.read(ModbusTable::kHolding, kAzPosition, 2).outcome != ModbusOutcome::kUnknown) ++count;
  }
  std::printf("bent answers: %d of %d reads believed, %d answers came\n", count, kReads, line.answers());
  return count;
}

int run() {
  spdlog::set_level(spdlog::level::off);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // what was measured so far stays readable
  const CopyFigures copies = run_second_copies();
  const BusyFigures busy = run_busy_jobs();
  const int wrong_unit = believed([](LineBytes& answer) { answer[6] = 7; });
  const int wrong_protocol = believed([](LineBytes& answer) { answer[2] = 1; });
  const StageFaultFigures faults = run_stage_faults();
  const nlohmann::ordered_json json{{"second_copies_opened", copies.openings},
                                    {"second_copies_not_refused", copies.not_refused},
                                    {"torque_drops", copies.torque_drops},
                                    {"moves_not_ours", copies.moves_not_ours},
                                    {"busy5_jobs_ok_of_50", busy.jobs_ok},
                                    {"busy5_put_off", busy.put_off},
                                    {"wrong_values_accepted", busy.wrong_values + faults.wrong_values},
                                    {"motions_too_many", busy.moves_too_many + faults.moves_too_many},
                                    {"wrong_unit_accepted", wrong_unit},
                                    {"wrong_protocol_accepted", wrong_protocol},
                                    {"fault_cases_stage", faults.cases},
                                    {"fault_surprises_stage", faults.surprises}};
  std::cout << json.dump() << std::endl;
  return 0;
}

}  // namespace
}  // namespace fvd::test

int main(int argc, char** argv) {
  if (argc == 4 && std::string(argv[1]) == "--second-copy") {
    spdlog::set_level(spdlog::level::off);
    return fvd::test::open_as_second_copy(argv[2], std::stoi(argv[3]));
  }
  return fvd::test::run();
}
