#include "platform/linux/thread.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

namespace gannet::linux_os {
namespace {

// Small, because locked memory counts it whole; a sanitizer takes a good part of it for itself.
constexpr std::size_t kStackBytes = 2 * 1024 * 1024;
constexpr std::size_t kPrefaultBytes = 256 * 1024;

enum Refused : unsigned { kPriority = 1, kCore = 2, kMemory = 4 };
std::atomic<unsigned> refused{0};  // since the last note
std::atomic<unsigned> told{0};

void set_core(int core) {
  if (core < 0) return;
  cpu_set_t set;
  CPU_ZERO(&set);
  if (core < CPU_SETSIZE) CPU_SET(static_cast<unsigned>(core), &set);
  if (pthread_setaffinity_np(pthread_self(), sizeof set, &set) != 0) refused |= kCore;
}

void set_priority(int priority) {
  if (priority <= 0) return;
  sched_param parameter = {};
  parameter.sched_priority = priority;
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter) != 0) refused |= kPriority;
}

}  // namespace

void describe(Visitor& v, ThreadConfig& c) {
  v.field("core", c.core, {.min = -1, .max = 1023, .help = "Core to run on; -1: any."});
  v.field("priority", c.priority,
          {.min = 0, .max = 99, .help = "SCHED_FIFO priority; 0: normal scheduling."});
}

struct Thread::Body {
  std::string name;
  ThreadConfig config;
  std::function<void()> work;
  pthread_t thread = {};

  static void* run(void* self_pointer) {
    auto* self = static_cast<Body*>(self_pointer);
    pthread_setname_np(pthread_self(), self->name.substr(0, 15).c_str());
    set_core(self->config.core);
    set_priority(self->config.priority);
    prefault_stack();
    self->work();
    return nullptr;
  }
};

Result<Thread> Thread::start(const std::string& name, const ThreadConfig& config,
                             std::function<void()> body) {
  Thread thread;
  thread.body_ = std::make_unique<Body>();
  thread.body_->name = name;
  thread.body_->config = config;
  thread.body_->work = std::move(body);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  const int problem =
      pthread_create(&thread.body_->thread, &attributes, &Body::run, thread.body_.get());
  pthread_attr_destroy(&attributes);
  if (problem != 0) {
    thread.body_.reset();
    return Error{"thread '" + name + "' cannot be started: " + std::strerror(problem)};
  }
  return thread;
}

Thread::Thread() = default;
Thread::Thread(Thread&& other) noexcept = default;
Thread::~Thread() { join(); }

Thread& Thread::operator=(Thread&& other) noexcept {
  if (this != &other) {
    join();
    body_ = std::move(other.body_);
  }
  return *this;
}

void Thread::join() {
  if (!body_) return;
  pthread_join(body_->thread, nullptr);
  body_.reset();
}

bool lock_memory() {
  rlimit limit = {};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  // Under a finite limit a lock that succeeds now would make a later allocation fail.
  const bool allowed = limit.rlim_cur == RLIM_INFINITY || geteuid() == 0;
  if (allowed && mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return true;
  refused |= kMemory;
  return false;
}

void prefault_stack() {
  volatile unsigned char page[kPrefaultBytes];
  for (std::size_t i = 0; i < kPrefaultBytes; i += 4096) page[i] = 0;
  static_cast<void>(page[0]);
}

std::string rights_note() {
  const unsigned now = refused.exchange(0);
  const unsigned news = now & ~told.fetch_or(now);
  std::string note;
  if ((news & kPriority) != 0) note += "no right to FIFO priorities (LimitRTPRIO, CAP_SYS_NICE)\n";
  if ((news & kCore) != 0) note += "a configured core cannot be used by this process\n";
  if ((news & kMemory) != 0) note += "no right to lock memory (LimitMEMLOCK, CAP_IPC_LOCK)\n";
  if (!note.empty()) note += "running on without: times are not guaranteed";
  return note;
}

}  // namespace gannet::linux_os
