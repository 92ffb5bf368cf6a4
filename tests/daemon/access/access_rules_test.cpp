#include "daemon/access/access_rules.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "daemon/access/token_file.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

Role role_at(const AccessRules& rules, const char* address) {
  return rules.of_address(address_bytes(address).value(), address).role;
}

TEST(AccessRules, TakeTheNarrowestRuleForAnAddress) {
  AccessConfig config;
  config.allow = {{"192.168.1.0/24", Role::kView}, {"192.168.1.10", Role::kOperate}, {"192.168.1.8/29", Role::kSetUp}};
  const AccessRules rules(config);
  EXPECT_EQ(role_at(rules, "192.168.1.10"), Role::kOperate);
  EXPECT_EQ(role_at(rules, "192.168.1.11"), Role::kSetUp);
  EXPECT_EQ(role_at(rules, "192.168.1.77"), Role::kView);
  EXPECT_EQ(role_at(rules, "192.168.2.10"), Role::kNone);
  EXPECT_EQ(role_at(rules, "127.0.0.1"), Role::kOperate) << "the default of loopback";
  EXPECT_EQ(rules.of_address(address_bytes("192.168.1.10").value(), "192.168.1.10").name, "address 192.168.1.10");
}

TEST(AccessRules, GiveLoopbackWhatTheConfigurationSays) {
  AccessConfig config;
  config.loopback_role = Role::kView;
  EXPECT_EQ(role_at(AccessRules(config), "::1"), Role::kView);
  config.allow = {{"127.0.0.0/8", Role::kAdminister}};
  EXPECT_EQ(role_at(AccessRules(config), "127.0.0.1"), Role::kAdminister);
  EXPECT_EQ(role_at(AccessRules(config), "::1"), Role::kView);
}

TEST(AccessRules, KnowLocalProcessesByUserAndGroup) {
  AccessConfig config;
  config.groups = {{"daemon", Role::kOperate}, {"bin", Role::kView}, {"no-such-group", Role::kAdminister}};
  const AccessRules rules(config);
  constexpr uid_t kSomebody = 54321;
  constexpr gid_t kDaemon = 1;  // of every Debian, as is bin
  constexpr gid_t kBin = 2;
  EXPECT_EQ(rules.of_local_peer({1, 0, {}}).role, Role::kAdminister);
  EXPECT_EQ(rules.of_local_peer({1, ::geteuid(), {}}).role, Role::kAdminister);
  EXPECT_EQ(rules.of_local_peer({1, kSomebody, {}}).role, Role::kNone);
  EXPECT_EQ(rules.of_local_peer({1, kSomebody, {kBin}}).role, Role::kView);
  EXPECT_EQ(rules.of_local_peer({1, kSomebody, {kDaemon, kBin, 777}}).role, Role::kOperate);
  EXPECT_EQ(rules.of_local_peer({1, kSomebody, {kBin}}).name, "uid 54321");
}

TEST(AccessRules, LookATokenUpInTheFileAsItIsNow) {
  const test::ScratchDir folder;
  AccessConfig config;
  EXPECT_FALSE(AccessRules(config).of_token("x"));
  config.token_file = folder / "tokens";
  const AccessRules rules(config);
  const std::string token = new_token();
  test::write_text(config.token_file, credential_of("kiosk", Role::kOperate, token).line());
  EXPECT_EQ(rules.of_token(token), (Identity{"token kiosk", Role::kOperate}));
  test::write_text(config.token_file, "");
  EXPECT_FALSE(rules.of_token(token)) << "it was taken out";
}

}  // namespace
}  // namespace fvd
