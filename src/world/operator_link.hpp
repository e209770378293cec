// OperatorLink: the scenario's person at the daemon, for a world that must not wait for it. Kinds:
// direct (stepped: a command is in the daemon before the next step, and a daemon that does not
// answer ends the run) and patient (live: a thread of its own asks, so that a daemon that is slow,
// dead or started anew holds nothing up; it connects again by itself). World's main thread.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/world/operator.hpp"

namespace gannet::world {

// What came from the daemon since the last call.
struct DaemonNews {
  struct Refusal {
    std::size_t command;
    std::string why;
  };
  struct Presence {
    TimePoint noticed;
    bool is_there;
  };
  std::optional<HeardEstimate> heard;
  std::vector<Refusal> refusals;
  std::vector<Presence> presences;  // changes: it has gone, it is back
};

class OperatorLink {
 public:
  virtual ~OperatorLink() = default;
  // id: names it in the news.
  virtual void command(std::size_t id, const Action& action) = 0;
  virtual Result<DaemonNews> news() = 0;
  // Ends the asking. Its timing and counters, for the record. Error: it is not there.
  virtual Result<control::Json> finish() = 0;
};

// start: of the run, which heard times count from.
std::unique_ptr<OperatorLink> direct_link(Operator person, TimePoint start);
std::unique_ptr<OperatorLink> patient_link(Operator person, const std::string& socket,
                                           TimePoint start);

}  // namespace gannet::world
