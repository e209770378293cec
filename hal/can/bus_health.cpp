#include "hal/can/bus_health.hpp"

#include <algorithm>

namespace gannet::hal {
namespace {

// Classes of errors, bits of the id.
constexpr std::uint32_t kController = 0x004, kNoAck = 0x020, kBusOff = 0x040, kRestarted = 0x100,
                        kHasCounters = 0x200;
// What is wrong with the controller, bits of data[1].
constexpr std::uint8_t kReceiveOverflow = 0x01, kWarnings = 0x04 | 0x08, kPassives = 0x10 | 0x20,
                       kActive = 0x40;
// ISO 11898-1: limits of the error counters.
constexpr std::uint8_t kWarningLimit = 96, kPassiveLimit = 128;

BusState state_by_counters(std::uint8_t transmit, std::uint8_t receive) {
  const std::uint8_t worst = std::max(transmit, receive);
  if (worst >= kPassiveLimit) return BusState::kPassive;
  return worst >= kWarningLimit ? BusState::kWarning : BusState::kGood;
}

}  // namespace

void BusHealth::take(const CanFrame& frame, CanCounters& counters) {
  ++counters.error_frames;
  if ((frame.id & kNoAck) != 0) ++counters.no_ack;
  const std::uint8_t controller = (frame.id & kController) != 0 ? frame.data[1] : std::uint8_t{0};
  if ((controller & kReceiveOverflow) != 0) ++counters.receive_dropped;  // one or more: unknown
  const bool has_counters = (frame.id & kHasCounters) != 0;
  if (has_counters) {
    counters.transmit_errors = frame.data[6];
    counters.receive_errors = frame.data[7];
  }
  if ((frame.id & kBusOff) != 0) {
    if (state_ != BusState::kOff) ++counters.bus_off;
    state_ = BusState::kOff;
  } else if ((frame.id & kRestarted) != 0) {
    ++counters.restarts;
    state_ = BusState::kGood;
  } else if ((controller & kActive) != 0) {
    state_ = BusState::kGood;
  } else if (state_ == BusState::kOff) {
    return;
  } else if ((controller & kPassives) != 0) {
    state_ = BusState::kPassive;
  } else if ((controller & kWarnings) != 0) {
    state_ = BusState::kWarning;
  } else if (has_counters) {  // some drivers tell of a recovery by the counters alone
    state_ = state_by_counters(frame.data[6], frame.data[7]);
  }
}

}  // namespace gannet::hal
