#include "src/world/daemon_process.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

namespace gannet::world {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const std::string kLog = ::testing::TempDir() + "gannet_daemon_process_test.log";

DaemonProcess shell(const std::string& script) {
  auto process = DaemonProcess::start("/bin/sh", {"-c", script}, kLog);
  EXPECT_TRUE(process);
  return std::move(*process);
}

void wait_for_log(const std::string& word) {
  for (int i = 0; i < 400; ++i) {
    std::stringstream text;
    text << std::ifstream(kLog).rdbuf();
    if (text.str().find(word) != std::string::npos) return;
    std::this_thread::sleep_for(milliseconds(5));
  }
  FAIL() << "the log never said " << word;
}

TEST(DaemonProcess, tells_the_exit_code_and_keeps_what_was_said) {
  DaemonProcess sut = shell("echo hello; echo trouble >&2; exit 3");
  while (sut.running()) std::this_thread::sleep_for(milliseconds(1));
  EXPECT_EQ(sut.exit_code(), 3);
  EXPECT_EQ(sut.stop(seconds(1)), 3);
  std::stringstream text;
  text << std::ifstream(kLog).rdbuf();
  EXPECT_EQ(text.str(), "hello\ntrouble\n");
  std::remove(kLog.c_str());
}

TEST(DaemonProcess, asks_it_to_end) {
  DaemonProcess sut = shell("trap 'exit 0' TERM; echo ready; while :; do sleep 0.01; done");
  wait_for_log("ready");
  EXPECT_TRUE(sut.running());
  EXPECT_EQ(sut.stop(seconds(2)), 0);
}

TEST(DaemonProcess, kills_one_that_does_not_listen) {
  DaemonProcess sut = shell("trap '' TERM; echo ready; while :; do sleep 0.01; done");
  wait_for_log("ready");
  EXPECT_EQ(sut.stop(milliseconds(30)), 128 + SIGKILL);
}

TEST(DaemonProcess, says_when_there_is_no_such_program) {
  const auto process = DaemonProcess::start("/nowhere/gannetd", {}, kLog);
  ASSERT_FALSE(process);
  EXPECT_NE(process.error().text.find("/nowhere/gannetd"), std::string::npos);
}

}  // namespace
}  // namespace gannet::world
