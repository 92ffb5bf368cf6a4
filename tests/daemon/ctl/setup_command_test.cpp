/// fvdctl setup with its answers from a script.

#include <csignal>
#include <future>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <pty.h>
#include <unistd.h>

#include "daemon/config/config_file.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/fvdctl.hpp"
#include "daemon/ctl/stop_on_signal.hpp"
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

TEST(SetupCommand, EndsAtTheFirstAnswerOfAScriptThatIsRefused) {
  sim::Plant plant(test::letter_f_station({}));
  const test::ScratchDir folder;
  const Scripted run = setup_with(folder, to_the_drive(plant) + "500 -500\n-500 500\nhome\njog\n", {});
  EXPECT_EQ(run.code, kExitBadData);
  EXPECT_NE(run.err.find("the answer '500 -500' to the question 'travel' was refused"), std::string::npos) << run.err;
  EXPECT_EQ(plant.drive().moves(), 0) << "the answers after it were to other questions";
}

/// A terminal: what is to be typed is handed out each time that the program waits for an answer.
class Typist : public std::stringbuf {
 public:
  explicit Typist(std::vector<std::string> lines) : lines_(std::move(lines)) {
    EXPECT_EQ(::openpty(&keyboard_, &screen_, nullptr, nullptr, nullptr), 0);
  }
  ~Typist() override {
    if (keyboard_ >= 0) ::close(keyboard_);
    ::close(screen_);
  }
  [[nodiscard]] int fd() const { return screen_; }

 protected:
  int sync() override {
    if (!str().ends_with("> ")) return 0;
    if (typed_ < lines_.size()) {
      const std::string& line = lines_[typed_++];
      EXPECT_EQ(::write(keyboard_, line.data(), line.size()), static_cast<ssize_t>(line.size()));
    } else if (keyboard_ >= 0) {
      ::close(std::exchange(keyboard_, -1));
    }
    return 0;
  }

 private:
  const std::vector<std::string> lines_;
  std::size_t typed_ = 0;
  int keyboard_ = -1;
  int screen_ = -1;
};

TEST(SetupCommand, TakesNothingThatWasTypedBeforeItsQuestion) {
  const test::ScratchDir folder;
  Typist typist({"two words\nthree more words\n", "these are four words\n"});
  std::ostream out(&typist);
  std::ostringstream err;
  EXPECT_EQ(
      run_fvdctl({"setup", "--no-search", "--pictures", folder.path().string()}, {out, err, true, true, typist.fd()}),
      kExitBadData);
  const std::string told = typist.str();
  EXPECT_NE(told.find("'two words' is none"), std::string::npos) << told;
  EXPECT_EQ(told.find("'three more words' is none"), std::string::npos) << told;
  EXPECT_NE(told.find("'these are four words' is none"), std::string::npos) << "on a terminal it asks again";
}

TEST(ATerminalThatIsClosed, StopsWhatMoves) {
  const StopOnSignal signal;
  std::promise<void> stopped;
  const std::stop_callback told(signal.token(), [&stopped] { stopped.set_value(); });
  ::kill(::getpid(), SIGHUP);
  EXPECT_EQ(stopped.get_future().wait_for(std::chrono::seconds(30)), std::future_status::ready);
}

TEST(SetupCommand, NeedsSomebodyWhoAnswers) {
  std::ostringstream out;
  std::ostringstream err;
  EXPECT_EQ(run_fvdctl({"setup"}, {out, err, false, false}), kExitUsage) << err.str();
}

}  // namespace
}  // namespace fvd::ctl
