#include "platform/base/parallel.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace gannet {
namespace {

TEST(Serial, does_each_piece_once_in_order) {
  Serial sut;
  std::vector<int> done;
  sut.for_each(5, [&](int index, int worker) {
    EXPECT_EQ(worker, 0);
    done.push_back(index);
  });
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(sut.workers(), 1);
}

}  // namespace
}  // namespace gannet
