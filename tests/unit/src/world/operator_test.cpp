#include "src/world/operator.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <optional>
#include <thread>

#include "src/control/server.hpp"

namespace gannet::world {
namespace {

using control::Json;
using std::chrono::milliseconds;

const Json kStatus = Json::parse(R"({
  "state": "servoing", "permit": "full",
  "estimate": {"state": "locked", "found": true, "frame_number": 7,
    "capture_time_ns": 1500000000, "position_m": [0.1, -0.2, 0.5],
    "quaternion": [1, 0, 0, 0], "fitness": 0.9}})");

TEST(Operator, reads_what_a_trace_keeps) {
  const HeardEstimate heard = heard_from(kStatus, time_from_ns(1'000'000'000));
  EXPECT_EQ(heard.supervisor, "servoing");
  EXPECT_EQ(heard.permit, "full");
  EXPECT_EQ(heard.frame, 7u);
  EXPECT_EQ(heard.state, "locked");
  EXPECT_DOUBLE_EQ(heard.capture_s, 0.5);
  EXPECT_TRUE(heard.found);
  EXPECT_EQ(heard.left_from_target.translation, Eigen::Vector3d(0.1, -0.2, 0.5));
  EXPECT_DOUBLE_EQ(heard.fitness, 0.9);
}

TEST(Operator, a_status_without_a_pose_is_not_found) {
  for (const char* change :
       {R"({"found": false})", R"({"position_m": null})", R"({"position_m": [1, 2]})",
        R"({"quaternion": [1, 0, 0, "x"]})", R"({"found": "yes"})"}) {
    Json status = kStatus;
    status["estimate"].update(Json::parse(change));
    EXPECT_FALSE(heard_from(status, {}).found) << change;
  }
  EXPECT_FALSE(heard_from(Json::object(), {}).found);
  EXPECT_FALSE(heard_from(Json::parse(R"({"estimate": null})"), {}).found);
}

// A daemon's control socket that keeps what it was told.
class OperatorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto server = control::Server::listen(socket_, "");
    ASSERT_TRUE(server) << server.error().text;
    server_ = std::move(*server);
    thread_ = std::thread([this] {
      while (!stop_) {
        server_->serve([this](const control::Request& request) { return answer(request); });
        std::this_thread::sleep_for(milliseconds(1));
      }
    });
    auto sut = Operator::connect(socket_, milliseconds(500));
    ASSERT_TRUE(sut) << sut.error().text;
    sut_.emplace(std::move(*sut));
  }
  void TearDown() override {
    stop_ = true;
    thread_.join();
  }
  control::Answer answer(const control::Request& request) {
    asked_ = request.method + " " + request.params.dump();
    if (request.method == "status") return kStatus;
    if (request.method == "arm")
      return control::Failure{control::ErrorCode::kRefused, "arm is refused", "estop"};
    return Json::object();
  }
  std::string told(const char* action) {
    const auto done = sut_->command(*parse_action(action));
    return done ? asked_ : "error: " + done.error().text;
  }
  const std::string socket_ =
      ::testing::TempDir() + "gannet-operator-test-" + std::to_string(getpid());
  std::unique_ptr<control::Server> server_;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  std::string asked_;
  std::optional<Operator> sut_;
};

TEST_F(OperatorTest, says_commands_as_the_protocol_has_them) {
  EXPECT_EQ(told("target crab"), R"(target {"model":"crab"})");
  EXPECT_EQ(told("target none"), R"(target {"none":true})");
  EXPECT_EQ(told("manual 100 0 -50"),
            R"(manual {"linear_m_s":[0.1,0.0,-0.05],"angular_rad_s":[0.0,0.0,0.0]})");
  EXPECT_EQ(told("goal 10 -20 500"), R"(goal {"mm":[10.0,-20.0,500.0]})");
  EXPECT_EQ(told("reset"), "reset {}");
  EXPECT_EQ(told("disarm"), "disarm {}");
  EXPECT_EQ(told("stop"), "stop {}");
}

TEST_F(OperatorTest, hands_a_refusal_on_in_the_daemons_words) {
  EXPECT_NE(told("arm").find("arm is refused"), std::string::npos);
}

TEST_F(OperatorTest, looks) {
  const auto heard = sut_->look({});
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->frame, 7u);
}

TEST(Operator, says_when_nobody_serves) {
  EXPECT_FALSE(Operator::connect(::testing::TempDir() + "gannet-nobody", milliseconds(20)));
}

}  // namespace
}  // namespace gannet::world
