#include "hal/drive/dronecan_node_watch.hpp"

#include <gtest/gtest.h>

namespace gannet::hal::dronecan {
namespace {

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(std::chrono::milliseconds(ms)); }

class NodeWatchTest : public testing::Test {
 protected:
  const std::uint8_t ids_[2] = {21, 22};
  NodeWatch sut_{ids_, std::chrono::seconds(3)};
};

TEST_F(NodeWatchTest, ANodeNeverHeardIsNeitherAliveNorFaulty) {
  EXPECT_FALSE(sut_.is_alive(21, at_ms(0)));
  EXPECT_FALSE(sut_.is_faulty(21));
  EXPECT_EQ(sut_.fault_code(21), 0);
  EXPECT_EQ(sut_.next_to_ask(at_ms(0)), 0);
}

TEST_F(NodeWatchTest, NodesThatAreNotWatchedAreIgnored) {
  sut_.hear(99, NodeStatus{}, at_ms(0));
  EXPECT_FALSE(sut_.is_alive(99, at_ms(0)));
  EXPECT_FALSE(sut_.is_faulty(99));
}

TEST_F(NodeWatchTest, HealthAndModeDecideOnFaults) {
  const auto is_faulty = [&](int health, int mode) {
    sut_.hear(
        21, {.health = static_cast<std::uint8_t>(health), .mode = static_cast<std::uint8_t>(mode)},
        at_ms(0));
    return sut_.is_faulty(21);
  };
  EXPECT_FALSE(is_faulty(NodeStatus::kOk, NodeStatus::kOperational));
  EXPECT_FALSE(is_faulty(NodeStatus::kWarning, NodeStatus::kOperational));
  EXPECT_TRUE(is_faulty(NodeStatus::kError, NodeStatus::kOperational));
  EXPECT_TRUE(is_faulty(NodeStatus::kCritical, NodeStatus::kOperational));
  EXPECT_FALSE(is_faulty(NodeStatus::kOk, NodeStatus::kInitialization));
  EXPECT_TRUE(is_faulty(NodeStatus::kOk, NodeStatus::kMaintenance));
  EXPECT_TRUE(is_faulty(NodeStatus::kOk, NodeStatus::kSoftwareUpdate));
  EXPECT_TRUE(is_faulty(NodeStatus::kOk, 5));  // reserved
}

TEST_F(NodeWatchTest, UnansweredQuestionsAreRepeatedThreeTimesThenSeldom) {
  std::vector<int> asked_ms;
  for (int ms = 0; ms < 25000; ms += 100) {
    sut_.hear(22, NodeStatus{}, at_ms(ms));
    if (sut_.next_to_ask(at_ms(ms)) == 22) asked_ms.push_back(ms);
  }
  EXPECT_EQ(asked_ms, (std::vector<int>{0, 1000, 2000, 12000, 22000}));
}

TEST_F(NodeWatchTest, AnAnswerEndsTheQuestionsUntilTheNodeRestarts) {
  sut_.hear(21, {.uptime_s = 100}, at_ms(0));
  EXPECT_EQ(sut_.next_to_ask(at_ms(0)), 21);
  sut_.hear(21, NodeInfo{});
  EXPECT_EQ(sut_.next_to_ask(at_ms(2000)), 0);
  sut_.hear(21, {.uptime_s = 1}, at_ms(2001));
  EXPECT_FALSE(sut_.nodes()[0].has_info);
  EXPECT_EQ(sut_.nodes()[0].restarts, 1u);
  EXPECT_EQ(sut_.next_to_ask(at_ms(2002)), 21);
}

TEST_F(NodeWatchTest, NodesAreAskedOneAfterTheOther) {
  sut_.hear(21, NodeStatus{}, at_ms(0));
  sut_.hear(22, NodeStatus{}, at_ms(0));
  EXPECT_EQ(sut_.next_to_ask(at_ms(0)), 21);
  EXPECT_EQ(sut_.next_to_ask(at_ms(5)), 22);
  EXPECT_EQ(sut_.next_to_ask(at_ms(10)), 0);
}

}  // namespace
}  // namespace gannet::hal::dronecan
