#pragma once

/// A simulated camera on a loopback address of its own, whose pixels tell the exposure they belong to.

#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/aravis/aravis_camera.hpp"
#include "sim/camera/gige_camera_server.hpp"
#include "sim/world/frame_source.hpp"

namespace fvd::test {

/// Pixels tell the exposure they belong to and where they lie.
class CountingSource final : public sim::FrameSource {
 public:
  [[nodiscard]] int sensor_width() const override { return 320; }
  [[nodiscard]] int sensor_height() const override { return 200; }
  void render(const sim::ExposureRequest& request, std::span<std::byte> out) override {
    for (int y = 0; y < request.height; ++y) {
      for (int x = 0; x < request.width; ++x) {
        const auto i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(request.width) + static_cast<std::size_t>(x);
        const unsigned value = expected(request.exposure_index, x + request.offset_x, y + request.offset_y);
        if (request.format == PixelFormat::kMono8) {
          out[i] = static_cast<std::byte>(value & 0xFFU);
        } else {
          const auto wide = static_cast<std::uint16_t>(value & static_cast<unsigned>(max_grey_level(request.format)));
          std::memcpy(&out[2 * i], &wide, 2);
        }
      }
    }
  }
  static unsigned expected(std::uint64_t exposure, int x, int y) {
    return static_cast<unsigned>(exposure) * 37U + static_cast<unsigned>(x) * 3U + static_cast<unsigned>(y) * 5U;
  }
};

/// Another program that controls the camera, for as long as it lives.
class Controller {
 public:
  explicit Controller(const std::string& address) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in camera{};
    camera.sin_family = AF_INET;
    camera.sin_port = htons(3956);
    ::inet_pton(AF_INET, address.c_str(), &camera.sin_addr);
    ::connect(socket_, reinterpret_cast<const sockaddr*>(&camera), sizeof camera);
    // WRITEREG of the control channel privilege.
    constexpr std::array<std::uint8_t, 16> kTake{0x42, 1, 0, 0x82, 0, 8, 0, 1, 0, 0, 0x0A, 0, 0, 0, 0, 2};
    std::array<std::uint8_t, 64> answer{};
    ::send(socket_, kTake.data(), kTake.size(), 0);
    EXPECT_EQ(::recv(socket_, answer.data(), answer.size(), 0), 12);
    EXPECT_EQ(answer[0], 0);
  }
  ~Controller() { ::close(socket_); }
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

 private:
  int socket_;
};

class AnAravisCamera : public testing::Test {
 protected:
  void serve(std::uint16_t first_block_id = 1) {
    sim::GigeCameraOptions options;
    options.first_block_id = first_block_id;
    serve(options);
  }
  void serve(sim::GigeCameraOptions options) {
    server_.reset();
    options.address = address_;
    server_ = std::make_unique<sim::GigeCameraServer>(source_, options);
  }

  /// The next steps of the camera's script.
  void fault(const sim::CameraFaultStep& step) { server_->faults().add(step); }

  [[nodiscard]] CameraConfig config() const {
    CameraConfig config;
    config.address = address_;
    config.packet_socket = false;
    config.packet_size_bytes = 1500;
    return config;
  }

  [[nodiscard]] std::unique_ptr<Camera> open(int packet_size = 1500,
                                             std::chrono::milliseconds clock_renewal = std::chrono::seconds(5)) const {
    CameraConfig wanted = config();
    wanted.packet_size_bytes = packet_size;
    return open_aravis_camera(wanted, clock_renewal);
  }

  static CameraSettings settings() {
    CameraSettings settings;
    settings.exposure_us = 1000.0;
    return settings;
  }

  /// Triggers once and returns the frame, if one comes.
  static std::optional<Frame> shoot(Camera& camera) {
    camera.trigger();
    return camera.next_frame(HostClock::now() + camera.frame_deadline());
  }

  /// The exposure the frame shows, checked in its corners and centre.
  static bool shows(const Frame& frame, std::uint64_t exposure, int offset_x = 0, int offset_y = 0) {
    const auto pixel = [&](int x, int y) {
      return frame.image.format == PixelFormat::kMono8 ? static_cast<unsigned>(frame.image.as<std::uint8_t>().at(x, y))
                                                       : frame.image.as<std::uint16_t>().at(x, y);
    };
    const auto mask = static_cast<unsigned>(max_grey_level(frame.image.format));
    for (const int x : {0, frame.image.width / 2, frame.image.width - 1}) {
      for (const int y : {0, frame.image.height / 2, frame.image.height - 1}) {
        if (pixel(x, y) != (CountingSource::expected(exposure, x + offset_x, y + offset_y) & mask)) return false;
      }
    }
    return true;
  }

  CountingSource source_;
  std::string address_ = sim::free_camera_address();
  std::unique_ptr<sim::GigeCameraServer> server_;
};

}  // namespace fvd::test
