#include "src/world/operator_link.hpp"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "platform/linux/clock.hpp"

namespace gannet::world {
namespace {

constexpr auto kLookPeriod = std::chrono::milliseconds(30);
constexpr Duration kPatience = std::chrono::seconds(1);
constexpr const char* kGone = "gone";  // as the supervisor's state

class DirectLink final : public OperatorLink {
 public:
  DirectLink(Operator person, TimePoint start) : person_(std::move(person)), start_(start) {}

  void command(std::size_t id, const Action& action) override {
    const auto told = person_.command(action);
    if (!told) refusals_.push_back({id, told.error().text});
  }
  Result<DaemonNews> news() override {
    auto heard = person_.look(start_);
    if (!heard) return heard.error();
    return DaemonNews{std::move(*heard), std::exchange(refusals_, {}), {}};
  }
  Result<control::Json> finish() override { return person_.top(); }

 private:
  Operator person_;
  const TimePoint start_;
  std::vector<DaemonNews::Refusal> refusals_;
};

class PatientLink final : public OperatorLink {
 public:
  PatientLink(Operator person, std::string socket, TimePoint start)
      : person_(std::move(person)), socket_(std::move(socket)), start_(start) {
    thread_ = std::thread([this] { work(); });
  }
  ~PatientLink() override { stop(); }

  void command(std::size_t id, const Action& action) override {
    {
      const std::lock_guard lock(mutex_);
      commands_.push_back({id, action});
    }
    wake_.notify_one();
  }
  Result<DaemonNews> news() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
  }
  Result<control::Json> finish() override {
    stop();
    if (!person_) return Error{"the daemon is not there"};
    return person_->top();
  }

 private:
  struct Command {
    std::size_t id;
    Action action;
  };
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable()) thread_.join();
  }
  void work() {
    std::unique_lock lock(mutex_);
    while (!stop_) {
      std::deque<Command> commands = std::exchange(commands_, {});
      lock.unlock();
      obey(commands);
      look();
      lock.lock();
      wake_.wait_for(lock, kLookPeriod, [this] { return stop_ || !commands_.empty(); });
    }
  }
  void obey(const std::deque<Command>& commands) {
    for (const auto& [id, action] : commands) {
      const auto told = person_ ? person_->command(action) : Error{"the daemon is not there"};
      if (told) continue;
      const std::lock_guard lock(mutex_);
      news_.refusals.push_back({id, told.error().text});
    }
  }
  void look() {
    const bool was_there = person_.has_value();
    if (!was_there) {
      auto person = Operator::connect(socket_, {});
      if (person) person_.emplace(std::move(*person));
    }
    HeardEstimate heard;
    heard.supervisor = kGone;
    if (person_) {
      auto answer = person_->look(start_, kPatience);
      if (answer)
        heard = std::move(*answer);
      else
        person_.reset();
    }
    const std::lock_guard lock(mutex_);
    news_.heard = std::move(heard);
    if (person_.has_value() != was_there)
      news_.presences.push_back({linux_os::monotonic_now(), person_.has_value()});
  }

  std::optional<Operator> person_;  // its thread's
  const std::string socket_;
  const TimePoint start_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Command> commands_;
  DaemonNews news_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<OperatorLink> direct_link(Operator person, TimePoint start) {
  return std::make_unique<DirectLink>(std::move(person), start);
}

std::unique_ptr<OperatorLink> patient_link(Operator person, const std::string& socket,
                                           TimePoint start) {
  return std::make_unique<PatientLink>(std::move(person), socket, start);
}

}  // namespace gannet::world
