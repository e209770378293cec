#include "src/world/operator_link.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <thread>

#include "src/control/server.hpp"

namespace gannet::world {
namespace {

using control::Json;
using std::chrono::milliseconds;

// A daemon's control socket that can be killed and started anew.
class PlayedDaemon {
 public:
  explicit PlayedDaemon(const std::string& socket) {
    auto server = control::Server::listen(socket, "");
    if (!server) return;
    server_ = std::move(*server);
    thread_ = std::thread([this] {
      while (!stop_) {
        server_->serve([](const control::Request& request) -> control::Answer {
          if (request.method == "arm")
            return control::Failure{control::ErrorCode::kRefused, "arm is refused", "estop"};
          return Json{{"state", "standby"}, {"permit", "none"}};
        });
        std::this_thread::sleep_for(milliseconds(1));
      }
    });
  }
  ~PlayedDaemon() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  std::unique_ptr<control::Server> server_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

class OperatorLinkTest : public ::testing::Test {
 protected:
  Operator person() {
    auto made = Operator::connect(socket_, milliseconds(500));
    EXPECT_TRUE(made);
    return std::move(*made);
  }
  // Gathers news until it holds or half a second is over.
  template <class Holds>
  DaemonNews news_until(OperatorLink& sut, Holds holds) {
    DaemonNews all;
    for (int i = 0; i < 500 && !holds(all); ++i) {
      auto news = sut.news();
      EXPECT_TRUE(news);
      if (news->heard) all.heard = news->heard;
      for (const auto& refusal : news->refusals) all.refusals.push_back(refusal);
      for (const auto& change : news->presences) all.presences.push_back(change);
      std::this_thread::sleep_for(milliseconds(1));
    }
    return all;
  }
  const std::string socket_ =
      ::testing::TempDir() + "gannet-operator-link-test-" + std::to_string(getpid());
  std::unique_ptr<PlayedDaemon> daemon_ = std::make_unique<PlayedDaemon>(socket_);
};

TEST_F(OperatorLinkTest, direct_a_command_is_in_before_the_next_step) {
  const auto sut = direct_link(person(), {});
  sut->command(7, *parse_action("arm"));
  const auto news = sut->news();
  ASSERT_TRUE(news);
  EXPECT_EQ(news->heard->supervisor, "standby");
  ASSERT_EQ(news->refusals.size(), 1u);
  EXPECT_EQ(news->refusals[0].command, 7u);
  EXPECT_NE(news->refusals[0].why.find("arm is refused"), std::string::npos);
  daemon_.reset();
  EXPECT_FALSE(sut->news());
}

TEST_F(OperatorLinkTest, patient_it_outlives_its_daemon) {
  const auto sut = patient_link(person(), socket_, {});
  auto news = news_until(*sut, [](const DaemonNews& n) { return n.heard.has_value(); });
  ASSERT_TRUE(news.heard);
  EXPECT_EQ(news.heard->supervisor, "standby");

  daemon_.reset();
  news = news_until(*sut, [](const DaemonNews& n) { return !n.presences.empty(); });
  ASSERT_EQ(news.presences.size(), 1u);
  EXPECT_FALSE(news.presences[0].is_there);
  EXPECT_EQ(news.heard->supervisor, "gone");
  sut->command(3, *parse_action("stop"));
  news = news_until(*sut, [](const DaemonNews& n) { return !n.refusals.empty(); });
  ASSERT_EQ(news.refusals.size(), 1u);

  daemon_ = std::make_unique<PlayedDaemon>(socket_);
  news = news_until(*sut, [](const DaemonNews& n) { return !n.presences.empty(); });
  ASSERT_EQ(news.presences.size(), 1u);
  EXPECT_TRUE(news.presences[0].is_there);
  EXPECT_TRUE(sut->finish());
}

TEST_F(OperatorLinkTest, patient_commands_are_refused_by_their_number) {
  const auto sut = patient_link(person(), socket_, {});
  sut->command(5, *parse_action("arm"));
  const auto news = news_until(*sut, [](const DaemonNews& n) { return !n.refusals.empty(); });
  ASSERT_EQ(news.refusals.size(), 1u);
  EXPECT_EQ(news.refusals[0].command, 5u);
}

}  // namespace
}  // namespace gannet::world
