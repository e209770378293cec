#include "platform/linux/step_socket.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/temporary_folder.hpp"

namespace gannet::linux_os {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(StepSocket, a_step_returns_when_the_daemon_has_done_it) {
  const test::TemporaryFolder folder;
  auto world = StepServer::listen(folder / "step");
  ASSERT_TRUE(world);
  std::vector<std::int64_t> steps;
  std::thread daemon([&] {
    auto sut = StepClient::connect(folder / "step", seconds(5));
    ASSERT_TRUE(sut);
    TimePoint t;
    while (sut->receive(t, seconds(5)) == StepClient::Status::kStep) {
      steps.push_back(to_ns(t));
      sut->answer_done(t);
    }
  });
  ASSERT_TRUE(world->wait_for_daemon(seconds(5)));
  for (int i = 1; i <= 3; ++i) ASSERT_TRUE(world->step(time_from_ns(i * 1000), seconds(5)));
  EXPECT_EQ(steps.size(), 3u);
  { const StepServer gone = std::move(*world); }
  daemon.join();
  EXPECT_EQ(steps, (std::vector<std::int64_t>{1000, 2000, 3000}));
}

TEST(StepSocket, the_world_says_when_the_daemon_is_wrong_slow_or_gone) {
  const test::TemporaryFolder folder;
  auto world = StepServer::listen(folder / "step");
  ASSERT_TRUE(world);
  EXPECT_FALSE(world->wait_for_daemon(milliseconds(1)));
  auto daemon = StepClient::connect(folder / "step", seconds(1));
  ASSERT_TRUE(daemon);
  ASSERT_TRUE(world->wait_for_daemon(seconds(1)));
  const auto slow = world->step(time_from_ns(5), milliseconds(1));
  ASSERT_FALSE(slow);
  EXPECT_NE(slow.error().text.find("does not answer"), std::string::npos);
  daemon->answer_done(time_from_ns(4));
  const auto wrong = world->step(time_from_ns(6), seconds(1));
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().text.find("answered for 4"), std::string::npos);
  { const StepClient gone = std::move(*daemon); }
  EXPECT_FALSE(world->step(time_from_ns(7), seconds(1)));
}

TEST(StepSocket, the_daemon_counts_junk_and_notices_the_end) {
  const test::TemporaryFolder folder;
  auto listener = UnixListener::listen(folder / "step", SocketKind::kSeqPacket);
  ASSERT_TRUE(listener);
  auto sut = StepClient::connect(folder / "step", seconds(1));
  ASSERT_TRUE(sut);
  auto world = listener->accept();
  ASSERT_TRUE(world);
  TimePoint t;
  EXPECT_EQ(sut->receive(t, milliseconds(1)), StepClient::Status::kNothing);
  for (const std::string junk : {"step 12", "step \n", "step -4\n", "step 1 2\n", "done 5\n",
                                 "step 99999999999999999999\n", "x"}) {
    world->send(std::as_bytes(std::span(junk)));
    EXPECT_EQ(sut->receive(t, seconds(1)), StepClient::Status::kMalformed) << junk;
  }
  const std::string long_one(100, 'a');
  world->send(std::as_bytes(std::span(long_one)));
  EXPECT_EQ(sut->receive(t, seconds(1)), StepClient::Status::kMalformed);
  world->close();
  EXPECT_EQ(sut->receive(t, seconds(1)), StepClient::Status::kGone);
}

TEST(StepSocket, a_daemon_without_a_world_gives_up) {
  const test::TemporaryFolder folder;
  const auto sut = StepClient::connect(folder / "step", milliseconds(30));
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("clock.step_socket"), std::string::npos);
}

}  // namespace
}  // namespace gannet::linux_os
