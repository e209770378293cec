#include "src/core/transform.hpp"

#include <gtest/gtest.h>

#include "platform/base/random.hpp"

namespace gannet {
namespace {

Eigen::Vector3d random_vector(Random& random, double scale) {
  return scale * Eigen::Vector3d(2 * random.uniform() - 1, 2 * random.uniform() - 1,
                                 2 * random.uniform() - 1);
}

TEST(Transform, inverse_undoes_it) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Transform<Hand, Target> sut{quaternion_from_rotation_vector(random_vector(random, 3)),
                                      random_vector(random, 2)};
    const Eigen::Vector3d r = random_vector(random, 1);
    EXPECT_LT((sut.inverse()(sut(r)) - r).norm(), 1e-12);
  }
}

TEST(Transform, product_applies_the_right_one_first) {
  Random random(2);
  const Transform<World, Body> a{quaternion_from_rotation_vector(random_vector(random, 3)),
                                 random_vector(random, 2)};
  const Transform<Body, Hand> b{quaternion_from_rotation_vector(random_vector(random, 3)),
                                random_vector(random, 2)};
  const Eigen::Vector3d r = random_vector(random, 1);
  EXPECT_LT(((a * b)(r)-a(b(r))).norm(), 1e-12);
}

TEST(RotationVector, goes_there_and_back_also_near_zero) {
  Random random(3);
  for (const double scale : {1.5, 1e-3, 1e-7, 1e-12}) {
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d v = random_vector(random, scale);
      const Eigen::Vector3d back =
          rotation_vector_from_quaternion(quaternion_from_rotation_vector(v));
      EXPECT_LT((back - v).norm(), 1e-9 * scale) << scale;
    }
  }
}

TEST(Rpy, goes_there_and_back) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d v = random_vector(random, 1.4);
    EXPECT_LT((rpy_from_quaternion(quaternion_from_rpy(v.x(), v.y(), v.z())) - v).norm(), 1e-9);
  }
}

TEST(Canonical, is_the_same_rotation_with_scalar_part_not_negative) {
  const Eigen::Quaterniond q(-0.5, 0.5, -0.5, 0.5);
  EXPECT_GE(canonical(q).w(), 0);
  EXPECT_NEAR(canonical(q).angularDistance(q), 0, 1e-12);
}

}  // namespace
}  // namespace gannet
