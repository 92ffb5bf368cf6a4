#pragma once

/// The measurements of bench_camera on simulated cameras, one source file per subject. Every function prints what it
/// does; returned figures go into the JSON object.

namespace fvd::test {

// --- camera_fault_bench.cpp ---

struct FaultFigures {
  int cases = 0;
  int as_expected = 0;      ///< cases that ended as they should
  int wrong = 0;            ///< accepted slices whose pixels or z are wrong
  int violations = 0;       ///< scans whose books do not balance
  double hang_ms = 0.0;     ///< longest from the last frame of a camera that hangs to the error
  double recover_ms = 0.0;  ///< longest from a camera's return to its first frame
};

FaultFigures run_faults();
/// Number of kinds of name by which a camera was opened, of IP address, serial number, MAC, user-defined name and
/// vendor-model-serial.
int camera_found_by();
/// Number of cameras that were opened although they have another serial number than expected.
int wrong_camera_used();
/// Time from the return of a camera that was killed to its first frame, in ms.
double recover_after_kill();
/// Number of correct slices of successive scans on one connection.
int right_slices(double packet_loss, int scans, int slices);
/// Number of triggered frames, over the end of the 16-bit ids, that are missing or wrong.
int lost_over_the_wrap(int frames);

// --- camera_throughput_bench.cpp ---

struct Throughput {
  double frames_per_s = 0.0;
  double core_percent = 0.0;  ///< of the thread that receives
  unsigned long long lost = 0;
  double duration_s = 0.0;
};

/// Frames per second that the simulated camera can send to a receiver that discards them.
double server_frames_per_s();
/// A camera that runs free at 2048 x 2048. link_mbps: 0 = as fast as the machine can.
Throughput run_free(double link_mbps, double rate_hz, double duration_s, bool packet_socket);

// --- camera_scan_bench.cpp ---

/// Duration in seconds of a scan of 200 slices of 1024 x 1024 pixels at 5 ms, with a stage that arrives at once.
double step_scan_s(bool computing);
double slices_per_s();

struct Motion {
  double speedup = 0.0;      ///< time of a step scan over that of a continuous one
  double error_ratio = 0.0;  ///< RMS error of the continuous scan over that of the step scan
};
Motion run_motion();
/// Prints the position that was assigned to a frame minus the true one in the middle of its exposure.
void print_position_error();

}  // namespace fvd::test
