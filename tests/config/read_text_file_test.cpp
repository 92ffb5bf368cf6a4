/// Files that are no texts of a sensible size, and disks that fail.

#include <gtest/gtest.h>

#include "config/strict_json.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

TEST(ReadTextFile, EndsWhereADeviceDoesNot) {
  test::expect_error(ErrorCode::kBadInput, {"/dev/zero", "larger than 1 MiB"},
                     [] { (void)read_text_file("/dev/zero", 1U << 20U); });
}

TEST(ReadTextFile, TakesAFileOfTheLargestSizeAndNoLarger) {
  const test::ScratchDir folder;
  test::write_text(folder / "text", std::string(1U << 20U, 'x'));
  EXPECT_EQ(read_text_file(folder / "text", 1U << 20U).size(), 1U << 20U);
  test::write_text(folder / "text", std::string((1U << 20U) + 1, 'x'));
  test::expect_error(ErrorCode::kBadInput, {"larger than 1 MiB"},
                     [&] { (void)read_text_file(folder / "text", 1U << 20U); });
}

TEST(ReadTextFile, SaysWhyTheDiskDoesNotGiveIt) {
  test::expect_error(ErrorCode::kBadInput, {"/proc/self/mem", "does not give it: Input/output error"},
                     [] { (void)read_text_file("/proc/self/mem"); });
}

}  // namespace
}  // namespace fvd
