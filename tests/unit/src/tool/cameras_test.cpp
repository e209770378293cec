#include "src/tool/cameras.hpp"

#include <gtest/gtest.h>

#include "tests/support/scripted_v4l2.hpp"

namespace gannet::tool {
namespace {

class CamerasTest : public ::testing::Test {
 protected:
  CamerasTest() {
    device_.modes = {{.width = 640, .height = 480, .rates_hz = {30, 15}},
                     {.fourcc = V4L2_PIX_FMT_GREY, .width = 640, .height = 480, .rates_hz = {60}}};
    device_.controls = {
        {V4L2_CID_AUTO_WHITE_BALANCE, V4L2_CTRL_TYPE_BOOLEAN, "White Balance, Automatic", 0, 1, 1},
        {V4L2_CID_POWER_LINE_FREQUENCY,
         V4L2_CTRL_TYPE_MENU,
         "Power Line Frequency",
         0,
         1,
         1,
         {"Off", "50 Hz"}}};
  }
  test::ScriptedV4l2 system_;
  test::ScriptedV4l2::Device& device_ = system_.add("/dev/video7");
};

TEST_F(CamerasTest, the_list_is_in_the_words_of_the_config) {
  auto camera = look_at(system_, "/dev/video7");
  camera.links = {"/dev/v4l/by-path/usb-1"};
  EXPECT_EQ(text_of({camera}),
            "/dev/video7  Scripted camera (scripted, bus:1)\n"
            "  = /dev/v4l/by-path/usb-1\n"
            "  yuyv 640 × 480 at 30, 15 Hz\n"
            "  GREY (not usable) 640 × 480 at 60 Hz\n"
            "  controls\n"
            "    white_balance_automatic 0, 1 (0 by default), now 1\n"
            "    power_line_frequency 0 Off, 1 50 Hz (0 by default), now 1\n"
            "  its automatic white balance is on, which moves the hue\n");
}

TEST_F(CamerasTest, json_has_the_same) {
  const auto json = json_of({look_at(system_, "/dev/video7")});
  ASSERT_EQ(json["cameras"].size(), 1u);
  const auto& camera = json["cameras"][0];
  EXPECT_EQ(camera["device"], "/dev/video7");
  EXPECT_EQ(camera["formats"][0]["format"], "yuyv");
  EXPECT_EQ(camera["formats"][0]["sizes"][0]["rates_hz"][1], 15);
  EXPECT_EQ(camera["formats"][1]["usable"], false);
  EXPECT_EQ(camera["controls"][0]["value"], 1);
  EXPECT_EQ(camera["controls"][1]["menu"]["1"], "50 Hz");
}

TEST_F(CamerasTest, looking_leaves_the_device_closed_and_tells_what_cannot_be_opened) {
  look_at(system_, "/dev/video7");
  EXPECT_TRUE(look_at(system_, "/dev/video7").problem.empty());
  EXPECT_EQ(look_at(system_, "/dev/video8").problem,
            "/dev/video8: cannot open: No such file or directory");
}

}  // namespace
}  // namespace gannet::tool
