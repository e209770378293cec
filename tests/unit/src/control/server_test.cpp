#include "src/control/server.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "src/control/client.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::control {
namespace {

Answer echo(const Request& request) {
  if (request.method == "no") return Failure{ErrorCode::kRefused, "not now", "asleep"};
  Json result;
  result["method"] = request.method;
  result["params"] = request.params;
  return result;
}

// Serves in a thread of its own while it lives.
class Served {
 public:
  Served() : path_(folder_ / "control") {
    auto server = Server::listen(path_, "");
    EXPECT_TRUE(server);
    server_ = std::move(*server);
    thread_ = std::thread([this] {
      while (!stop_) {
        std::vector<pollfd> fds;
        server_->add_poll(fds);
        poll(fds.data(), fds.size(), 5);
        server_->serve(echo);
      }
    });
  }
  ~Served() { stop(); }
  const Server& stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return *server_;
  }
  const std::string& path() const { return path_; }

 private:
  test::TemporaryFolder folder_;
  std::string path_;
  std::unique_ptr<Server> server_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(Server, answers_what_a_client_asks) {
  Served sut;
  auto client = Client::connect(sut.path());
  ASSERT_TRUE(client);
  for (int i = 0; i < 3; ++i) {
    const auto result = client->call("hello", Json{{"i", i}});
    ASSERT_TRUE(result) << result.error().text;
    EXPECT_EQ((*result)["params"]["i"], i);
  }
  EXPECT_EQ(sut.stop().counters().requests, 3u);
}

TEST(Server, a_refusal_comes_with_its_reason) {
  Served sut;
  auto client = Client::connect(sut.path());
  ASSERT_TRUE(client);
  const auto result = client->call("no");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().text, "no: not now");
  EXPECT_EQ(client->last_failure()["reason"], "asleep");
  EXPECT_TRUE(client->call("yes"));
  EXPECT_TRUE(client->last_failure().is_null());
}

TEST(Server, junk_is_counted_and_the_connection_goes_on) {
  Served sut;
  auto client = linux_os::UnixSocket::connect(sut.path(), linux_os::SocketKind::kStream);
  ASSERT_TRUE(client);
  const std::string junk = "\x01\x02garbage\n{}\n[[[[\n";
  client->send(std::as_bytes(std::span(junk)));
  const std::string good = request_line({9, "hello"});
  client->send(std::as_bytes(std::span(good)));
  std::string answers;
  std::array<char, 4096> buffer;
  while (answers.find("\"id\":9") == std::string::npos) {
    ASSERT_TRUE(client->wait_readable(std::chrono::seconds(5)));
    const auto got = client->receive(std::as_writable_bytes(std::span(buffer)));
    answers.append(buffer.data(), got.size);
  }
  EXPECT_NE(answers.find("bad_json"), std::string::npos);
  EXPECT_NE(answers.find("bad_protocol"), std::string::npos);
  EXPECT_EQ(sut.stop().counters().junk, 3u);
}

TEST(Server, a_line_without_end_is_refused_in_bounded_memory) {
  Served sut;
  auto client = linux_os::UnixSocket::connect(sut.path(), linux_os::SocketKind::kStream);
  ASSERT_TRUE(client);
  std::string flood(10 * kMaxLine, 'x');
  for (std::size_t at = 0; at < flood.size();) {
    at += client->send(std::as_bytes(std::span(flood).subspan(at))).size;
    std::this_thread::yield();
  }
  const std::string good = "\n" + request_line({9, "hello"});
  while (client->send(std::as_bytes(std::span(good))).size == 0) std::this_thread::yield();
  std::string answers;
  std::array<char, 4096> buffer;
  while (answers.find("\"id\":9") == std::string::npos) {
    ASSERT_TRUE(client->wait_readable(std::chrono::seconds(5)));
    answers.append(buffer.data(), client->receive(std::as_writable_bytes(std::span(buffer))).size);
  }
  EXPECT_EQ(sut.stop().counters().junk, 1u);
}

TEST(Server, too_many_clients_are_told_so) {
  Served sut;
  std::vector<Client> clients;
  for (int i = 0; i < Server::kMaxClients; ++i) {
    auto client = Client::connect(sut.path());
    ASSERT_TRUE(client);
    ASSERT_TRUE(client->call("hello"));
    clients.push_back(std::move(*client));
  }
  auto late = Client::connect(sut.path());
  ASSERT_TRUE(late);
  EXPECT_FALSE(late->call("hello"));
  clients.pop_back();
  for (int i = 0; i < 100; ++i) {
    auto next = Client::connect(sut.path());
    ASSERT_TRUE(next);
    if (next->call("hello")) return;
  }
  ADD_FAILURE() << "the place of one who left is free again";
}

TEST(Server, who_does_not_read_is_dropped_and_others_are_served) {
  Served sut;
  auto deaf = linux_os::UnixSocket::connect(sut.path(), linux_os::SocketKind::kStream);
  ASSERT_TRUE(deaf);
  const std::string request =
      request_line({1, "hello", Json{{"text", std::string(kMaxLine / 2, 'x')}}});
  auto status = linux_os::IoStatus::kDone;
  // By time, not by count: under load or a sanitizer the server's thread is slow.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (status != linux_os::IoStatus::kClosed && std::chrono::steady_clock::now() < deadline) {
    // A partly taken request makes junk of the stream, which does not matter here.
    status = deaf->send(std::as_bytes(std::span(request))).status;
    if (status == linux_os::IoStatus::kWouldBlock) std::this_thread::yield();
  }
  EXPECT_EQ(status, linux_os::IoStatus::kClosed);
  auto client = Client::connect(sut.path());
  ASSERT_TRUE(client);
  EXPECT_TRUE(client->call("hello"));
  EXPECT_EQ(sut.stop().counters().dropped, 1u);
}

TEST(Server, refuses_a_name_that_everybody_could_reach) {
  const auto sut = Server::listen("@gannet-control-test", "");
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("must be a path"), std::string::npos);
}

TEST(Client, says_that_nobody_serves) {
  const test::TemporaryFolder folder;
  const auto sut = Client::connect(folder / "nobody");
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("is gannetd running"), std::string::npos);
}

}  // namespace
}  // namespace gannet::control
