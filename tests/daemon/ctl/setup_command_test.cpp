/// fvdctl setup with its answers from a script.

#include <sstream>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "daemon/config/config_file.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/fvdctl.hpp"
#include "gtest/gtest.h"
#include "sim/plant/plant.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/set_up_station.hpp"

namespace fvd::ctl {
namespace {

struct Scripted {
  int code = -1;
  std::string out;
  std::string err;
};

Scripted setup_with(const test::ScratchDir& folder, const std::string& answers, const std::vector<std::string>& more) {
  const auto script = folder / "answers.txt";
  test::write_text(script, answers);
  const int fd = ::open(script.c_str(), O_RDONLY | O_CLOEXEC);
  std::vector<std::string> words{"setup",
                                 "--out",
                                 (folder / "fvd.json").string(),
                                 "--drives",
                                 FVD_SOURCE_DIR "/config/drives",
                                 "--pictures",
                                 folder.path().string(),
                                 "--no-search"};
  words.insert(words.end(), more.begin(), more.end());
  std::ostringstream out;
  std::ostringstream err;
  Scripted run;
  run.code = run_fvdctl(words, {out, err, false, false, fd});
  ::close(fd);
  run.out = out.str();
  run.err = err.str();
  return run;
}

std::string to_the_drive(sim::Plant& plant) {
  return plant.camera_address() + "\ntcp 127.0.0.1:" + std::to_string(plant.stage_port()) +
         "\n" FVD_SOURCE_DIR "/config/drives/oriental-az.json\n1\nyes\n";
}

TEST(SetupCommand, TakesItsAnswersFromAScript) {
  sim::Plant plant(test::letter_f_station({true, {true, false}}));
  const test::ScratchDir folder;
  const Scripted run = setup_with(folder,
                                  to_the_drive(plant) +
                                      "-500 500\nhome\njog\nyes\njog\nno\nat 300\nat -50\nauto\nok\nup 80\nok\n"
                                      "mirrored\nupright\n0.5\nskip\nwrite\n",
                                  {"--simulated", "--json"});
  ASSERT_EQ(run.code, kExitOk) << run.err << run.out;
  std::istringstream lines(run.out);
  nlohmann::json last;
  for (std::string line; std::getline(lines, line);) last = nlohmann::json::parse(line);
  EXPECT_EQ(last["written"], (folder / "fvd.json").string());
  const LoadedConfig loaded = load_config(folder / "fvd.json");
  EXPECT_TRUE(loaded.problems.empty()) << to_text(loaded.problems, "fvd.json");
  EXPECT_TRUE(loaded.config.stage.reversed);
  EXPECT_TRUE(loaded.config.camera.mirror_x);
  EXPECT_TRUE(loaded.config.camera.simulated);
}

TEST(SetupCommand, WritesNothingWhereTheAnswersEndTooEarly) {
  sim::Plant plant(test::letter_f_station({}));
  const test::ScratchDir folder;
  const Scripted run = setup_with(folder, to_the_drive(plant), {});
  EXPECT_EQ(run.code, kExitBadData);
  EXPECT_NE(run.err.find("the answers end at the question 'travel'"), std::string::npos) << run.err;
  EXPECT_NE(run.out.find("[travel] Between which"), std::string::npos) << run.out;
  EXPECT_EQ(folder.entries(), std::set<std::string>{"answers.txt"});
  EXPECT_EQ(plant.drive().moves(), 0);
}

TEST(SetupCommand, NeedsSomebodyWhoAnswers) {
  std::ostringstream out;
  std::ostringstream err;
  EXPECT_EQ(run_fvdctl({"setup"}, {out, err, false, false}), kExitUsage) << err.str();
}

}  // namespace
}  // namespace fvd::ctl
