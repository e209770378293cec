#include "platform/linux/thread.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include "platform/linux/cpu.hpp"

namespace gannet::linux_os {
namespace {

int first_core() {
  int core = 0;
  while (!may_run_on(core)) ++core;
  return core;
}

TEST(Thread, has_its_name_and_core) {
  char name[16] = {};
  int core = -1;
  auto sut = Thread::start("a-rather-long-name", {.core = first_core()}, [&] {
    pthread_getname_np(pthread_self(), name, sizeof name);
    core = sched_getcpu();
  });
  ASSERT_TRUE(sut);
  sut->join();
  EXPECT_STREQ(name, "a-rather-long-n");
  EXPECT_EQ(core, first_core());
}

TEST(Thread, runs_on_without_what_it_may_not_have_and_says_so_once) {
  static_cast<void>(rights_note());
  bool ran = false;
  for (int i = 0; i < 2; ++i) {
    auto sut = Thread::start("t", {.core = 1023}, [&] { ran = true; });
    ASSERT_TRUE(sut);
    sut->join();
    EXPECT_EQ(rights_note().empty(), i == 1) << "round " << i;
  }
  EXPECT_TRUE(ran);
}

TEST(Thread, has_the_priority_that_it_was_given_or_the_note_says_why_not) {
  int policy = -1;
  auto sut = Thread::start("t", {.priority = 3}, [&] {
    sched_param parameter;
    pthread_getschedparam(pthread_self(), &policy, &parameter);
  });
  ASSERT_TRUE(sut);
  sut->join();
  const std::string note = rights_note();
  EXPECT_NE(policy == SCHED_FIFO, note.find("FIFO") != std::string::npos) << note;
}

TEST(Thread, is_joined_by_its_destructor_and_by_moving_over_it) {
  int done = 0;
  {
    auto a = Thread::start("a", {}, [&] { ++done; });
    auto b = Thread::start("b", {}, [] {});
    ASSERT_TRUE(a && b);
    *b = std::move(*a);
    EXPECT_TRUE(b->running());
  }
  EXPECT_EQ(done, 1);
}

}  // namespace
}  // namespace gannet::linux_os
