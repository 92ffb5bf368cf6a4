#pragma once

/// The daemon and the simulated microscope in one process, joined by nothing but sockets.

#include <algorithm>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/app.hpp"
#include "daemon/config/config_file.hpp"
#include "gtest/gtest.h"
#include "sim/plant/plant.hpp"
#include "tests/support/line_client.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {

class AMicroscope : public testing::Test {
 protected:
  static sim::PlantOptions options() {
    sim::PlantOptions options;
    options.axis = {.encoder_noise_um = 0.01, .settle_noise_um = 0.02, .start_latency_ms = 3.0};
    return options;
  }

  /// Starts plant and daemon and waits until the daemon is ready.
  void start(const sim::PlantOptions& with = options()) {
    if (!plant_) plant_ = std::make_unique<sim::Plant>(with);
    const LoadedConfig loaded = load_config(
        FVD_SOURCE_DIR "/config/fvd-sim.json",
        {"camera.address=" + plant_->camera_address(), "stage.port=" + std::to_string(plant_->stage_port()),
         std::string("stage.driver=") + (with.gcs ? "gcs" : "modbus"), "rpc.port=0", "rpc.loopback_role=administer",
         "log.level=warn", "paths.state_dir=" + (folder_.path() / "state").string(),
         "paths.runtime_dir=" + (folder_.path() / "run").string()});
    ASSERT_TRUE(loaded.problems.empty()) << to_text(loaded.problems, "fvd-sim.json");
    config_ = loaded.config;
    app_ = std::make_unique<App>(config_);
    ASSERT_TRUE(wait_until_ready()) << ask("system.state", {}).dump();
  }

  /// The result, or the error as an object with the key "code".
  nlohmann::json ask(const std::string& method, const nlohmann::json& params) {
    LineClient client(app_->rpc_port());
    const auto answer = nlohmann::json::parse(
        client.ask(nlohmann::json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump()));
    return answer.contains("result") ? answer["result"] : answer["error"];
  }

  bool wait_until_ready(std::chrono::seconds within = std::chrono::seconds(15)) {
    const auto deadline = std::chrono::steady_clock::now() + within;
    while (std::chrono::steady_clock::now() < deadline) {
      if (ask("system.state", nlohmann::json::object())["ready"] == true) return true;
      std::this_thread::yield();
    }
    return false;
  }

  nlohmann::json begin(std::int64_t seq, const std::string& recipe = "chapter") {
    return ask("job.start", {{"seq", seq}, {"part_id", "part-" + std::to_string(seq)}, {"recipe", recipe}});
  }

  /// The job's status once it has ended.
  nlohmann::json await_end(std::int64_t seq) {
    LineClient client(app_->rpc_port());
    client.send(
        nlohmann::json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", "job.wait"}, {"params", {{"seq", seq}}}}.dump() +
        "\n");
    const auto line = client.line(std::chrono::seconds(40));
    EXPECT_TRUE(line.has_value());
    return line ? nlohmann::json::parse(*line)["result"] : nlohmann::json();
  }

  /// Waits until all files of the job's result are made: no verdict waits for the pictures.
  void await_files(std::int64_t seq) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);  // they give way to all else
    while (std::chrono::steady_clock::now() < deadline) {
      const auto files = ask("result.get", {{"seq", seq}, {"format", "complete"}})["result"]["files"];
      const auto is_pending = [](const nlohmann::json& file) { return file.value("state", "") == "pending"; };
      if (std::none_of(files.begin(), files.end(), is_pending)) return;
      std::this_thread::yield();
    }
    ADD_FAILURE() << "files stay pending";
  }

  /// Waits until the job has measured at least `slices` slices.
  void await_slices(std::int64_t seq, int slices) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < deadline) {
      const auto status = ask("job.status", {{"seq", seq}});
      if (status.value("slices_done", 0) >= slices || status.value("done", false)) return;
      std::this_thread::yield();
    }
    ADD_FAILURE() << "the job does not get to slice " << slices;
  }

  [[nodiscard]] std::filesystem::path result_dir(std::int64_t seq) {
    return ask("result.get", {{"seq", seq}, {"format", "full"}}).value("directory", "");
  }

  test::ScratchDir folder_;
  Config config_;
  std::unique_ptr<sim::Plant> plant_;
  std::unique_ptr<App> app_;
};

}  // namespace fvd
