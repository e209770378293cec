#include "hal/camera/v4l2_controls.hpp"

#include <gtest/gtest.h>

#include "tests/support/scripted_v4l2.hpp"

namespace gannet::hal {
namespace {

class V4l2ControlsTest : public ::testing::Test {
 protected:
  V4l2ControlsTest() {
    device_.controls = {
        {V4L2_CID_BRIGHTNESS, V4L2_CTRL_TYPE_INTEGER, "Brightness", 0, 255, 130},
        {V4L2_CID_AUTO_WHITE_BALANCE, V4L2_CTRL_TYPE_BOOLEAN, "White Balance, Automatic", 0, 1, 1},
        {V4L2_CID_POWER_LINE_FREQUENCY,
         V4L2_CTRL_TYPE_MENU,
         "Power Line Frequency",
         0,
         2,
         2,
         {"Disabled", nullptr, "60 Hz"}}};
    fd_ = system_.open("cam");
  }
  std::string refusal(const std::vector<std::string>& wanted) {
    const auto applied = apply_controls(system_, fd_, "cam", wanted);
    return applied ? "accepted" : applied.error().text;
  }
  int value(std::size_t index) const { return device_.controls[index].value; }

  test::ScriptedV4l2 system_;
  test::ScriptedV4l2::Device& device_ = system_.add("cam");
  int fd_ = -1;
};

TEST_F(V4l2ControlsTest, are_listed_by_the_names_that_people_type) {
  const auto sut = list_controls(system_, fd_);
  ASSERT_EQ(sut.size(), 3u);
  EXPECT_EQ(text_of(sut[0]), "brightness 0 … 255 (0 by default), now 130");
  EXPECT_EQ(text_of(sut[1]), "white_balance_automatic 0, 1 (0 by default), now 1");
  EXPECT_EQ(text_of(sut[2]), "power_line_frequency 0 Disabled, 2 60 Hz (0 by default), now 2");
  EXPECT_TRUE(moves_the_hue(sut));
}

TEST_F(V4l2ControlsTest, are_set_by_number_word_or_menu_entry) {
  EXPECT_EQ(
      refusal({"brightness=17", "white_balance_automatic=false", "power_line_frequency=disabled"}),
      "accepted");
  EXPECT_EQ(value(0), 17);
  EXPECT_EQ(value(1), 0);
  EXPECT_EQ(value(2), 0);
  EXPECT_FALSE(moves_the_hue(list_controls(system_, fd_)));
}

TEST_F(V4l2ControlsTest, an_unknown_one_is_refused_with_the_known_ones) {
  const std::string text = refusal({"brightnes=1"});
  EXPECT_NE(text.find("cam: control 'brightnes' is not there"), std::string::npos);
  EXPECT_NE(text.find("brightness"), std::string::npos);
  EXPECT_NE(text.find("; the device has brightness, white_"), std::string::npos);
}

TEST_F(V4l2ControlsTest, values_that_do_not_fit_are_refused) {
  for (const char* bad : {"brightness=256", "brightness=-1", "brightness=bright",
                          "brightness=", "power_line_frequency=1", "white_balance_automatic=2"})
    EXPECT_NE(refusal({bad}).find("does not fit"), std::string::npos) << bad;
  for (const char* bad : {"brightness", "=3", ""})
    EXPECT_NE(refusal({bad}).find("is not of the form name=value"), std::string::npos) << bad;
  EXPECT_EQ(value(0), 130);
}

TEST_F(V4l2ControlsTest, what_the_driver_refuses_or_changes_is_refused) {
  device_.controls[0].refuse = -EBUSY;
  EXPECT_NE(refusal({"brightness=3"}).find("\"brightness=3\" was refused: Device or resource busy"),
            std::string::npos);
  device_.controls[0].refuse = 0;
  device_.controls[0].keep = [](int value) { return value / 2 * 2; };
  EXPECT_EQ(refusal({"brightness=4"}), "accepted");
  EXPECT_NE(refusal({"brightness=5"}).find("was not kept: the driver made 4 of it"),
            std::string::npos);
}

TEST_F(V4l2ControlsTest, a_later_one_that_undoes_an_earlier_one_is_seen) {
  device_.controls[1].keep = [this](int value) { return device_.controls[0].value = 9, value; };
  EXPECT_NE(refusal({"brightness=5", "white_balance_automatic=0"}).find("the driver made 9 of it"),
            std::string::npos);
  EXPECT_EQ(refusal({"white_balance_automatic=0", "brightness=5"}), "accepted");
}

}  // namespace
}  // namespace gannet::hal
