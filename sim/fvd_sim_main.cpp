/// fvd-sim: a simulated microscope on real protocols, and the comparison of what fvd made of it with the truth.

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <optional>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "core/base/error.hpp"
#include "sim/evaluate/evaluate.hpp"
#include "sim/evaluate/slice_files.hpp"
#include "sim/faults/fault_config.hpp"
#include "sim/plant/plant.hpp"
#include "sim/world/world_config.hpp"

namespace fvd::sim {
namespace {

constexpr const char* kHighFirst = "high-first";
constexpr const char* kLowFirst = "low-first";

struct Arguments {
  std::filesystem::path world;
  std::filesystem::path plant;
  std::string camera_address = "127.0.0.1";
  std::string serial = "SIM01";
  std::string name;
  bool discoverable = false;
  int width_increment = 1;
  bool chunk_mode = false;
  std::string stage_address = "127.0.0.1";
  int stage_port = 1502;
  std::string drive = "az";
  std::string word_order = kHighFirst;
  std::filesystem::path stage_pty;
  std::vector<double> line_timing;  // baud, turnaround ms, adapter's latency ms
  std::filesystem::path faults;
  std::filesystem::path camera_faults;
  double packet_loss = 0.0;
  std::optional<std::uint64_t> seed;
  std::filesystem::path ready_file;
  std::filesystem::path motion_log;
  std::filesystem::path folder;
  bool json = false;
  SliceFileOptions slices;
};

/// The chapter's world and plant unless files say otherwise.
WorldParameters world_of(const Arguments& arguments) {
  WorldParameters world = arguments.world.empty() ? WorldParameters{} : load_world(arguments.world);
  if (arguments.seed) world.seed = *arguments.seed;
  return world;
}

AxisParameters plant_of(const Arguments& arguments) {
  AxisParameters plant{.encoder_noise_um = 0.01, .settle_noise_um = 0.02, .start_latency_ms = 3.0};
  if (!arguments.plant.empty()) plant = load_plant(arguments.plant);
  if (arguments.seed) plant.seed = *arguments.seed;
  return plant;
}

LineTiming line_timing_of(const Arguments& arguments) {
  const auto microseconds = [](double ms) {
    return std::chrono::microseconds(static_cast<std::int64_t>(std::clamp(ms, -1.0, 60000.0) * 1000.0));
  };
  LineTiming timing;
  if (arguments.line_timing.size() != 3) return timing;
  timing.baud = static_cast<int>(std::clamp(arguments.line_timing[0], 0.0, 1e9));
  timing.turnaround = microseconds(arguments.line_timing[1]);
  timing.usb_latency = microseconds(arguments.line_timing[2]);
  return timing;
}

constexpr const char* kGcs = "gcs";

/// All that the stage may be: drives on Modbus, a controller on GCS.
std::vector<std::string> stage_names() {
  std::vector<std::string> names = drive_names();
  names.emplace_back(kGcs);
  return names;
}

void render(const Arguments& arguments) {
  const auto z_um = write_slices(world_of(arguments), arguments.folder, arguments.slices);
  std::cout << z_um.size() << " slices from " << z_um.front() << " to " << z_um.back() << " um, z.txt and truth in "
            << arguments.folder.string() << '\n';
}

/// Where the stage is, in words.
std::string stage_of(const Plant& plant, const Arguments& arguments) {
  const bool serial = !arguments.stage_pty.empty();
  const std::string line =
      serial ? arguments.stage_pty.string() : arguments.stage_address + ':' + std::to_string(plant.stage_port());
  if (arguments.drive == kGcs) return line + " axis 1 (GCS)";
  return line + (serial ? " unit 1 (Modbus RTU)" : " unit 1 (Modbus TCP)");
}

void write_ready_file(const std::filesystem::path& file, const Plant& plant, const Arguments& arguments) {
  if (file.empty()) return;
  const auto temporary = file.string() + ".tmp";
  std::ofstream out(temporary);
  out << "{\"camera_address\": \"" << plant.camera_address() << "\", ";
  if (arguments.stage_pty.empty()) {
    out << "\"stage_address\": \"" << arguments.stage_address << "\", \"stage_port\": " << plant.stage_port();
  } else {
    out << "\"stage_pty\": " << std::quoted(arguments.stage_pty.string());
  }
  out << ", \"drive\": \"" << arguments.drive << "\", \"pid\": " << ::getpid() << "}\n";
  out.close();
  if (!out || ::rename(temporary.c_str(), file.c_str()) != 0) {
    throw Error(ErrorCode::kStorageWrite, "cannot write " + file.string());
  }
}

int run(const Arguments& arguments) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  const bool gcs = arguments.drive == kGcs;
  const bool low_first = arguments.word_order == kLowFirst;
  if (gcs && (!arguments.faults.empty() || !arguments.line_timing.empty() || low_first)) {
    throw Error(ErrorCode::kBadConfig,
                "--faults, --line-timing and --word-order are of Modbus; they do not go with --drive gcs");
  }
  Plant plant({.world = world_of(arguments),
               .axis = plant_of(arguments),
               .camera_address = arguments.camera_address,
               .camera_serial = arguments.serial,
               .camera_name = arguments.name,
               .camera_discoverable = arguments.discoverable,
               .camera_width_increment = arguments.width_increment,
               .camera_chunk_mode = arguments.chunk_mode,
               .stage_address = arguments.stage_address,
               .stage_port = arguments.stage_port,
               .drive = gcs ? DriveKind::kAz : drive_kind(arguments.drive),
               .low_word_first = low_first,
               .gcs = gcs,
               .stage_pty = arguments.stage_pty,
               .line_timing = line_timing_of(arguments),
               .faults = arguments.faults.empty() ? std::vector<FaultStep>{} : load_fault_steps(arguments.faults),
               .camera_faults = arguments.camera_faults.empty() ? std::vector<CameraFaultStep>{}
                                                                : load_camera_fault_steps(arguments.camera_faults),
               .motion_log = arguments.motion_log});
  plant.camera().set_packet_loss(arguments.packet_loss);
  std::cout << "camera " << plant.camera_address() << ":3956 (GigE Vision), " << plant.world().sensor_width() << " x "
            << plant.world().sensor_height() << " pixels; stage " << stage_of(plant, arguments) << ", drive "
            << arguments.drive << "; " << (plant.world().memory_bytes() >> 20U) << " MiB" << std::endl;
  write_ready_file(arguments.ready_file, plant, arguments);
  int received = 0;
  sigwait(&signals, &received);
  std::cout << "frames sent " << plant.camera().frames() << ", packets lost " << plant.camera().packets_lost()
            << ", packets resent " << plant.camera().packets_resent() << ", requests to the stage "
            << plant.stage_requests() << std::endl;
  if (plant.faults().unconsumed() + plant.camera().faults().unconsumed() == 0) return 0;
  std::cout << "faults that did not happen:\n";
  for (const std::string& steps :
       {plant.faults().describe_unconsumed(), plant.camera().faults().describe_unconsumed()}) {
    if (!steps.empty()) std::cout << steps << std::endl;
  }
  return 1;
}

void add_render_options(CLI::App& command, Arguments& arguments) {
  SliceFileOptions& slices = arguments.slices;
  command.add_option("world", arguments.world, "world file")->required()->check(CLI::ExistingFile);
  command.add_option("folder", arguments.folder, "new or empty folder")->required();
  command.add_option("--start-um", slices.start_um, "z of the first slice; default: 50 um beyond the surface");
  command.add_option("--step-um", slices.step_um, "from one slice to the next, may be negative")->capture_default_str();
  command.add_option("--slices", slices.slices, "their number; default: until 50 um beyond the surface");
  command.add_option("--seed", arguments.seed, "of texture and noise");
  command.add_option("--format", slices.format, "of the files")
      ->check(CLI::IsMember(slice_formats()))
      ->capture_default_str();
}

int main_of(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"fvd-sim: a simulated microscope on GigE Vision and Modbus", "fvd-sim"};
  app.require_subcommand(1);
  const auto add_world = [&](CLI::App* command) {
    command->add_option("--world", arguments.world, "world file; default: the chapter's surface")
        ->check(CLI::ExistingFile);
    command->add_option("--seed", arguments.seed, "of texture, noise and axis errors");
  };
  auto* running = app.add_subcommand("run", "serve camera and stage until SIGTERM");
  add_world(running);
  running->add_option("--plant", arguments.plant, "axis file; default: nearly perfect")->check(CLI::ExistingFile);
  running->add_option("--camera-address", arguments.camera_address, "loopback address, or auto for a free one")
      ->capture_default_str();
  running->add_option("--serial", arguments.serial, "serial number of the camera, at most 15 characters")
      ->capture_default_str();
  running->add_option("--name", arguments.name, "user-defined name of the camera, at most 15 characters");
  running->add_flag("--discoverable", arguments.discoverable,
                    "the camera is found by broadcasts; only those on loopback are heard");
  running->add_option("--width-increment", arguments.width_increment, "grid of the camera's widths, pixels")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  running->add_flag("--chunk-mode", arguments.chunk_mode, "the camera's description has ChunkModeActive");
  running->add_option("--stage-address", arguments.stage_address, "address that the stage is served at")
      ->capture_default_str();
  auto* port = running->add_option("--stage-port", arguments.stage_port, "its port, 0 = any free one")
                   ->check(CLI::Range(0, 65535))
                   ->capture_default_str();
  running->add_option("--drive", arguments.drive, "what the stage is: a drive on Modbus, or gcs")
      ->check(CLI::IsMember(stage_names()))
      ->capture_default_str();
  running->add_option("--word-order", arguments.word_order, "which word of 32-bit values the drive gives first")
      ->check(CLI::IsMember({kHighFirst, kLowFirst}))
      ->capture_default_str();
  auto* pty = running->add_option("--stage-pty", arguments.stage_pty,
                                  "serve the stage on a pseudo-terminal linked here instead of TCP");
  pty->excludes(port);
  running
      ->add_option("--line-timing", arguments.line_timing,
                   "baud, turnaround ms, adapter's latency ms of that line; default: 115200,0,0")
      ->expected(3)
      ->delimiter(',')
      ->needs(pty);
  running
      ->add_option("--faults", arguments.faults,
                   "script of faults of stage and line; exit status 1 if one did not happen")
      ->check(CLI::ExistingFile);
  running
      ->add_option("--camera-faults", arguments.camera_faults,
                   "script of faults of the camera; exit status 1 if one did not happen")
      ->check(CLI::ExistingFile);
  running->add_option("--packet-loss", arguments.packet_loss, "fraction of stream packets that are lost")
      ->check(CLI::Range(0.0, 0.9));
  running->add_option("--motion-log", arguments.motion_log,
                      "file of the stage's commands and true motions, a line each with CLOCK_MONOTONIC in ns");
  running->add_option("--ready-file", arguments.ready_file, "written once both serve: addresses and pid as JSON");
  auto* truth = app.add_subcommand("truth", "write the world's true heights");
  add_world(truth);
  truth->add_option("folder", arguments.folder, "existing folder")->required()->check(CLI::ExistingDirectory);
  auto* rendering = app.add_subcommand("render", "write slices, their z and the truth for fvdctl process");
  add_render_options(*rendering, arguments);
  auto* compare = app.add_subcommand("evaluate", "compare a result of fvd with the truth");
  add_world(compare);
  compare->add_option("result", arguments.folder, "result directory")->required()->check(CLI::ExistingDirectory);
  compare->add_flag("--json", arguments.json, "print the figures as one JSON object in the last line");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 64;
  }
  if (*running) return run(arguments);
  if (*rendering) {
    render(arguments);
  } else if (*truth) {
    write_truth(world_of(arguments), arguments.folder);
  } else {
    evaluate(world_of(arguments), arguments.folder, arguments.json, std::cout);
  }
  return 0;
}

}  // namespace
}  // namespace fvd::sim

int main(int argc, char** argv) {
  try {
    return fvd::sim::main_of(argc, argv);
  } catch (const fvd::Error& error) {
    std::cerr << "fvd-sim: " << error.what() << '\n';
    return error.code() == fvd::ErrorCode::kBadConfig ? 78 : 65;
  } catch (const std::exception& error) {
    std::cerr << "fvd-sim: " << error.what() << '\n';
    return 70;
  }
}
