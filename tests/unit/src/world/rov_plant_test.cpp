#include "src/world/rov_plant.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "platform/base/random.hpp"

namespace gannet::world {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Neutral and without a righting moment, so that only drag and thrust act.
RovPlantConfig weightless() {
  RovPlantConfig config;
  config.volume_m3 = config.mass_kg / config.water_density_kg_m3;
  config.centre_of_buoyancy_m = {0, 0, 0};
  return config;
}

Vector6d random_velocity(Random& random, double size) {
  Vector6d v;
  for (int i = 0; i < 6; ++i) v[i] = size * (2 * random.uniform() - 1);
  return v;
}

TEST(RovPlant, masses_are_symmetric_and_positive) {
  RovPlantConfig config;
  config.centre_of_gravity_m = {0.02, -0.01, 0.03};
  const RovPlant sut(config);
  for (const Matrix6d& mass : {sut.rigid_mass(), sut.added_mass()}) {
    EXPECT_LT((mass - mass.transpose()).norm(), 1e-12);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(mass).eigenvalues().minCoeff(), 0);
  }
}

TEST(RovPlant, energy_only_decays_without_input) {
  Random random(3);
  for (int run = 0; run < 10; ++run) {
    RovPlantConfig config = weightless();
    config.centre_of_gravity_m = {0, 0, 0};
    RovPlant sut(config);
    sut.set_velocity(random_velocity(random, 1.5));
    double last = sut.kinetic_energy_j();
    for (int i = 0; i < 300; ++i) {
      sut.advance(0.01);
      EXPECT_LE(sut.kinetic_energy_j(), last + 1e-12);
      last = sut.kinetic_energy_j();
    }
  }
}

TEST(RovPlant, energy_is_kept_without_drag) {
  Random random(4);
  RovPlantConfig config = weightless();
  config.linear_drag = config.quadratic_drag = std::vector<double>(6, 0.0);
  RovPlant sut(config);
  sut.set_velocity(random_velocity(random, 1));
  const double before = sut.kinetic_energy_j();
  sut.advance(5);
  EXPECT_NEAR(sut.kinetic_energy_j(), before, 1e-7 * before);
}

TEST(RovPlant, momentum_is_kept_without_water) {
  RovPlantConfig config = weightless();
  config.linear_drag = config.quadratic_drag = config.added_mass = std::vector<double>(6, 0.0);
  RovPlant sut(config);
  Vector6d v;
  v << 0.3, -0.2, 0.5, 1.0, -0.7, 0.4;
  sut.set_velocity(v);
  const Vector3d before = sut.pose().rotation * sut.velocity().linear;
  sut.advance(3);
  EXPECT_LT((sut.pose().rotation * sut.velocity().linear - before).norm(), 1e-8);
}

TEST(RovPlant, terminal_speed_balances_force_and_drag) {
  RovPlant sut(weightless());
  const std::array<double, 8> ahead = {-0.3, -0.3, 0.3, 0.3, 0, 0, 0, 0};
  sut.command(ahead);
  sut.advance(20);
  const double force = sut.thrust()[0];
  EXPECT_NEAR(force, std::sqrt(0.5) * 2 * (6.363 + 8.010), 0.01);
  const double u = sut.velocity().linear.x();
  EXPECT_NEAR(13.7 * u + 141 * u * u, force, 1e-3 * force);
  EXPECT_NEAR(sut.velocity().linear.y(), 0, 1e-6);
  EXPECT_NEAR(sut.velocity().angular.norm(), 0, 1e-6);
}

TEST(RovPlant, each_axis_answers_to_its_thrusters) {
  // ArduSub's signs of vectored_6dof: forward, lateral to the right, up, roll right, nose up, yaw
  // right; ours are x forward, y left, z up and right-handed turns about them.
  struct Case {
    std::array<double, 8> motors;
    int axis;
    double sign;
  };
  const Case cases[] = {{{-1, -1, 1, 1, 0, 0, 0, 0}, 0, 1},   {{1, -1, 1, -1, 0, 0, 0, 0}, 1, -1},
                        {{0, 0, 0, 0, -1, -1, -1, -1}, 2, 1}, {{0, 0, 0, 0, 1, -1, 1, -1}, 3, 1},
                        {{0, 0, 0, 0, -1, -1, 1, 1}, 4, -1},  {{1, -1, -1, 1, 0, 0, 0, 0}, 5, -1}};
  for (const Case& c : cases) {
    RovPlant sut(weightless());
    std::array<double, 8> throttles = c.motors;
    for (double& t : throttles) t *= 0.5;
    sut.command(throttles);
    sut.advance(0.05);
    Vector6d v;
    v << sut.velocity().linear, sut.velocity().angular;
    EXPECT_GT(c.sign * v[c.axis], 0) << "axis " << c.axis;
    EXPECT_GT(v.cwiseAbs()[c.axis], 0.8 * v.norm()) << "axis " << c.axis;
  }
}

TEST(RovPlant, rights_itself) {
  RovPlant sut{RovPlantConfig{}};
  sut.set_pose({quaternion_from_rpy(0.4, -0.3, 1.0), Vector3d::Zero()});
  sut.advance(60);
  const Vector3d rpy = rpy_from_quaternion(sut.pose().rotation);
  EXPECT_NEAR(rpy.x(), 0, 0.03);
  EXPECT_NEAR(rpy.y(), 0, 0.03);
}

TEST(RovPlant, sinks_or_rises_by_its_volume) {
  RovPlantConfig config;
  RovPlant heavy(config);  // 13.5 kg in 13.4 l
  heavy.advance(2);
  EXPECT_LT(heavy.pose().translation.z(), -0.01);
  config.volume_m3 = 0.0136;
  RovPlant light(config);
  light.advance(2);
  EXPECT_GT(light.pose().translation.z(), 0.01);
}

TEST(RovPlant, drifts_with_the_current) {
  RovPlant sut(weightless());
  sut.set_pose({quaternion_from_rpy(0, 0, 0.7), Vector3d::Zero()});
  sut.set_current({0.2, -0.1, 0});
  sut.advance(200);
  const Vector3d drift = sut.pose().rotation * sut.velocity().linear;
  EXPECT_NEAR(drift.x(), 0.2, 0.02);
  EXPECT_NEAR(drift.y(), -0.1, 0.02);
}

TEST(RovPlant, the_quaternion_stays_a_rotation) {
  Random random(5);
  RovPlant sut{RovPlantConfig{}};
  for (int i = 0; i < 200; ++i) {
    std::array<double, 8> throttles{};
    for (double& t : throttles) t = 2 * random.uniform() - 1;
    sut.command(throttles);
    sut.advance(0.02);
    EXPECT_NEAR(sut.pose().rotation.norm(), 1, 1e-12);
  }
}

TEST(RovPlant, repeats_bit_for_bit) {
  const auto run = [] {
    RovPlant sut{RovPlantConfig{}};
    sut.set_current({0.1, 0, 0.02});
    const std::array<double, 8> throttles = {0.2, -0.3, 0.5, 0.1, -0.4, 0.3, 0.2, 0.6};
    sut.command(throttles);
    sut.advance(1);
    return sut.pose();
  };
  const auto a = run();
  const auto b = run();
  EXPECT_EQ(a.translation, b.translation);
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
}

}  // namespace
}  // namespace gannet::world
