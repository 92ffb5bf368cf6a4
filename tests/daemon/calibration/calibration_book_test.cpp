#include "daemon/calibration/calibration_book.hpp"

#include <set>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/runtime/worker_pool.hpp"
#include "tests/daemon/calibration/some_calibration.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::read_text;
using test::ScratchDir;
using test::write_text;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::UnorderedElementsAre;

Calibration add_z(CalibrationBook& book, const std::string& objective, double alpha_z) {
  return book.add(objective, [alpha_z](Calibration& next) {
    next.z = ZConstants{};
    next.z->alpha_z = alpha_z;
    return std::vector<CalibrationFile>();
  });
}

Calibration add_noise(CalibrationBook& book, const std::string& objective, double noise_um) {
  return book.add(objective, [noise_um](Calibration& next) {
    next.noise = NoiseConstants{noise_um, {}};
    return std::vector<CalibrationFile>();
  });
}

TEST(CalibrationBook, HasNoVersionBeforeTheFirst) {
  const ScratchDir folder;

  const CalibrationBook book(folder / "calibration");

  EXPECT_FALSE(book.current(""));
  EXPECT_FALSE(book.find("cal-0001"));
  EXPECT_THAT(book.versions(), IsEmpty());
  EXPECT_THAT(folder.entries(), IsEmpty());
}

TEST(CalibrationBook, TakesOverWhatANewVersionDoesNotChange) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());

  add_z(book, "10x", 1.01);
  const Calibration second = add_noise(book, "10x", 0.05);

  EXPECT_EQ(second.id, "cal-0002");
  EXPECT_EQ(second.objective, "10x");
  EXPECT_THAT(second.created, MatchesRegex("20[0-9-]+T[0-9:.]+Z"));
  EXPECT_EQ(second.z.value().alpha_z, 1.01);
  EXPECT_EQ(second.noise.value().noise_um, 0.05);
  EXPECT_EQ(book.current("10x"), second);
}

TEST(CalibrationBook, IsReadWhileTheFilesOfAVersionAreWritten) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  const Calibration first = add_z(book, "", 1.01);

  (void)book.add("", [&](Calibration&) {
    EXPECT_EQ(book.current(""), first);  // a job that begins meanwhile
    return std::vector<CalibrationFile>();
  });

  EXPECT_EQ(book.versions().size(), 2U);
}

TEST(CalibrationBook, KeepsOldVersionsAsTheyWere) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  const Calibration first = add_z(book, "", 1.01);

  const Calibration second = add_z(book, "", 1.02);

  EXPECT_EQ(book.find("cal-0001"), first);
  EXPECT_EQ(book.find("cal-0002"), second);
  EXPECT_THAT(book.versions(), ElementsAre(first, second));
}

TEST(CalibrationBook, HoldsTheConstantsOfEachObjectiveApart) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  const Calibration ten = add_z(book, "10x", 1.01);

  const Calibration fifty = add_noise(book, "50x", 0.02);

  EXPECT_EQ(fifty.id, "cal-0002");  // numbered over all
  EXPECT_FALSE(fifty.z);
  EXPECT_EQ(book.current("10x"), ten);
  EXPECT_FALSE(book.current(""));
}

TEST(CalibrationBook, IsTheSameAfterARestart) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  book.add("10x", [](Calibration& next) {
    const Calibration whole = test::whole_calibration();
    next.z = whole.z;
    next.flatness = whole.flatness;
    next.lateral = whole.lateral;
    next.texture = whole.texture;
    return std::vector<CalibrationFile>();
  });
  add_noise(book, "10x", 0.05);

  CalibrationBook next_day(folder.path());

  EXPECT_EQ(next_day.versions(), book.versions());
  EXPECT_EQ(add_noise(next_day, "10x", 0.06).id, "cal-0003");
}

TEST(CalibrationBook, ReadsItsFileBackHoweverLongItIs) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  add_z(book, "", 1.01);
  const std::string text = read_text(folder / "calibration.json");
  write_text(folder / "calibration.json", std::string(2U << 20U, ' ') + text);

  EXPECT_EQ(CalibrationBook(folder.path()).versions(), book.versions());
}

TEST(CalibrationBook, WritesTheFilesThatAVersionNames) {
  const ScratchDir folder;
  CalibrationBook book(folder / "calibration");

  const Calibration made = book.add("", [](Calibration& next) {
    next.flatness = FlatnessConstants{0.1, 0.01, next.id + "-flatness.gsf", {}};
    return std::vector<CalibrationFile>{{next.id + "-flatness.gsf", "heights"}, {next.id + "-sigma.gsf", "errors"}};
  });

  EXPECT_EQ(made.flatness.value().reference, "cal-0001-flatness.gsf");
  EXPECT_EQ(read_text(book.folder() / "cal-0001-flatness.gsf"), "heights");
  EXPECT_EQ(read_text(book.folder() / "cal-0001-sigma.gsf"), "errors");
}

TEST(CalibrationBook, ReplacesFilesOfAVersionThatNeverCameToBe) {
  const ScratchDir folder;
  write_text(folder / "cal-0001-flatness.gsf", "half of");
  write_text(folder / "calibration.json.new", "{\"format\": 1, \"vers");
  CalibrationBook book(folder.path());

  book.add("", [](Calibration&) { return std::vector<CalibrationFile>{{"cal-0001-flatness.gsf", "whole"}}; });

  EXPECT_EQ(read_text(folder / "cal-0001-flatness.gsf"), "whole");
  EXPECT_THAT(folder.entries(), UnorderedElementsAre("calibration.json", "cal-0001-flatness.gsf"));
  EXPECT_EQ(CalibrationBook(folder.path()).versions().size(), 1U);
}

TEST(CalibrationBook, ChangesNothingWhereAFileCannotBeWritten) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  const Calibration first = add_z(book, "", 1.01);
  const std::string before = read_text(folder / "calibration.json");
  std::filesystem::create_directories(folder / "calibration.json.new" / "in the way");

  FVD_EXPECT_ERROR(kStorageWrite, add_z(book, "", 1.02));

  EXPECT_THAT(book.versions(), ElementsAre(first));
  EXPECT_EQ(read_text(folder / "calibration.json"), before);
}

TEST(CalibrationBook, KeepsNoConstantsThatItCouldNotReadBack) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());

  FVD_EXPECT_ERROR_SAYING(kBadInput, add_z(book, "", 3.0), ::testing::HasSubstr("/versions/0/z/alpha_z"));

  EXPECT_THAT(book.versions(), IsEmpty());
  EXPECT_THAT(folder.entries(), IsEmpty());
}

TEST(CalibrationBook, ChangesNothingWhereTheChangeThrows) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());

  EXPECT_THROW(book.add("", [](Calibration&) -> std::vector<CalibrationFile> { throw std::runtime_error("no"); }),
               std::runtime_error);

  EXPECT_THAT(book.versions(), IsEmpty());
  EXPECT_EQ(add_z(book, "", 1.01).id, "cal-0001");
}

struct Damage {
  std::string text;
  std::string place;
};

TEST(CalibrationBook, RefusesADamagedFileAndSaysWhere) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  add_z(book, "", 1.01);
  add_z(book, "", 1.02);
  const std::string good = read_text(folder / "calibration.json");
  const auto with = [&good](const std::string& old, const std::string& text) {
    std::string changed = good;
    return changed.replace(changed.find(old), old.size(), text);
  };
  const std::vector<Damage> damages{{"", ""},
                                    {"{}", "/format"},
                                    {R"({"format": 1})", "/versions"},
                                    {good.substr(0, good.size() / 2), "line"},
                                    {with("\"alpha_z\": 1.02", "\"alpha_z\": \"1.02\""), "/versions/1/z/alpha_z"},
                                    {with("\"alpha_z\": 1.02", "\"alpha_y\": 1.02"), "/versions/1/z/alpha_z"},
                                    {with("\"alpha_z\": 1.02", "\"alpha_z\": 102"), "/versions/1/z/alpha_z"},
                                    {with("cal-0002", "cal-0001"), "/versions/1/id"},
                                    {with("cal-0001", "cal-0002"), "/versions/0/id"},
                                    {with("\"format\": 1", "\"format\": 2"), "/format"}};

  for (const Damage& damage : damages) {
    write_text(folder / "calibration.json", damage.text);

    FVD_EXPECT_ERROR_SAYING(kBadInput, CalibrationBook(folder.path()),
                            ::testing::AllOf(::testing::HasSubstr("calibration.json"),
                                             ::testing::HasSubstr(damage.place), ::testing::HasSubstr("backup")));
  }
}

TEST(CalibrationBook, RefusesAFileThatCannotBeRead) {
  const ScratchDir folder;
  std::filesystem::create_directory(folder / "calibration.json");

  FVD_EXPECT_ERROR_SAYING(kBadInput, CalibrationBook(folder.path()), ::testing::HasSubstr("calibration.json"));
}

TEST(CalibrationBook, LosesNoPartOfVersionsThatAreMadeAtTheSameTime) {
  const ScratchDir folder;
  CalibrationBook book(folder.path());
  constexpr int kEach = 20;
  WorkerPool pool(4);

  pool.run(4, [&](int task) {
    for (int i = 1; i <= kEach; ++i) {
      if (task == 0) add_z(book, "10x", 1.0 + 0.001 * i);
      if (task == 1) add_noise(book, "10x", 0.01 * i);
      if (task == 2) (void)book.versions();
      if (task == 3) (void)book.current("10x");
    }
  });

  const Calibration last = book.current("10x").value();
  EXPECT_EQ(last.id, "cal-0040");
  EXPECT_DOUBLE_EQ(last.z.value().alpha_z, 1.0 + 0.001 * kEach);
  EXPECT_DOUBLE_EQ(last.noise.value().noise_um, 0.01 * kEach);
  EXPECT_EQ(CalibrationBook(folder.path()).versions(), book.versions());
}

}  // namespace
}  // namespace fvd
