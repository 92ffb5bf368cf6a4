/// Cameras whose description differs from the simulated camera's own.

#include <gmock/gmock.h>

#include "tests/drivers/aravis/aravis_camera_fixture.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using test::AnAravisCamera;
using testing::AllOf;
using testing::HasSubstr;

class ADescription : public AnAravisCamera {
 protected:
  using Edits = std::vector<std::pair<std::string, std::string>>;

  /// A camera with its description changed: every first text is replaced by the second, wherever it stands.
  std::unique_ptr<Camera> open_with(const Edits& edits) {
    sim::GigeCameraOptions options;
    options.edit_description = [edits](std::string xml) {
      for (const auto& [from, to] : edits) {
        std::size_t at = xml.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        for (; at != std::string::npos; at = xml.find(from, at + to.size())) xml.replace(at, from.size(), to);
      }
      return xml;
    };
    serve(options);
    return open();
  }
};

TEST_F(ADescription, WithIncrementsGivesTheLargestSizeOnTheirGrid) {
  const auto camera = open_with(
      {{"<Min>1</Min><pMax>SensorWidth</pMax><Inc>1</Inc>", "<Min>16</Min><pMax>SensorWidth</pMax><Inc>24</Inc>"},
       {"<Min>1</Min><pMax>SensorHeight</pMax><Inc>1</Inc>", "<Min>2</Min><pMax>SensorHeight</pMax><Inc>4</Inc>"}});
  const CameraSettings in_force = camera->configure(settings());
  EXPECT_EQ(in_force.width, 16 + 12 * 24);
  EXPECT_EQ(in_force.height, 198);
  const auto frame = shoot(*camera);
  ASSERT_TRUE(frame && frame->status == FrameStatus::kOk);
  EXPECT_EQ(frame->image.width, 304);
}

/// A register of 4 bytes that takes any value.
std::string spare_register(const std::string& name, int index, const std::string& limits) {
  return "<Integer Name=\"" + name + "\" NameSpace=\"Standard\"><pValue>" + name + "Reg</pValue>" + limits +
         "</Integer>\n<IntReg Name=\"" + name + "Reg\" NameSpace=\"Custom\"><Address>" +
         std::to_string(0x20060 + 4 * index) +
         "</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort><Cachable>NoCache</Cachable>"
         "<Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></IntReg>\n<Port Name=\"Device\"";
}

TEST_F(ADescription, WithGainRawAloneTakesItInItsOwnUnit) {
  const auto camera =
      open_with({{"\"Gain\"", "\"OtherGain\""},
                 {"<Port Name=\"Device\"", spare_register("GainRaw", 0, "<Min>34</Min><Max>500</Max>")}});
  CameraSettings wanted = settings();
  EXPECT_EQ(camera->configure(wanted).gain_raw, 34) << "the least";
  wanted.gain_raw = 300;
  EXPECT_EQ(camera->configure(wanted).gain_raw, 300);
  wanted.gain_raw = 501;
  FVD_EXPECT_ERROR_SAYING(kCameraSettings, camera->configure(wanted),
                          AllOf(HasSubstr("GainRaw"), HasSubstr("34 to 500")));
  wanted.gain_raw = -1;
  wanted.gain_db = 6.0;
  FVD_EXPECT_ERROR_SAYING(kCameraSettings, camera->configure(wanted),
                          AllOf(HasSubstr("not in dB"), HasSubstr("34 to 500")));
}

TEST_F(ADescription, WithGainInDecibelsRefusesARawOne) {
  serve();
  const auto camera = open();
  CameraSettings wanted = settings();
  wanted.gain_raw = 3;
  FVD_EXPECT_ERROR_SAYING(kCameraSettings, camera->configure(wanted), HasSubstr("gain_db"));
}

/// The register of a feature, as it is described, with its access mode.
std::pair<std::string, std::string> write_only(int address) {
  const std::string at = "<Address>" + std::to_string(address) + "</Address><Length>4</Length><AccessMode>";
  return {at + "RW", at + "WO"};
}

TEST_F(ADescription, WithTriggerSelectorsToBeWrittenOnlyIsTriggered) {
  const auto camera = open_with({write_only(0x20034), write_only(0x20030)});
  for (const double exposure_us : {1000.0, 2000.0}) {
    CameraSettings wanted = settings();
    wanted.exposure_us = exposure_us;
    camera->configure(wanted);
    const auto frame = shoot(*camera);
    ASSERT_TRUE(frame && frame->status == FrameStatus::kOk);
  }
}

TEST_F(ADescription, ThatIsDamagedGivesOneMessage) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const auto error = test::error_of([&] { (void)open_with({{"</Category>", "</Catgory>"}, {"<pValue>", "<pVaule"}}); });
  const std::string out = testing::internal::GetCapturedStdout();
  const std::string err = testing::internal::GetCapturedStderr();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code(), ErrorCode::kCameraDisconnected);
  EXPECT_THAT(error->what(), AllOf(HasSubstr(address_), HasSubstr("description")));
  EXPECT_LT(std::count(err.begin(), err.end(), '\n') + std::count(out.begin(), out.end(), '\n'), 5) << err << out;
}

TEST_F(ADescription, ThatIsCutOffGivesOneMessage) {
  sim::GigeCameraOptions options;
  options.edit_description = [](const std::string& xml) { return xml.substr(0, xml.size() / 2); };
  serve(options);
  FVD_EXPECT_ERROR_SAYING(kCameraDisconnected, (void)open(), HasSubstr("description"));
}

}  // namespace
}  // namespace fvd
