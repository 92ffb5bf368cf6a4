#include "daemon/access/token_file.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

class ATokenFile : public testing::Test {
 protected:
  /// What is wrong with a file of this text.
  std::string refusal_of(const std::string& text) {
    test::write_text(file_, text);
    try {
      (void)read_credentials(file_);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadConfig);
      return error.what();
    }
    return "none";
  }

  test::ScratchDir folder_;
  std::filesystem::path file_ = folder_ / "tokens";
};

TEST_F(ATokenFile, KnowsTheHolderOfATokenAndNobodyElse) {
  const std::string token = new_token();
  const std::string other = new_token();
  EXPECT_NE(token, other);
  EXPECT_EQ(token.size(), 4U + 64U);
  test::write_text(file_, "# who may what\n\n" + credential_of("kiosk-1", Role::kOperate, token).line() + "\r\n  " +
                              credential_of("anna", Role::kAdminister, other).line() + "\n");

  const auto credentials = read_credentials(file_);

  EXPECT_EQ(holder_of(token, credentials), (Identity{"token kiosk-1", Role::kOperate}));
  EXPECT_EQ(holder_of(other, credentials), (Identity{"token anna", Role::kAdminister}));
  for (const std::string& wrong : {std::string(), std::string("x"), token + " ", token.substr(1), new_token(),
                                   credentials.front().hash, std::string(100000, 'a')}) {
    EXPECT_FALSE(holder_of(wrong, credentials)) << wrong.substr(0, 80);
  }
  EXPECT_EQ(test::read_text(file_).find(token), std::string::npos);
}

TEST_F(ATokenFile, SaysWhatIsWrongAndWhere) {
  const std::string good = credential_of("anna", Role::kView, new_token()).line() + "\n";
  EXPECT_EQ(refusal_of(good), "none");
  EXPECT_EQ(refusal_of(""), "none");
  EXPECT_NE(refusal_of(good + "bert view\n").find("tokens, line 2: expected 'name role hash'"), std::string::npos);
  EXPECT_NE(refusal_of(good + good).find("line 2: 'anna' stands there already"), std::string::npos);
  for (const char* role : {"root", "none"}) {
    const std::string refusal = refusal_of(std::string("anna ") + role + " " + std::string(64, 'a'));
    EXPECT_NE(refusal.find("line 1: the second word is no role"), std::string::npos) << role;
  }
  EXPECT_NE(refusal_of("anna view " + std::string(64, 'A')).find("the hash must be"), std::string::npos);
  EXPECT_NE(refusal_of("anna view " + new_token()).find("a token itself does not belong here"), std::string::npos);
  EXPECT_NE(refusal_of("an/na view " + std::string(64, 'a')).find("the name must be"), std::string::npos);
  EXPECT_NE(refusal_of(good.substr(0, good.size() - 1) + " more\n").find("expected"), std::string::npos);
  const std::string secret = new_token();
  for (const std::string& line : {secret + " " + secret, "anna " + secret + " " + secret, "anna view " + secret,
                                  secret + " view " + secret, "anna " + secret}) {
    const std::string refusal = refusal_of(line);
    EXPECT_NE(refusal, "none");
    EXPECT_EQ(refusal.find(secret.substr(0, 12)), std::string::npos) << "no secret stands in a message";
  }
}

TEST_F(ATokenFile, RefusesAFileThatEverybodyMayWriteAndOneThatIsNotThere) {
  test::write_text(file_, "");
  std::filesystem::permissions(file_, std::filesystem::perms::others_write, std::filesystem::perm_options::add);
  EXPECT_THROW((void)read_credentials(file_), Error);
  EXPECT_THROW((void)read_credentials(folder_ / "none"), Error);
  EXPECT_THROW((void)credential_of("a b", Role::kView, "t"), Error);
}

}  // namespace
}  // namespace fvd
