#include "src/vehicle/allocation.hpp"

#include <gtest/gtest.h>

#include "platform/base/random.hpp"

namespace gannet::vehicle {
namespace {

constexpr Allocation::Axes kFour = {true, true, true, false, false, true};
constexpr Allocation::Axes kSix = {true, true, true, true, true, true};

Allocation frame(const std::string& name, const Allocation::Axes& axes) {
  RovConfig config;
  config.frame = name;
  return *Allocation::create(*thrusters_of(config), axes);
}

Vector6d random_wish(Random& random, const Allocation::Axes& axes, double force, double torque) {
  Vector6d wish = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    if (!axes[static_cast<std::size_t>(i)]) continue;
    wish[i] = (i < 3 ? force : torque) * (2 * random.uniform() - 1);
  }
  return wish;
}

TEST(Allocation, makes_the_wish_exactly_when_it_is_within_reach) {
  Random random(1);
  struct Case {
    const char* frame;
    Allocation::Axes axes;
  };
  for (const Case& c :
       {Case{"vectored", kFour}, Case{"vectored_6dof", kFour}, Case{"vectored_6dof", kSix}}) {
    const Allocation sut = frame(c.frame, c.axes);
    for (int i = 0; i < 500; ++i) {
      const Vector6d wish = random_wish(random, c.axes, 15, 2);
      const auto share = sut.share(wish);
      EXPECT_EQ(share.scale, 1);
      EXPECT_LT((sut.wrench(share.thrusts) - wish).norm(), 1e-9);
      EXPECT_LT(share.unreachable.norm(), 1e-9);
    }
  }
}

TEST(Allocation, keeps_the_direction_when_it_saturates) {
  Random random(2);
  const Allocation sut = frame("vectored_6dof", kSix);
  int saturated = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector6d wish = random_wish(random, kSix, 400, 60);
    const auto share = sut.share(wish);
    saturated += share.scale < 1;
    EXPECT_LT((sut.wrench(share.thrusts) - share.scale * wish).norm(), 1e-9 * wish.norm());
    double fullest = 0;
    for (int k = 0; k < sut.size(); ++k) {
      EXPECT_LE(share.thrusts[k], 51.4 + 1e-9);
      EXPECT_GE(share.thrusts[k], -39.9 - 1e-9);
      fullest = std::max(fullest, std::max(share.thrusts[k] / 51.4, share.thrusts[k] / -39.9));
    }
    if (share.scale < 1) {
      EXPECT_NEAR(fullest, 1, 1e-9);  // and gives all it can
    }
  }
  EXPECT_GT(saturated, 500);
}

TEST(Allocation, has_the_rank_that_the_frame_has) {
  EXPECT_EQ(frame("vectored", kFour).rank(), 4);
  EXPECT_EQ(frame("vectored", {true, true, true, true, false, true}).rank(), 5);
  EXPECT_EQ(frame("vectored_6dof", kSix).rank(), 6);
}

TEST(Allocation, refuses_an_axis_on_which_nothing_acts) {
  RovConfig config;
  const auto sut = Allocation::create(*thrusters_of(config), kSix);
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("'pitch'"), std::string::npos);
}

// Two thrusters side by side at the stern, pushing forward, and one across at the bow: sway and
// yaw hang together.
TEST(Allocation, reports_the_part_that_no_thrust_makes) {
  RovConfig config;
  config.frame = "custom";
  config.thrusters.resize(2);
  config.thrusters[0].position_m = {0.3, 0, 0};
  config.thrusters[0].direction = {0, 1, 0};
  config.thrusters[1].position_m = {0, 0, 0};
  config.thrusters[1].direction = {1, 0, 0};
  const Allocation sut =
      *Allocation::create(*thrusters_of(config), {true, true, false, false, false, true});
  EXPECT_EQ(sut.rank(), 2);
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vector6d wish = random_wish(random, {true, true, false, false, false, true}, 10, 2);
    const auto share = sut.share(wish);
    const Vector6d reached = sut.wrench(share.thrusts);
    EXPECT_LT((reached + share.unreachable - wish).norm(), 1e-9);
    EXPECT_NEAR(reached[5], 0.3 * reached[1], 1e-9);
    EXPECT_NEAR(reached[0], wish[0], 1e-9);
  }
  Vector6d both = Vector6d::Zero();
  both[1] = 10;
  both[5] = 3;
  EXPECT_LT(sut.share(both).unreachable.norm(), 1e-9);
  both[5] = -3;
  EXPECT_GT(sut.share(both).unreachable.norm(), 1);
}

// ArduSub's motor factors: columns of what each motor does to forward, right, up, roll right,
// pitch up, yaw right, written out here independently of the table of directions.
TEST(Allocation, agrees_with_the_motor_factors_of_ardusub) {
  const double vectored[6][6] = {{-1, 1, 0, 0, 0, 1}, {-1, -1, 0, 0, 0, -1}, {1, 1, 0, 0, 0, -1},
                                 {1, -1, 0, 0, 0, 1}, {0, 0, -1, 1, 0, 0},   {0, 0, -1, -1, 0, 0}};
  const double six[8][6] = {{-1, 1, 0, 0, 0, 1}, {-1, -1, 0, 0, 0, -1}, {1, 1, 0, 0, 0, -1},
                            {1, -1, 0, 0, 0, 1}, {0, 0, -1, 1, -1, 0},  {0, 0, -1, -1, -1, 0},
                            {0, 0, -1, 1, 1, 0}, {0, 0, -1, -1, 1, 0}};
  // Body axes are forward, left, up; roll right is +x, pitch up is −y, yaw right is −z.
  const double sign[6] = {1, -1, 1, 1, -1, -1};
  const auto compare = [&](const std::string& name, const double(*factors)[6], int n,
                           const Allocation::Axes& axes) {
    const Allocation sut = frame(name, axes);
    ASSERT_EQ(sut.size(), n);
    for (int i = 0; i < n; ++i) {
      Allocation::Thrusts one;
      one.setZero(n);
      one[i] = 1;
      const Vector6d wrench = sut.wrench(one);
      for (int axis = 0; axis < 6; ++axis) {
        // Forces, the torques that the factors name, and the axes that they leave to zero: the
        // horizontal motors' small roll and pitch, from sitting below the centre, have no factor.
        if (!axes[static_cast<std::size_t>(axis)]) continue;
        if (i < 4 && (axis == 3 || axis == 4)) continue;
        const double expected = factors[i][axis] * sign[axis];
        if (expected == 0) {
          EXPECT_NEAR(wrench[axis], 0, 1e-12) << name << i << axis;
        } else {
          EXPECT_GT(wrench[axis] * expected, 0) << name << i << axis;
        }
      }
    }
  };
  compare("vectored", vectored, 6, {true, true, true, true, false, true});
  compare("vectored_6dof", six, 8, kSix);
}

TEST(Allocation, gives_symmetric_thrusts_for_pure_surge_heave_and_yaw) {
  const Allocation sut = frame("vectored", kFour);
  Vector6d wish = Vector6d::Zero();
  wish[0] = 20;
  auto f = sut.share(wish).thrusts;
  for (const int i : {2, 3}) EXPECT_NEAR(f[i], 20 / 4 * std::sqrt(2.0), 1e-9);
  for (const int i : {0, 1}) EXPECT_NEAR(f[i], -f[2], 1e-9);
  for (const int i : {4, 5}) EXPECT_NEAR(f[i], 0, 1e-9);
  wish.setZero();
  wish[2] = 20;
  f = sut.share(wish).thrusts;
  for (const int i : {4, 5}) EXPECT_NEAR(f[i], -10, 1e-9);
  for (const int i : {0, 1, 2, 3}) EXPECT_NEAR(f[i], 0, 1e-9);
  wish.setZero();
  wish[5] = 2;
  f = sut.share(wish).thrusts;
  EXPECT_LT(f[0], 0);  // front right pushes back and right, so it must pull to turn left
  EXPECT_NEAR(f[1], -f[0], 1e-9);
  EXPECT_NEAR(f[2], -f[0], 1e-9);
  EXPECT_NEAR(f[3], f[0], 1e-9);
}

}  // namespace
}  // namespace gannet::vehicle
