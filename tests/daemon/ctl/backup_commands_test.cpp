#include "daemon/ctl/backup_commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/store/job_store.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using test::run_command;
using ::testing::HasSubstr;

class BackupCommands : public testing::Test {
 protected:
  BackupCommands() {
    fs::create_directories(folder_ / "recipes");
    test::write_text(config_,
                     R"({"paths": {"state_dir": ")" + (folder_ / "state").string() + R"(", "recipe_dir": "recipes"}})");
  }
  test::ScratchDir folder_;
  std::string config_ = (folder_ / "fvd.json").string();
  std::string backup_ = (folder_ / "backup").string();
};

TEST_F(BackupCommands, CopyAndPutBack) {
  {
    JobStore store(folder_ / "state" / "fvd.sqlite");
    (void)store.accept({1, "part", "chapter"});
    const auto made = run_command({"backup", backup_, "--config", config_, "--results"});
    ASSERT_EQ(made.code, ctl::kExitOk) << made.err;
    const auto refused = run_command({"restore", backup_, "--config", config_});
    EXPECT_EQ(refused.code, ctl::kExitUnavailable) << "the daemon runs, which is no bug";
    EXPECT_THAT(refused.err, HasSubstr("Stop it first"));
  }
  const auto replaced = run_command({"restore", backup_, "--config", config_});
  ASSERT_EQ(replaced.code, ctl::kExitOk) << replaced.err;
  EXPECT_THAT(replaced.out, HasSubstr("replaced-1"));
  fs::remove_all(folder_ / "state");
  fs::remove(config_);
  const auto restored = run_command({"restore", backup_, "--config", config_});
  ASSERT_EQ(restored.code, ctl::kExitOk) << restored.err;
  EXPECT_TRUE(fs::exists(config_));
  EXPECT_EQ(JobStore(folder_ / "state" / "fvd.sqlite").find(ClientSeq{1}).status.error, ErrorCode::kInterrupted);
}

TEST_F(BackupCommands, SayTheirTargetAndReplaceNoDatabaseThatNoConfigurationNames) {
  const fs::path state = folder_ / "state";
  (void)JobStore(state / "fvd.sqlite").accept({1, "part", "chapter"});
  ASSERT_EQ(run_command({"backup", backup_, "--config", config_}).code, ctl::kExitOk);
  (void)JobStore(state / "fvd.sqlite").accept({2, "part", "chapter"});
  const std::string mistyped = (folder_ / "fdv.json").string();

  const auto refused = run_command({"restore", backup_, "--config", mistyped});

  EXPECT_EQ(refused.code, ctl::kExitBadData);
  EXPECT_THAT(refused.out, ::testing::AllOf(HasSubstr("state folder " + state.string()), HasSubstr(mistyped)));
  EXPECT_THAT(refused.err, ::testing::AllOf(HasSubstr("nothing was restored"), HasSubstr(state.string()),
                                            HasSubstr("copy " + backup_ + "/fvd.json to " + mistyped)));
  EXPECT_FALSE(fs::exists(state / "replaced-1"));
  EXPECT_FALSE(fs::exists(mistyped));
  EXPECT_EQ(JobStore(state / "fvd.sqlite").find(ClientSeq{2}).status.request.seq, 2) << "newer than the backup";

  fs::copy_file(backup_ + "/fvd.json", mistyped);
  const auto meant = run_command({"restore", backup_, "--config", mistyped});
  EXPECT_EQ(meant.code, ctl::kExitOk) << "as the refusal says: " << meant.err;
  EXPECT_TRUE(fs::exists(state / "replaced-1"));
}

TEST_F(BackupCommands, FollowTheFilesOfConfD) {
  const fs::path profile = folder_ / "drive.json";
  const fs::path tokens = folder_ / "tokens";
  test::write_text(config_, "{}");
  fs::create_directories(folder_ / "conf.d");
  test::write_text(folder_ / "conf.d" / "10-station.json",
                   R"({"paths": {"state_dir": ")" + (folder_ / "elsewhere").string() +
                       R"(", "recipe_dir": "recipes"}, "stage": {"profile": "drive.json"},
                       "rpc": {"token_file": "tokens"}})");
  test::write_text(profile, "{}");
  test::write_text(tokens, "kiosk operate 00");
  fs::permissions(tokens, fs::perms::owner_read | fs::perms::owner_write);
  (void)JobStore(folder_ / "elsewhere" / "fvd.sqlite").accept({1, "part", "chapter"});
  const auto made = run_command({"backup", backup_, "--config", config_});
  ASSERT_EQ(made.code, ctl::kExitOk) << made.err;
  fs::remove_all(folder_ / "elsewhere");
  fs::remove_all(folder_ / "conf.d");
  fs::remove(profile);
  fs::remove(tokens);

  const auto restored = run_command({"restore", backup_, "--config", config_});

  ASSERT_EQ(restored.code, ctl::kExitOk) << restored.err;
  EXPECT_EQ(JobStore(folder_ / "elsewhere" / "fvd.sqlite").find(ClientSeq{1}).status.request.seq, 1);
  EXPECT_TRUE(fs::exists(folder_ / "conf.d" / "10-station.json"));
  EXPECT_TRUE(fs::exists(profile));
  EXPECT_EQ(test::read_text(tokens), "kiosk operate 00");
  EXPECT_EQ(fs::status(tokens).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(BackupCommands, GoOnWhereARestorationOfConfDWasCutOff) {
  test::write_text(config_, "{}");
  fs::create_directories(folder_ / "conf.d");
  test::write_text(folder_ / "conf.d" / "10-recipes.json", R"({"paths": {"recipe_dir": "recipes"}})");
  test::write_text(folder_ / "conf.d" / "20-state.json",
                   R"({"paths": {"state_dir": ")" + (folder_ / "elsewhere").string() + R"("}})");
  (void)JobStore(folder_ / "elsewhere" / "fvd.sqlite").accept({1, "part", "chapter"});
  ASSERT_EQ(run_command({"backup", backup_, "--config", config_}).code, ctl::kExitOk);
  fs::remove_all(folder_ / "elsewhere");
  fs::remove(folder_ / "conf.d" / "20-state.json");
  fs::create_directories(folder_ / "conf.d" / ".restored.tmp");

  const auto restored = run_command({"restore", backup_, "--config", config_});

  ASSERT_EQ(restored.code, ctl::kExitOk) << restored.err;
  EXPECT_TRUE(fs::exists(folder_ / "elsewhere" / "fvd.sqlite")) << "where the whole configuration says";
  EXPECT_TRUE(fs::exists(folder_ / "conf.d" / "20-state.json"));
}

TEST_F(BackupCommands, SayWhatIsWrong) {
  EXPECT_EQ(run_command({"backup"}).code, ctl::kExitUsage);
  const auto none = run_command({"backup", backup_, "--config", config_});
  EXPECT_NE(none.code, ctl::kExitOk);
  EXPECT_THAT(none.err, HasSubstr("fvd.sqlite"));
  EXPECT_EQ(none.code, ctl::kExitIo);
  EXPECT_THAT(run_command({"restore", backup_, "--config", config_}).err, HasSubstr("no backup"));
  const auto no_config = run_command({"backup", backup_, "--config", (folder_ / "none.json").string()});
  EXPECT_THAT(no_config.err, HasSubstr("--config"));
  EXPECT_EQ(no_config.code, ctl::kExitBadData);
}

TEST_F(BackupCommands, RefuseWhatWouldNameADaemonAndNotItsFiles) {
  for (const char* command : {"backup", "restore"}) {
    for (const char* option : {"--runtime-dir", "--address"}) {
      const auto refused = run_command({option, "127.0.0.1:1", command, backup_, "--config", config_});
      EXPECT_EQ(refused.code, ctl::kExitUsage) << option;
      EXPECT_THAT(refused.err, ::testing::AllOf(HasSubstr(option), HasSubstr("--config")));
    }
  }
  EXPECT_FALSE(fs::exists(backup_));
}

}  // namespace
}  // namespace fvd
