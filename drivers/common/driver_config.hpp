#pragma once

/// Which devices to open and how: plain values, filled by the daemon's configuration.

#include <chrono>
#include <filesystem>
#include <string>

#include "core/base/units.hpp"

namespace fvd {

struct CameraConfig {
  std::string driver = "aravis";  ///< "aravis" or "replay"
  std::string address;  ///< IP, serial number, MAC, user-defined name or vendor-model-serial; an IP needs no search
  std::string serial;   ///< serial number that the camera must have; empty = any
  std::string search_address;     ///< where a camera without an IP is searched; empty = broadcasts on every interface
  int silence_ms = 1000;          ///< a camera that answers nothing for so long is lost, 50..60000
  int packet_size_bytes = 0;      ///< GevSCPSPacketSize, 576..16000; 0 = the largest that comes through
  int packet_delay_ns = 0;        ///< GevSCPD, 0..1e6; 0 = leave it
  bool packet_socket = true;      ///< receive through AF_PACKET where CAP_NET_RAW allows; off on loopback
  int stream_priority = 10;       ///< real-time priority of the receiving thread, 1..99; 0 = none
  std::string usb_mode = "sync";  ///< USB3 Vision: "sync", or "async", which Aravis 0.8.26 does not master
  std::chrono::microseconds time_offset{0};  ///< added to its time stamps where the stage's position is asked for
  int frame_margin_ms = 300;         ///< added to exposure and readout before a frame counts as missing, 10..10000
  bool simulated = false;            ///< stamped into every result; a camera that calls itself simulated sets it too
  std::filesystem::path replay_dir;  ///< driver "replay": folder of recorded slices
};

struct StageConfig {
  std::string driver = "modbus";      ///< "modbus", "gcs" or "replay"
  std::filesystem::path profile;      ///< drive profile, JSON
  std::string transport = "tcp";      ///< "tcp"; serial lines: "rtu" for modbus, "serial" for gcs
  std::string address = "127.0.0.1";  ///< of tcp: host
  int port = 502;
  std::string serial_device;  ///< RTU: best a name below /dev/serial/by-id
  int serial_baud = 115200;
  std::string serial_parity = "even";  ///< "none", "even" or "odd"
  int serial_stop_bits = 1;
  std::chrono::milliseconds quiet{250};  ///< RTU: silence that must follow a doubtful answer; the slowest reply or more
  int unit = 1;                          ///< Modbus unit id, 1..247
  std::chrono::milliseconds response_timeout{200};
  std::string gcs_axis = "1";                  ///< driver "gcs": the axis as the controller calls it
  std::string gcs_feedback = "motor_encoder";  ///< driver "gcs": or "linear_scale"
  Micrometers min{-1000.0};                    ///< software limits, take-up included
  Micrometers max{1000.0};
  Micrometers take_up{20.0};  ///< overshoot below the first slice, >= 3x backlash
  double speed_um_per_s = 1000.0;
  double acceleration_um_per_s2 = 20000.0;
  bool simulated = false;
  std::filesystem::path replay_dir;  ///< driver "replay": folder of recorded slices, the camera's
  double replay_start_um = 0.0;      ///< driver "replay": z of the first slice, and the step
  double replay_step_um = 10.0;
  std::filesystem::path replay_z_file;  ///< driver "replay": z of each slice, one number a line; takes the step's place
  std::string replay_z_unit = "um";     ///< unit of that file: um, mm or m
};

}  // namespace fvd
