#include "src/world/motor_nodes.hpp"

#include "src/world/cia402_nodes.hpp"
#include "src/world/esc_node.hpp"
#include "src/world/odrive_nodes.hpp"
#include "src/world/vesc_nodes.hpp"

namespace gannet::world {
namespace {

using Made = std::unique_ptr<MotorNodes>;

Made make_escs(const hal::DriveConfig& drives, std::uint64_t seed) {
  return std::make_unique<EscNodes>(drives, EscBehaviour{}, seed);
}

Made make_cia402(const hal::DriveConfig& drives, std::uint64_t seed) {
  return std::make_unique<Cia402Nodes>(drives, seed);
}

Made make_vescs(const hal::DriveConfig& drives, std::uint64_t seed) {
  return std::make_unique<VescNodes>(drives, VescBehaviour{}, seed);
}

Made make_odrives(const hal::DriveConfig& drives, std::uint64_t seed) {
  return std::make_unique<OdriveNodes>(drives, OdriveBehaviour{}, seed);
}

struct Kind {
  const char* name;
  Made (*make)(const hal::DriveConfig&, std::uint64_t);
};
constexpr Kind kKinds[] = {
    {"dronecan_esc", make_escs},
    {"cia402", make_cia402},
    {"vesc", make_vescs},
    {"odrive", make_odrives},
};

}  // namespace

Result<Made> make_motor_nodes(const hal::DriveConfig& drives, std::uint64_t seed) {
  for (const Kind& kind : kKinds) {
    if (drives.kind == kind.name) return kind.make(drives, seed);
  }
  return Error{"drive.kind '" + drives.kind + "' has no nodes in the world"};
}

void NodeMouth::say(hal::CanFrame frame, const MotorFaults& faults, Random& random, TimePoint now) {
  if (faults.garbage > 0 && random.uniform() < faults.garbage) {
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random.next());
  }
  waiting_.push_back({now + faults.late, frame});
}

void NodeMouth::deliver(const MotorFaults& faults, TimePoint now, std::vector<hal::CanFrame>& out) {
  if (faults.silent) waiting_.clear();
  while (!waiting_.empty() && waiting_.front().due <= now) {
    out.push_back(waiting_.front().frame);
    waiting_.pop_front();
  }
}

}  // namespace gannet::world
