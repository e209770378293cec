#include "hal/can/bus_health.hpp"

#include <gtest/gtest.h>
#include <linux/can/error.h>

namespace gannet::hal {
namespace {

struct Health {
  BusHealth health;
  CanCounters counters;
  BusState take(std::uint32_t classes, std::array<std::uint8_t, 8> data = {}) {
    health.take({.id = classes, .error = true, .length = 8, .data = data}, counters);
    return health.state();
  }
};

TEST(BusHealth, FollowsTheControllersStates) {
  Health h;
  EXPECT_EQ(h.health.state(), BusState::kGood);
  EXPECT_EQ(h.take(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_WARNING}), BusState::kWarning);
  EXPECT_EQ(h.take(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE}), BusState::kPassive);
  EXPECT_EQ(h.take(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_WARNING}), BusState::kWarning);
  EXPECT_EQ(h.take(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_PASSIVE}), BusState::kPassive);
  EXPECT_EQ(h.take(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_ACTIVE}), BusState::kGood);
  EXPECT_EQ(h.counters.error_frames, 5u);
}

TEST(BusHealth, OnlyARestartEndsBusOff) {
  Health h;
  EXPECT_EQ(h.take(CAN_ERR_BUSOFF), BusState::kOff);
  EXPECT_EQ(h.take(CAN_ERR_BUSOFF), BusState::kOff);
  EXPECT_EQ(h.counters.bus_off, 1u) << "told twice, happened once";
  EXPECT_EQ(h.take(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE}), BusState::kOff);
  EXPECT_EQ(h.take(CAN_ERR_CNT, {}), BusState::kOff);
  EXPECT_EQ(h.take(CAN_ERR_RESTARTED), BusState::kGood);
  EXPECT_EQ(h.counters.restarts, 1u);
  EXPECT_EQ(h.take(CAN_ERR_BUSOFF | CAN_ERR_CRTL, {0, CAN_ERR_CRTL_ACTIVE}), BusState::kOff)
      << "the worst of one frame counts";
  EXPECT_EQ(h.take(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_ACTIVE}), BusState::kGood);
}

TEST(BusHealth, CountsWhatHappened) {
  Health h;
  EXPECT_EQ(h.take(CAN_ERR_ACK), BusState::kGood);
  EXPECT_EQ(h.take(CAN_ERR_ACK | CAN_ERR_PROT), BusState::kGood);
  EXPECT_EQ(h.counters.no_ack, 2u);
  EXPECT_EQ(h.take(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_OVERFLOW}), BusState::kGood);
  EXPECT_EQ(h.counters.receive_dropped, 1u);
  EXPECT_EQ(h.take(CAN_ERR_BUSERROR, {0, CAN_ERR_CRTL_RX_PASSIVE}), BusState::kGood)
      << "data[1] belongs to the controller's class alone";
  EXPECT_EQ(h.counters.error_frames, 4u);
}

TEST(BusHealth, TakesTheErrorCountersWhereTheyAreTold) {
  Health h;
  EXPECT_EQ(h.take(CAN_ERR_PROT, {0, 0, 0, 0, 0, 0, 200, 200}), BusState::kGood) << "not flagged";
  EXPECT_EQ(h.counters.transmit_errors, 0);
  const auto counters = [&](int transmit, int receive) {
    return h.take(CAN_ERR_PROT | CAN_ERR_CNT,
                  {0, 0, 0, 0, 0, 0, static_cast<std::uint8_t>(transmit),
                   static_cast<std::uint8_t>(receive)});
  };
  EXPECT_EQ(counters(CAN_ERROR_WARNING_THRESHOLD - 1, 0), BusState::kGood);
  EXPECT_EQ(counters(CAN_ERROR_WARNING_THRESHOLD, 0), BusState::kWarning);
  EXPECT_EQ(counters(0, CAN_ERROR_PASSIVE_THRESHOLD - 1), BusState::kWarning);
  EXPECT_EQ(counters(0, CAN_ERROR_PASSIVE_THRESHOLD), BusState::kPassive);
  EXPECT_EQ(h.counters.receive_errors, CAN_ERROR_PASSIVE_THRESHOLD);
  EXPECT_EQ(counters(0, 3), BusState::kGood);
  EXPECT_EQ(h.counters.receive_errors, 3);
}

TEST(BusHealth, AnInterfaceWithoutACarrierIsOff) {
  Health h;
  h.health.restart(false);
  EXPECT_EQ(h.health.state(), BusState::kOff);
  h.health.restart(true);
  EXPECT_EQ(h.health.state(), BusState::kGood);
}

}  // namespace
}  // namespace gannet::hal
