#include "platform/linux/sd_notify.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <cstring>
#include <string>

#include "platform/linux/fd.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::linux_os {
namespace {

TEST(SdNotify, sends_one_datagram_to_the_manager) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "notify";
  const Fd manager(socket(AF_UNIX, SOCK_DGRAM, 0));
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(bind(manager.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  setenv("NOTIFY_SOCKET", path.c_str(), 1);
  EXPECT_TRUE(sd_notify("READY=1\nSTATUS=standby"));
  char buffer[100];
  const ssize_t n = recv(manager.get(), buffer, sizeof buffer, MSG_DONTWAIT);
  ASSERT_GT(n, 0);
  EXPECT_EQ(std::string(buffer, static_cast<std::size_t>(n)), "READY=1\nSTATUS=standby");
  unsetenv("NOTIFY_SOCKET");
}

TEST(SdNotify, is_quiet_without_a_manager) {
  unsetenv("NOTIFY_SOCKET");
  EXPECT_FALSE(sd_notify("READY=1"));
  setenv("NOTIFY_SOCKET", "relative", 1);
  EXPECT_FALSE(sd_notify("READY=1"));
  unsetenv("NOTIFY_SOCKET");
}

TEST(SdWatchdog, is_for_this_process_alone) {
  setenv("WATCHDOG_USEC", "2000000", 1);
  unsetenv("WATCHDOG_PID");
  EXPECT_EQ(sd_watchdog(), std::chrono::seconds(2));
  setenv("WATCHDOG_PID", "1", 1);
  EXPECT_EQ(sd_watchdog().count(), 0);
  unsetenv("WATCHDOG_PID");
  unsetenv("WATCHDOG_USEC");
  EXPECT_EQ(sd_watchdog().count(), 0);
}

}  // namespace
}  // namespace gannet::linux_os
