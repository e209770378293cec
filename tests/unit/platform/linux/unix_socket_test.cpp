#include "platform/linux/unix_socket.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace gannet::linux_os {
namespace {

using std::chrono::seconds;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

struct Pair {
  UnixListener listener;
  UnixSocket client;
  UnixSocket server;
};

Pair connect_pair(const std::string& name, SocketKind kind) {
  Pair pair;
  auto listener = UnixListener::listen(name, kind);
  EXPECT_TRUE(listener) << listener.error().text;
  pair.listener = std::move(*listener);
  EXPECT_FALSE(pair.listener.accept());
  auto client = UnixSocket::connect(name, kind);
  EXPECT_TRUE(client) << client.error().text;
  pair.client = std::move(*client);
  EXPECT_TRUE(pair.listener.wait_readable(seconds(5)));
  auto server = pair.listener.accept();
  EXPECT_TRUE(server);
  pair.server = std::move(*server);
  return pair;
}

TEST(UnixSocket, messages_stay_whole) {
  const test::TemporaryFolder folder;
  Pair sut = connect_pair(folder / "s", SocketKind::kSeqPacket);
  std::array<std::byte, 16> buffer;
  EXPECT_EQ(sut.server.receive(buffer).status, IoStatus::kWouldBlock);
  EXPECT_EQ(sut.client.send(bytes_of("one")).size, 3u);
  EXPECT_EQ(sut.client.send(bytes_of("three")).size, 5u);
  EXPECT_EQ(sut.server.receive(buffer).size, 3u);
  EXPECT_EQ(sut.server.receive(buffer).size, 5u);
  EXPECT_EQ(std::memcmp(buffer.data(), "three", 5), 0);
}

TEST(UnixSocket, a_message_longer_than_the_buffer_is_told) {
  const test::TemporaryFolder folder;
  Pair sut = connect_pair(folder / "s", SocketKind::kSeqPacket);
  std::array<std::byte, 4> small;
  sut.client.send(bytes_of("too long"));
  sut.client.send(bytes_of("fits"));
  EXPECT_EQ(sut.server.receive(small).status, IoStatus::kTooLong);
  EXPECT_EQ(sut.server.receive(small).size, 4u);
}

TEST(UnixSocket, a_stream_is_bytes_and_ends_with_its_peer) {
  Pair sut = connect_pair("@gannet-test-" + std::to_string(getpid()), SocketKind::kStream);
  std::array<std::byte, 16> buffer;
  sut.client.send(bytes_of("ab"));
  sut.client.send(bytes_of("cd"));
  EXPECT_EQ(sut.server.receive(buffer).size, 4u);
  sut.client.close();
  EXPECT_TRUE(sut.server.wait_readable(seconds(5)));
  EXPECT_EQ(sut.server.receive(buffer).status, IoStatus::kClosed);
  EXPECT_EQ(sut.server.send(bytes_of("x")).status, IoStatus::kClosed);
}

TEST(UnixSocket, knows_its_peer) {
  const test::TemporaryFolder folder;
  Pair sut = connect_pair(folder / "s", SocketKind::kStream);
  const auto peer = sut.server.peer();
  ASSERT_TRUE(peer);
  EXPECT_EQ(peer->pid, getpid());
  EXPECT_EQ(peer->uid, geteuid());
}

TEST(UnixSocket, says_that_nobody_serves) {
  const test::TemporaryFolder folder;
  const auto sut = UnixSocket::connect(folder / "nobody", SocketKind::kStream);
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("nobody serves"), std::string::npos);
  EXPECT_FALSE(UnixSocket::connect(std::string(200, 'x'), SocketKind::kStream));
  EXPECT_FALSE(UnixSocket::connect("", SocketKind::kStream));
}

TEST(UnixListener, a_name_that_is_served_is_refused) {
  const test::TemporaryFolder folder;
  for (const std::string& name : {folder / "s", "@gannet-twice-" + std::to_string(getpid())}) {
    const auto first = UnixListener::listen(name, SocketKind::kStream);
    ASSERT_TRUE(first);
    const auto second = UnixListener::listen(name, SocketKind::kStream);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().text.find("already served"), std::string::npos);
    EXPECT_TRUE(UnixSocket::connect(name, SocketKind::kStream)) << "the first one still serves";
  }
}

TEST(UnixListener, one_that_serves_without_a_lock_is_refused_too) {
  const test::TemporaryFolder folder;
  auto first = UnixListener::listen(folder / "s", SocketKind::kStream);
  ASSERT_TRUE(first);
  std::filesystem::remove(folder / "s.lock");
  EXPECT_FALSE(UnixListener::listen(folder / "s", SocketKind::kStream));
  EXPECT_FALSE(UnixListener::listen(folder / "s", SocketKind::kSeqPacket));
}

TEST(UnixListener, a_path_left_by_a_dead_one_is_taken_over) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "stale";
  {
    const Fd dead(socket(AF_UNIX, SOCK_STREAM, 0));
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    ASSERT_EQ(bind(dead.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  ASSERT_TRUE(std::filesystem::exists(path));
  EXPECT_TRUE(UnixListener::listen(path, SocketKind::kStream));
}

TEST(UnixListener, never_removes_a_file_that_is_no_socket) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "precious") << "data";
  EXPECT_FALSE(UnixListener::listen(folder / "precious", SocketKind::kStream));
  EXPECT_TRUE(std::filesystem::exists(folder / "precious"));
}

TEST(UnixListener, sets_the_mode_and_removes_its_path_at_the_end) {
  const test::TemporaryFolder folder;
  {
    const auto sut = UnixListener::listen(folder / "s", SocketKind::kStream, 0660);
    ASSERT_TRUE(sut);
    struct stat status = {};
    ASSERT_EQ(stat((folder / "s").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0660u);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "s"));
}

TEST(UnixListener, refuses_an_unknown_group) {
  const test::TemporaryFolder folder;
  const auto sut =
      UnixListener::listen(folder / "s", SocketKind::kStream, 0660, "no-such-group-here");
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("no-such-group-here"), std::string::npos);
}

}  // namespace
}  // namespace gannet::linux_os
