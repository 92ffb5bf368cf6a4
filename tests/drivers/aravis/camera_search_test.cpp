/// By which names a camera is found, and which camera is refused.

#include "drivers/aravis/camera_search.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "tests/drivers/aravis/aravis_camera_fixture.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::AnAravisCamera;
using testing::AllOf;
using testing::HasSubstr;

class ANamedCamera : public AnAravisCamera {
 protected:
  ANamedCamera() {
    sim::GigeCameraOptions options;
    options.serial = "S-4711";
    options.name = "left";
    serve(options);
  }

  [[nodiscard]] CameraConfig called(const std::string& name) const {
    CameraConfig wanted = config();
    wanted.address = name;
    wanted.search_address = address_;  // simulated cameras hear no broadcasts here
    return wanted;
  }
};

TEST_F(ANamedCamera, IsFoundByEveryNameItHas) {
  const auto known = identify_camera(address_, std::chrono::seconds(5));
  ASSERT_TRUE(known.has_value());
  EXPECT_EQ(known->serial, "S-4711");
  EXPECT_EQ(known->user_name, "left");
  std::string dashed = known->mac;
  for (char& c : dashed) c = c == ':' ? '-' : c;
  for (const std::string& name : {address_, std::string("S-4711"), std::string("s-4711"), known->mac, dashed,
                                  std::string("left"), std::string("fvd-SimulatedCamera-S-4711")}) {
    SCOPED_TRACE(name);
    const auto camera = open_aravis_camera(called(name));
    EXPECT_EQ(camera->info().serial, "S-4711");
    EXPECT_EQ(camera->info().address, address_);
    EXPECT_EQ(camera->info().firmware, "1.0");
    camera->configure(settings());
    EXPECT_TRUE(shoot(*camera).has_value());
  }
}

TEST_F(ANamedCamera, IsListedWhereAnotherOneWasAskedFor) {
  FVD_EXPECT_ERROR_SAYING(kCameraDisconnected, (void)open_aravis_camera(called("right")),
                          AllOf(HasSubstr("'right'"), HasSubstr("fvd-SimulatedCamera-S-4711"), HasSubstr(address_),
                                HasSubstr("named left")));
}

TEST_F(ANamedCamera, IsRefusedWhereAnotherSerialNumberIsExpected) {
  CameraConfig wanted = config();
  wanted.serial = "S-4712";
  FVD_EXPECT_ERROR_SAYING(kCameraDisconnected, (void)open_aravis_camera(wanted),
                          AllOf(HasSubstr("S-4712"), HasSubstr("S-4711"), HasSubstr("another camera")));
  wanted.serial = "s-4711";
  EXPECT_NO_THROW((void)open_aravis_camera(wanted));
}

TEST(ACameraSearch, RefusesAnEmptyName) {
  FVD_EXPECT_ERROR_SAYING(kBadConfig, (void)find_camera({}), HasSubstr("serial number"));
}

TEST(ACameraSearch, TellsThatNobodyAnswers) {
  CameraConfig config;
  config.address = "nobody";
  config.search_address = sim::free_camera_address();
  FVD_EXPECT_ERROR_SAYING(kCameraDisconnected, (void)find_camera(config),
                          AllOf(HasSubstr("'nobody'"), HasSubstr("no GigE Vision camera answers"), HasSubstr("USB")));
}

class AUsbBus : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) const {
    const auto path = folder_.path() / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << '\n';
  }
  void plug_in(const std::string& name, const std::string& serial) const {
    write("sys/" + name + "/manufacturer", "Basler");
    write("sys/" + name + "/product", "daA3840-45um");
    write("sys/" + name + "/serial", serial);
    write("sys/" + name + "/busnum", "2");
    write("sys/" + name + "/devnum", "7");
    for (const char* interface : {":1.0", ":1.1"}) {
      write("sys/" + name + interface + "/bInterfaceClass", "ef");
      write("sys/" + name + interface + "/bInterfaceSubClass", "05");
    }
    write("sys/" + name + "x:1.0/bInterfaceClass", "03");
  }
  [[nodiscard]] std::optional<std::vector<UsbCamera>> list() const {
    return list_usb_cameras(folder_.path() / "sys", folder_.path() / "dev");
  }

  test::ScratchDir folder_;
};

TEST_F(AUsbBus, IsMissing) { EXPECT_FALSE(list().has_value()); }

TEST_F(AUsbBus, HasNoCamera) {
  write("sys/usb1/idVendor", "1d6b");
  ASSERT_TRUE(list().has_value());
  EXPECT_TRUE(list()->empty());
}

TEST_F(AUsbBus, ListsACameraOnceWithOrWithoutPermission) {
  plug_in("2-1", "40012345");
  auto cameras = list();
  ASSERT_TRUE(cameras && cameras->size() == 1);
  EXPECT_FALSE(cameras->front().accessible) << "there is no such file";
  EXPECT_EQ(cameras->front().id(), "Basler-daA3840-45um-40012345");
  EXPECT_THAT(cameras->front().node, HasSubstr("dev/002/007"));
  EXPECT_TRUE(cameras->front().is_called("40012345"));
  EXPECT_TRUE(cameras->front().is_called("basler-daA3840-45um-40012345"));
  EXPECT_FALSE(cameras->front().is_called(""));
  write("dev/002/007", "");
  cameras = list();
  ASSERT_TRUE(cameras && cameras->size() == 1);
  EXPECT_TRUE(cameras->front().accessible);
}

}  // namespace
}  // namespace fvd
