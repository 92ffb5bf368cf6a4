#include "daemon/resources/file_stream.hpp"

#include <filesystem>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

UniqueFd opened_for_reading(const std::filesystem::path& path) { return UniqueFd(::open(path.c_str(), O_RDONLY)); }

std::string all_pieces(FileStream& stream) {
  std::string bytes;
  for (std::string piece = stream.next(); !piece.empty(); piece = stream.next()) {
    EXPECT_LE(piece.size(), 256U << 10U);
    bytes += piece;
  }
  return bytes;
}

TEST(FileStream, GivesTheFileInPieces) {
  const test::ScratchDir scratch;
  std::string content;
  for (int i = 0; i < 150000; ++i) content += std::to_string(i);
  test::write_text(scratch / "file", content);

  FileStream whole(opened_for_reading(scratch / "file"), 0, content.size());
  FileStream part(opened_for_reading(scratch / "file"), 70000, 300001);
  FileStream none(opened_for_reading(scratch / "file"), 5, 0);

  EXPECT_TRUE(all_pieces(whole) == content);
  EXPECT_TRUE(all_pieces(part) == content.substr(70000, 300001));
  EXPECT_EQ(all_pieces(none), "");
  EXPECT_EQ(whole.next(), "") << "nothing more";
}

TEST(FileStream, GoesOnWithAFileThatIsReplacedOrRemoved) {
  const test::ScratchDir scratch;
  const std::string content(600000, 'a');
  test::write_text(scratch / "file", content);
  FileStream stream(opened_for_reading(scratch / "file"), 0, content.size());
  std::string bytes = stream.next();

  test::write_text(scratch / "new", std::string(600000, 'b'));
  std::filesystem::rename(scratch / "new", scratch / "file");
  std::filesystem::remove(scratch / "file");

  EXPECT_TRUE(bytes + all_pieces(stream) == content);
}

TEST(FileStream, EndsWithAnErrorWhereTheFileBecomesShorter) {
  const test::ScratchDir scratch;
  test::write_text(scratch / "file", std::string(600000, 'a'));
  FileStream stream(opened_for_reading(scratch / "file"), 0, 600000);
  EXPECT_EQ(stream.next().size(), 256U << 10U);

  std::filesystem::resize_file(scratch / "file", 300000);

  EXPECT_EQ(stream.next().size(), 300000U - (256U << 10U));
  FVD_EXPECT_ERROR(kInternal, (void)stream.next());
  FileStream folder(UniqueFd(::open(scratch.path().c_str(), O_RDONLY | O_DIRECTORY)), 0, 10);
  FVD_EXPECT_ERROR(kInternal, (void)folder.next());
}

}  // namespace
}  // namespace fvd
